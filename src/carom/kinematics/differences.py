"""The quantities of a system of functions, with central differences where no derivative is given.

    f' = [8 (f(+h) - f(-h)) - (f(+2h) - f(-2h))] / 12 h,   h = eps^(1/5) max(1, |q|) = 7.4e-4 max(1, |q|)

of order 4: the errors by round-off and by truncation are about 1e-12 of the scale of f, if f varies on a scale
of 1. Second derivatives, of constraints and gaps of persistent contacts along the velocity, use h = eps^(1/6),
with an error of 1e-10. (Mathematics page, §4.1.)
"""

from __future__ import annotations

import numpy as np

from carom._compiled.call_address import call_function
from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.model import own_coordinates as o

STEP = float(np.finfo(float).eps ** 0.2)
STEP_TWICE = float(np.finfo(float).eps ** (1.0 / 6.0))
_FIRST = (1.0 / 12.0, -2.0 / 3.0, 0.0, 2.0 / 3.0, -1.0 / 12.0)  # weights of f(-2h) ... f(2h)
_SECOND = (-1.0 / 12.0, 4.0 / 3.0, -2.5, 4.0 / 3.0, -1.0 / 12.0)


@inlined
def has_parts(own):
    """Return whether the system consists of functions without derivatives of its own."""
    return own.parts.shape[0] > 0


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
def evaluate_parts(own, which, t):
    """Write the result of one of the four functions at the state `own.x`, made of the user's functions.

    Those of the coordinates get a copy of them, `own.point`.
    """
    h, x = own.holonomic, own.x
    copy_row(x, own.point, own.n)
    if which == o.CALL_INERTIA:
        evaluate_inertia(own, t, x)
    elif which == o.CALL_LOADS:
        evaluate_loads(own, t, x)
    elif which == o.CALL_ROWS:
        phi, A, rate = own.phi, own.A, own.A_rate
        evaluate_rows(own.parts[o.OF_CONSTRAINT], t, x, (phi, A, rate), own)
        evaluate_rows(own.parts[o.OF_ROWS], t, x, (phi, A[h:], rate[h:]), own)
    else:
        for c in range(own.contacts):
            gap, G, rate, part = own.gap[c:], own.G[c], own.G_rate[c], o.OF_CONTACT + 2 * c
            evaluate_rows(own.parts[part], t, x, (gap, G, rate), own)
            evaluate_rows(own.parts[part + 1], t, x, (gap, G[1:], rate[1:]), own)


@kernel
def evaluate_inertia(own, t, x):
    """Write M and Gamma_kij v_i v_j."""
    n, c, part, dM = own.n, own.c, own.parts[o.OF_METRIC], own.slope
    call_function(part.address, t, own.point, own.M)
    find_slope(part, t, x, n, own)
    for i in range(n):
        c[i] = 0.0
        for j in range(n):
            for k in range(n):
                w, first, second = x[n + k] * x[n + j], (n * k + i) * n + j, (n * i + k) * n + j
                c[i] += dM[first] * w - 0.5 * dM[second] * w


@kernel
def evaluate_loads(own, t, x):
    """Write V, Q - dV, Q v."""
    n, out = own.n, own.loads
    potential, force = own.parts[o.OF_POTENTIAL], own.parts[o.OF_FORCE]
    for j in range(n + 2):
        out[j] = 0.0
    if force.address != 0:
        call_function(force.address, t, x, out[1:])
    for j in range(n):
        out[n + 1] += out[1 + j] * x[n + j]
    if potential.address != 0:
        call_function(potential.address, t, own.point, out)
        find_slope(potential, t, x, n, own)
        for j in range(n):
            out[1 + j] -= own.slope[j]


@kernel
def evaluate_rows(part, t, x, out, own):
    """Write values, rows A and (dA/dt) v of a function and its derivative; of rows alone, the last two."""
    values, A, rates = out
    n, m, v = own.point.size, part.results, x[own.point.size :]
    if part.address != 0:
        call_function(part.address, t, own.point, values)
    if part.slope_address != 0:
        call_function(part.slope_address, t, own.point, A)
        differ((part.slope_address, m * n, t), x, (v, along(x, STEP), _FIRST), own.slope, own)
        for i in range(m):
            rates[i] = dot(own.slope[i * n :], v, n)
    elif part.address != 0:
        find_slope(part, t, x, n, own)
        for i in range(m):
            for j in range(n):
                A[i, j] = own.slope[j * m + i]
        h = along(x, STEP_TWICE)
        differ((part.address, m, t), x, (v, h, _SECOND), rates, own)
        for i in range(m if h > 0.0 else 0):
            rates[i] /= h


@kernel
def find_slope(part, t, x, n, own):
    """Write the derivatives (n, m) of a function of the coordinates into `own.slope`."""
    if part.slope_address != 0:
        call_function(part.slope_address, t, own.point, own.slope)
        return
    axis = own.axis
    for k in range(n):
        axis[k] = 1.0
        h = STEP * max(1.0, abs(x[k]))
        differ(
            (part.address, part.results, t),
            x,
            (axis, h, _FIRST),
            own.slope[k * part.results :],
            own,
        )
        axis[k] = 0.0


@kernel
def along(x, part):
    """Return a step along v: a part of the time in which v changes coordinates by their size, at least by 1."""
    n, speed, extent = x.size // 2, 0.0, 1.0
    for j in range(n):
        speed, extent = max(speed, abs(x[n + j])), max(extent, abs(x[j]))
    return part * extent / speed if speed > 0.0 else 0.0


@kernel
def differ(function, x, stencil, out, own):
    """Write sum_s weight_s f_i(q + s h way) / h of a function: its address, number of results, time.

    The stencil is the way, h and the weights; it gives 0 for h = 0.
    """
    (address, m, t), (way, h, weight), q, y = function, stencil, own.point, own.sample
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
