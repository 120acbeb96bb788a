"""One explicit Runge-Kutta step in coordinates, with a return to the constraints in the kinetic metric."""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.friction import ldl
from carom.generalized.linear import add_row, copy_row
from carom.generalized.motion import (
    POSITION,
    RATE,
    acceleration,
    find_metric,
    find_rows,
    gather,
    kinetic_energy,
    persists,
    react,
    slip_of,
    terms,
)
from carom.generalized.thresholds import CONSTRAINT_ERROR
from carom.geometry.thresholds import LAST_UNITS
from carom.model import actions as a
from carom.status import CONSTRAINTS_LOST, NOT_FINITE


@kernel
def take(motion, t, x, h):
    """Write the state a time h after `x` into `work.end`; return a status. Store the works in `work.spent`."""
    system, method, active, work = motion.system, motion.method, motion.active, motion.work
    end = work.end
    n, stages = system.n, method.b.size
    note_slip_directions(system, active, t, x, work)
    loads, friction = 0.0, 0.0
    for j in range(n):
        work.sum[j] = 0.0
    for s in range(stages):
        ahead = combine(method.A[s], s, h, x, work.stages, work.trial)
        p, f, code = acceleration(system, active, t + ahead, work.trial, work, work.stages[s])
        if code != 0:
            return code
        if s == 0:
            work.spent[2] = kinetic_energy(system, x, work)
        loads += h * method.b[s] * p
        friction += h * method.b[s] * f
    combine(method.b, stages, h, x, work.stages, end)
    work.spent[0], work.spent[1] = loads, friction
    total = 0.0
    for j in range(2 * n):
        total += end[j]
    if not math.isfinite(total):
        return NOT_FINITE
    if system.rows > 0 or persists(active):
        code = return_to_surfaces(system, active, t + h, end, work)
        return project_rates(system, active, t + h, end, work) if code == 0 else code
    return 0


@entry
def move_freely(motion, x, parts):
    """Move x = (q, v) for a time of 1 in `parts` steps, for Python; return a status."""
    for part in range(parts):
        code = take(motion, part / parts, x, 1.0 / parts)
        if code != 0:
            return code
        copy_row(motion.work.end, x, x.size)
    return 0


@kernel
def combine(weight, count, h, x, stages, out):
    """Write x + h sum weight[r] stages[r], r < count; return h sum weight."""
    ahead = 0.0
    copy_row(x, out, x.size)
    for r in range(count):
        a = h * weight[r]
        ahead += a
        if a != 0.0:
            add_row(a, stages[r], out, x.size)
    return ahead


@kernel
def note_slip_directions(system, active, t, x, work):
    """Store the direction of slip of persistent contacts at the start of a step."""
    find_rows(system, active, t, x, work)
    for c in range(system.contacts):
        if active[c].mode == a.MODE_SLIP:
            heading = active[c].heading
            _, _, heading[0], heading[1] = slip_of(system, heading, c, x, work)


@kernel
def error_of(system, active, x, work):
    """Return the greatest error of coordinates, relative to the terms of each constraint and gap."""
    n, worst = system.n, 0.0
    for r in range(system.holonomic):
        work.row_scale[r] = max(work.row_scale[r], terms(work.A[r], x, n))
        size = work.row_scale[r]
        worst = max(worst, abs(work.phi[r]) / (size if size > 0.0 else 1.0))
    for c in range(system.contacts):
        if active[c].mode != a.MODE_OPEN:
            size = max(terms(work.G[c, 0], x, n), work.gap_scale[c])
            worst = max(worst, abs(work.gap[c]) / (size if size > 0.0 else 1.0))
    return worst


@kernel
def return_to_surfaces(system, active, t, x, work):
    """Move the coordinates in `x` to constraints and persistent contacts along autoparallels; return a status.

    Exp_q(xi) is replaced by the first two terms of its series, q + xi - Gamma(xi, xi)/2 (a retraction of
    second order: Absil, Mahony and Sepulchre 2008, §5.5): xi is the error of a step, and what is left of phi
    is removed by the next iteration.
    """
    n, last, y, xi = system.n, 0.0, work.trial, work.a
    for iteration in range(20):
        code = find_metric(system, t, x, work)
        if code != 0:
            return code
        find_rows(system, active, t, x, work)
        m = gather(system, active, POSITION, x, work)
        error = error_of(system, active, x, work)
        if not error > LAST_UNITS or (iteration > 0 and error >= 0.5 * last):
            break
        last = error
        for j in range(n):
            xi[j] = 0.0
        react(system, m, xi, work)
        copy_row(x, y, n)
        copy_row(xi, y[n:], n)
        code = find_metric(system, t, y, work)
        if code != 0:
            return code
        ldl.substitute(n, work.L, work.c)
        add_row(1.0, xi, x, n)
        add_row(-0.5, work.c, x, n)
    return 0 if error <= CONSTRAINT_ERROR else CONSTRAINTS_LOST


@kernel
def project_rates(system, active, t, x, work):
    """Project the velocities in `x` to constraints and persistent contacts; return a status."""
    code = find_metric(system, t, x, work)
    if code == 0:
        find_rows(system, active, t, x, work)
        react(system, gather(system, active, RATE, x, work), x[system.n :], work)
    return code


@entry
def project(system, active, t, x, rates, work):
    """Project coordinates, and if `rates` is set also velocities, for Python; return a status."""
    code = return_to_surfaces(system, active, t, x, work)
    return project_rates(system, active, t, x, work) if rates and code == 0 else code
