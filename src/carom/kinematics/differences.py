"""The quantities of a system of functions, with central differences where no derivative is given.

    f' = [8 (f(+h) - f(-h)) - (f(+2h) - f(-2h))] / 12 h,   h = eps^(1/5) max(scale, |q|)

of order 4, with eps^(1/5) = 7.4e-4: the errors by round-off and by truncation are about 1e-12 of the size of f,
if f varies on the scale of the coordinate. Second derivatives, of constraints and gaps of persistent contacts
along the velocity, use h = eps^(1/6), with an error of 1e-10. (Mathematics page, §4.1.)
"""

from __future__ import annotations

import numpy as np

from carom._compiled.call_address import call_function
from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.model import chart as o

STEP = float(np.finfo(float).eps ** 0.2)
STEP_TWICE = float(np.finfo(float).eps ** (1.0 / 6.0))
_FIRST = (1.0 / 12.0, -2.0 / 3.0, 0.0, 2.0 / 3.0, -1.0 / 12.0)  # weights of f(-2h) ... f(2h)
_SECOND = (-1.0 / 12.0, 4.0 / 3.0, -2.5, 4.0 / 3.0, -1.0 / 12.0)


@inlined
def has_parts(chart):
    """Return whether the system consists of functions without derivatives of its chart."""
    return chart.parts.shape[0] > 0


@kernel
def copy_row(row, out, n):
    """Copy n numbers."""
    for j in range(n):
        out[j] = row[j]


@kernel
def dot(a, b, n):
    """Return the sum of the products of n numbers."""
    total = 0.0
    for j in range(n):
        total += a[j] * b[j]
    return total


@unit(where=has_parts)
def evaluate_parts(chart, which, t):
    """Write the result of one of the four functions at the state `chart.x`, made of the user's functions.

    Those of the coordinates get a copy of them, `chart.point`.
    """
    h, x = chart.holonomic, chart.x
    copy_row(x, chart.point, chart.n)
    if which == o.CALL_INERTIA:
        evaluate_inertia(chart, t, x)
    elif which == o.CALL_LOADS:
        evaluate_loads(chart, t, x)
    elif which == o.CALL_ROWS:
        phi, A, rate = chart.phi, chart.A, chart.A_rate
        evaluate_rows(chart.parts[o.OF_CONSTRAINT], t, x, (phi, A, rate), chart)
        evaluate_rows(chart.parts[o.OF_ROWS], t, x, (phi, A[h:], rate[h:]), chart)
    else:
        for c in range(chart.contacts):
            gap, G, rate, part = chart.gap[c:], chart.G[c], chart.G_rate[c], o.OF_CONTACT + 2 * c
            evaluate_rows(chart.parts[part], t, x, (gap, G, rate), chart)
            evaluate_rows(chart.parts[part + 1], t, x, (gap, G[1:], rate[1:]), chart)


@kernel
def evaluate_inertia(chart, t, x):
    """Write M and Gamma_kij v_i v_j."""
    n, c, part, dM = chart.n, chart.c, chart.parts[o.OF_METRIC], chart.slope
    call_function(part.address, t, chart.point, chart.M)
    find_slope(part, t, x, n, chart)
    for i in range(n):
        c[i] = 0.0
        for j in range(n):
            for k in range(n):
                w, first, second = x[n + k] * x[n + j], (n * k + i) * n + j, (n * i + k) * n + j
                c[i] += dM[first] * w - 0.5 * dM[second] * w


@kernel
def evaluate_loads(chart, t, x):
    """Write V, Q - dV, Q v."""
    n, out = chart.n, chart.loads
    potential, force = chart.parts[o.OF_POTENTIAL], chart.parts[o.OF_FORCE]
    for j in range(n + 2):
        out[j] = 0.0
    if force.address != 0:
        call_function(force.address, t, x, out[1:])
    for j in range(n):
        out[n + 1] += out[1 + j] * x[n + j]
    if potential.address != 0:
        call_function(potential.address, t, chart.point, out)
        find_slope(potential, t, x, n, chart)
        for j in range(n):
            out[1 + j] -= chart.slope[j]


@kernel
def evaluate_rows(part, t, x, out, chart):
    """Write values, rows A and (dA/dt) v of a function and its derivative; of rows alone, the last two."""
    values, A, rates = out
    n, m, v = chart.point.size, part.results, x[chart.point.size :]
    if part.address != 0:
        call_function(part.address, t, chart.point, values)
    if part.slope_address != 0:
        call_function(part.slope_address, t, chart.point, A)
        differ(
            (part.slope_address, m * n, t),
            x,
            (v, along(x, STEP, chart.scale), _FIRST),
            chart.slope,
            chart,
        )
        for i in range(m):
            rates[i] = dot(chart.slope[i * n :], v, n)
    elif part.address != 0:
        find_slope(part, t, x, n, chart)
        for i in range(m):
            for j in range(n):
                A[i, j] = chart.slope[j * m + i]
        h = along(x, STEP_TWICE, chart.scale)
        differ((part.address, m, t), x, (v, h, _SECOND), rates, chart)
        for i in range(m if h > 0.0 else 0):
            rates[i] /= h


@kernel
def find_slope(part, t, x, n, chart):
    """Write the derivatives (n, m) of a function of the coordinates into `chart.slope`."""
    if part.slope_address != 0:
        call_function(part.slope_address, t, chart.point, chart.slope)
        return
    axis = chart.axis
    for k in range(n):
        axis[k] = 1.0
        h = STEP * max(chart.scale[k], abs(x[k]))
        differ(
            (part.address, part.results, t),
            x,
            (axis, h, _FIRST),
            chart.slope[k * part.results :],
            chart,
        )
        axis[k] = 0.0


@kernel
def along(x, part, scale):
    """Return a step along v: a part of the time in which v changes coordinates by their size."""
    n, speed, extent = x.size // 2, 0.0, 1.0
    for j in range(n):
        speed = max(speed, abs(x[n + j]) / scale[j])
        extent = max(extent, abs(x[j]) / scale[j])
    return part * extent / speed if speed > 0.0 else 0.0


@kernel
def differ(function, x, stencil, out, chart):
    """Write sum_s weight_s f_i(q + s h way) / h of a function: its address, number of results, time.

    The stencil is the way, h and the weights; it gives 0 for h = 0.
    """
    (address, m, t), (way, h, weight), q, y = function, stencil, chart.point, chart.sample
    n = q.size
    for i in range(m):
        out[i] = 0.0
    for s in range(-2, 3 if h > 0.0 else -2):
        if weight[s + 2] != 0.0:
            for j in range(n):
                q[j] = x[j] + s * h * way[j]
            call_function(address, t, q, y)
            for i in range(m):
                out[i] += weight[s + 2] / h * y[i]
    copy_row(x, q, n)
