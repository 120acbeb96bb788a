"""One explicit Runge-Kutta step in coordinates, with a return to the constraints in the kinetic metric."""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.generalized.autoparallel import correct
from carom.generalized.layout import ALL_ROWS, HOLONOMIC, N
from carom.generalized.motion import (
    acceleration,
    copy_row,
    direction,
    factor_rows,
    find_metric,
    find_rows,
    react,
    slip_of,
)
from carom.model.actions import MODE_STICK
from carom.status import CONSTRAINTS_LOST, NOT_FINITE

_NONE = 4e-16  # relative to the terms of a row: its error cannot be smaller


@kernel
def take(motion, t, x, h):
    """Write the state a time h after `x` into `work.end`; return a status. Store the works in `work.spent`."""
    system, method, active, work = motion.system, motion.method, motion.active, motion.work
    end = work.end
    n, stages = system.size[N], method.b.size
    note_slip_directions(system, active, t, x, work)
    loads, friction = 0.0, 0.0
    for s in range(stages):
        ahead = combine(method.A[s], s, h, x, work.stages, work.trial)
        p, f, code = acceleration(system, active, t + ahead, work.trial, work, work.stages[s])
        if code != 0:
            return code
        loads += h * method.b[s] * p
        friction += h * method.b[s] * f
    combine(method.b, stages, h, x, work.stages, end)
    work.spent[0], work.spent[1] = loads, friction
    total = 0.0
    for j in range(2 * n):
        total += end[j]
    if not math.isfinite(total):
        return NOT_FINITE
    if system.size[ALL_ROWS] > 0 or active.count[0] > 0:
        return project(system, active, t + h, end, work)
    return 0


@kernel
def combine(weight, count, h, x, stages, out):
    """Write x + h sum weight[r] stages[r], r < count; return h sum weight."""
    ahead = 0.0
    for j in range(x.size):
        out[j] = x[j]
    for r in range(count):
        a = h * weight[r]
        ahead += a
        if a != 0.0:
            for j in range(x.size):
                out[j] += a * stages[r, j]
    return ahead


@kernel
def note_slip_directions(system, active, t, x, work):
    """Store the direction of slip of persistent contacts at the start of a step."""
    if active.count[0] == 0:
        return
    find_rows(system, active, t, x, work)
    for i in range(active.count[0]):
        if active.mode[i] != MODE_STICK:
            u1, u2 = slip_of(system, active, i, x, work)
            active.heading[i, 0], active.heading[i, 1] = direction(active, i, u1, u2)


@kernel
def place_rows(system, active, x, work):
    """Write the rows for positions into R = D, and -phi and -gap into `rhs`; return (rows, error).

    The error is the greatest of all rows, each relative to the terms of its row.
    """
    n, m, worst = system.size[N], 0, 0.0
    for r in range(system.size[HOLONOMIC] + active.count[0]):
        h = r - system.size[HOLONOMIC]
        row = work.A[r] if h < 0 else work.G[active.contact[h], 0]
        value = work.phi[r] if h < 0 else work.gap[active.contact[h]]
        size = 0.0
        for j in range(n):
            size += abs(row[j] * x[j])
        if h < 0:
            work.row_scale[r] = max(work.row_scale[r], size)
            size = work.row_scale[r]
        else:
            size = max(size, work.gap_scale[active.contact[h]])
        copy_row(row, work.R[m], n)
        copy_row(row, work.D[m], n)
        work.rhs[m] = -value
        worst = max(worst, abs(value) / size if size > 0.0 else abs(value))
        m += 1
    return m, worst


@kernel
def rate_rows(system, active, work):
    """Write the rows for velocities into R = D, and 0 into `rhs`; return the number of rows."""
    n, m = system.size[N], 0
    for r in range(system.size[ALL_ROWS]):
        copy_row(work.A[r], work.R[m], n)
        m += 1
    for i in range(active.count[0]):
        for r in range(3 if active.mode[i] == MODE_STICK else 1):
            copy_row(work.G[active.contact[i], r], work.R[m], n)
            m += 1
    for r in range(m):
        copy_row(work.R[r], work.D[r], n)
        work.rhs[r] = 0.0
    return m


@kernel
def project(system, active, t, x, work):
    """Project `x` to constraints and persistent contacts: coordinates along autoparallels, then velocities."""
    n, last = system.size[N], 0.0
    for iteration in range(20):
        code = find_metric(system, t, x, work)
        if code != 0:
            return code
        find_rows(system, active, t, x, work)
        m, error = place_rows(system, active, x, work)
        if not error > _NONE or (iteration > 0 and error >= 0.5 * last):
            break
        last = error
        factor_rows(system, m, work)
        xi = work.a
        for j in range(n):
            xi[j] = 0.0
        react(system, m, xi, work)
        code = correct(system, t, x, xi, work)
        if code != 0:
            return code
    if not error <= 1e-9:
        return CONSTRAINTS_LOST
    m = rate_rows(system, active, work)
    factor_rows(system, m, work)
    v = work.a
    for j in range(n):
        v[j] = x[n + j]
    react(system, m, v, work)
    for j in range(n):
        x[n + j] = v[j]
    return 0


@entry
def project_rates(system, active, t, x, work):
    """Do the same as `project`, for Python."""
    return project(system, active, t, x, work)
