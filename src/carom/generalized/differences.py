"""The quantities of a system of functions, with central differences where no derivative is given.

    f' = [8 (f(+h) - f(-h)) - (f(+2h) - f(-2h))] / 12 h,   h = eps^(1/5) max(1, |q|) = 7.4e-4 max(1, |q|)

of order 4: the errors by round-off and by truncation are about 1e-12 of the scale of f, if f varies on a scale
of 1. Second derivatives, of constraints and gaps of persistent contacts along the velocity, use h = eps^(1/6),
with an error of 1e-10. (Mathematics page, §4.1.)
"""

from __future__ import annotations

import numpy as np

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom._compiled.user_functions import call_function
from carom.generalized.layout import (
    ALL_ROWS,
    CALL_INERTIA,
    CALL_LOADS,
    CALL_ROWS,
    HOLONOMIC,
    OF_CONSTRAINT,
    OF_CONTACT,
    OF_FORCE,
    OF_METRIC,
    OF_POTENTIAL,
    OF_ROWS,
    TOUCHES,
    N,
)
from carom.generalized.linear import copy_row

STEP = float(np.finfo(float).eps ** 0.2)
STEP_TWICE = float(np.finfo(float).eps ** (1.0 / 6.0))
_FIRST = (1.0 / 12.0, -2.0 / 3.0, 0.0, 2.0 / 3.0, -1.0 / 12.0)  # weights of f(-2h) ... f(2h)
_SECOND = (-1.0 / 12.0, 4.0 / 3.0, -2.5, 4.0 / 3.0, -1.0 / 12.0)


@inlined
def has_parts(system):
    """Return whether the system consists of functions without derivatives of its own."""
    return system.part.shape[0] > 0


@unit(where=has_parts)
def evaluate_parts(system, which, t, x, work):
    """Write the result of one of the four functions of a system, made of the user's functions.

    Those of the coordinates get a copy of them, `work.point`.
    """
    n, h, k, C = system.size[N], system.size[HOLONOMIC], system.size[ALL_ROWS], system.size[TOUCHES]
    copy_row(x, work.point, n)
    if which == CALL_INERTIA:
        evaluate_inertia(system, t, x, work)
    elif which == CALL_LOADS:
        evaluate_loads(system, t, x, work)
    elif which == CALL_ROWS:
        out, rates = work.rows[h:], work.rows[h + k * n :]
        evaluate_rows(system.part[OF_CONSTRAINT], t, x, work.rows, out, rates, work)
        evaluate_rows(system.part[OF_ROWS], t, x, work.rows, out[h * n :], rates[h:], work)
    else:
        for c in range(C):
            values, out = work.contacts[c:], work.contacts[C + 3 * n * c :]
            rates, part = work.contacts[C + 3 * n * C + 3 * c :], OF_CONTACT + 2 * c
            evaluate_rows(system.part[part], t, x, values, out, rates, work)
            evaluate_rows(system.part[part + 1], t, x, values, out[n:], rates[1:], work)


@kernel
def evaluate_inertia(system, t, x, work):
    """Write M and Gamma_kij v_i v_j."""
    n, out, part, dM = system.size[N], work.inertia, system.part[OF_METRIC], work.slope
    call_function(part[0], t, work.point, out)
    find_slope(part, t, x, n, work)
    for i in range(n):
        out[n * n + i] = 0.0
        for j in range(n):
            for k in range(n):
                w, first, second = x[n + k] * x[n + j], (n * k + i) * n + j, (n * i + k) * n + j
                out[n * n + i] += dM[first] * w - 0.5 * dM[second] * w


@kernel
def evaluate_loads(system, t, x, work):
    """Write V, Q - dV, Q v."""
    n, out, potential, force = (
        system.size[N],
        work.loads,
        system.part[OF_POTENTIAL],
        system.part[OF_FORCE],
    )
    for j in range(n + 2):
        out[j] = 0.0
    if force[0] != 0:
        call_function(force[0], t, x, out[1:])
    for j in range(n):
        out[n + 1] += out[1 + j] * x[n + j]
    if potential[0] != 0:
        call_function(potential[0], t, work.point, out)
        find_slope(potential, t, x, n, work)
        for j in range(n):
            out[1 + j] -= work.slope[j]


@kernel
def evaluate_rows(part, t, x, values, out, rates, work):
    """Write values, rows A and (dA/dt) v of a function and its derivative; of rows alone, the last two."""
    n, m = x.size // 2, part[2]
    if part[0] != 0:
        call_function(part[0], t, work.point, values)
    if part[1] != 0:
        call_function(part[1], t, work.point, out)
        differ_along(part[1], m, n, t, x, rates, work)
    elif part[0] != 0:
        find_slope(part, t, x, n, work)
        for i in range(m):
            for j in range(n):
                out[i * n + j] = work.slope[j * m + i]
        differ_along(part[0], m, 0, t, x, rates, work)


@kernel
def find_slope(part, t, x, n, work):
    """Write the derivatives (n, m) of a function of the coordinates into `work.slope`."""
    q, y, out, m = work.point, work.sample, work.slope, part[2]
    if part[1] != 0:
        call_function(part[1], t, q, out)
        return
    for k in range(n):
        for i in range(m):
            out[k * m + i] = 0.0
        h = STEP * max(1.0, abs(x[k]))
        for s in (-2, -1, 1, 2):
            q[k] = x[k] + s * h
            call_function(part[0], t, q, y)
            for i in range(m):
                out[k * m + i] += _FIRST[s + 2] / h * y[i]
        q[k] = x[k]


@kernel
def differ_along(address, m, n, t, x, out, work):
    """Write the second derivatives (m,) of a function along v; of rows (m, n), if n > 0, (d rows/dt) v."""
    q, y, size = work.point, work.sample, x.size // 2
    speed, extent = 0.0, 1.0
    for j in range(size):
        speed, extent = max(speed, abs(x[size + j])), max(extent, abs(x[j]))
    # of the time in which the velocities change coordinates by their own size, at least by 1
    h = (STEP if n > 0 else STEP_TWICE) * extent / speed if speed > 0.0 else 0.0
    for i in range(m):
        out[i] = 0.0
    for s in range(-2, 3 if h > 0.0 else -2):
        if n > 0 and s == 0:
            continue
        for j in range(size):
            q[j] = x[j] + s * h * x[size + j]
        call_function(address, t, q, y)
        for i in range(m):
            for j in range(n):
                out[i] += _FIRST[s + 2] / h * y[i * n + j] * x[size + j]
            if n == 0:
                out[i] += _SECOND[s + 2] / (h * h) * y[i]
    copy_row(x, q, size)
