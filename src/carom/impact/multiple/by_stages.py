"""One step of the layer by stages, implicit in friction, cut at the first change of mode."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.impact.multiple import events, law
from carom.impact.multiple.by_series import AT_REST
from carom.impact.multiple.discs import gather_discs
from carom.impact.multiple.implicit import advance, implicit_step, interpolate, present_forces
from carom.impact.multiple.layout import DISC_T, FORCE, IN_DISC, MASS, NEW_D, NEW_U, WHEN
from carom.impact.multiple.motion import set_velocity

_LEAST_STEP = 1e-9
_AT_CHANGE = 0.02  # part of the tolerance for steps in which a contact begins or ceases to stick


@unit
def by_stages(k, work, rtol, p):
    """Take an implicit step, cut at the first change of mode; the clock gets its length and any change."""
    m = gather_discs(k, work)
    work.clock[0].stretched = 0
    h, changes = stages_step(k, m, work, rtol, p)
    work.clock[0].length, work.clock[0].changes = h, 1 if changes else 0


@kernel
def stages_step(k, m, work, rtol, p):
    """Take an implicit step, cut at the first change of mode; return its length and whether a mode changes."""
    clock, when, tolerance = work.clock[0], work.vector[WHEN], 1e-3 * rtol
    h, slow = clock.step, max(AT_REST, 0.01 * rtol)
    present_forces(k, m, work, h, p, slow, tolerance)
    while True:
        implicit_step(k, m, work, h, p, tolerance)
        clock.steps += 1
        allowed = rtol
        if regime_changes(m, work, slow):
            allowed *= _AT_CHANGE
        if not (clock.error > allowed and h > _LEAST_STEP):
            break
        h *= max(0.2, 0.9 * (allowed / clock.error) ** 0.25)
    error = clock.error
    clock.step = h * (5.0 if error < 1e-3 * rtol else 0.9 * (rtol / error) ** 0.25)
    clock.step = min(clock.step, 0.5)
    interpolate(k, work, h)
    first = events.find_changes(k, work, 5, h, when)
    changes = first <= h
    if changes:
        if first > events.SAME_TIME:
            h = _land(k, m, work, first, p, tolerance, 0.1 * rtol)
            for i in range(k):  # times of changes, relative to the new length of the step
                when[i] -= first - h
        else:
            return first, True
    advance(k, work, h)
    set_velocity(k, work)
    set_regime(m, work, slow)
    return h, changes


@kernel
def _land(k, m, work, h, p, tolerance, residual):
    """Step to the change of mode near `h`, by Newton's iteration for the length of the step."""
    when, lead = work.vector[WHEN], 0
    for i in range(k):
        if when[i] < when[lead]:
            lead = i
    c = work.contact[lead]
    for turn in range(5):
        implicit_step(k, m, work, h, p, tolerance)
        work.clock[0].steps += 1
        d, u_n = work.vector[NEW_D, lead], work.vector[NEW_U, 3 * lead]
        if c.mode == law.OPEN:
            g, rate = d - c.d0, -u_n
        elif c.mode == law.LOAD:
            row, force = work.matrix[MASS, 3 * lead], work.stage[FORCE, 5]
            g, rate = u_n, 0.0
            for j in range(3 * k):
                rate += row[j] * force[j]
        elif c.rest - d > d - c.d0 - c.most:
            g, rate = c.rest - d, u_n
        else:
            g, rate = d - c.d0 - c.most, -u_n
        if not abs(g) > residual or turn == 4:
            break
        new = h - g / rate
        if not 0.5 * h < new < 1.5 * h:
            break
        h = new
    return h


@kernel
def _sticks(s, work, slow):
    """Return 1 if disc `s` ends the step at rest, with friction inside the disc."""
    t, i = work.vector[DISC_T], work.index[IN_DISC, s]
    u, n = work.vector[NEW_U], work.stage[FORCE, 5, 3 * i]
    size = math.sqrt(t[2 * s] * t[2 * s] + t[2 * s + 1] * t[2 * s + 1])
    speed = math.sqrt(u[3 * i + 1] * u[3 * i + 1] + u[3 * i + 2] * u[3 * i + 2])
    return 1 if size < work.contact[i].mu * n * (1.0 - 1e-9) and speed < slow else 0


@kernel
def regime_changes(m, work, slow):
    """Return whether a contact begins or ceases to stick in the step: its error estimate is then too small."""
    for s in range(m):
        if work.contact[work.index[IN_DISC, s]].sticks != _sticks(s, work, slow):
            return True
    return False


@kernel
def set_regime(m, work, slow):
    """Note which contacts stick."""
    for s in range(m):
        work.contact[work.index[IN_DISC, s]].sticks = _sticks(s, work, slow)
