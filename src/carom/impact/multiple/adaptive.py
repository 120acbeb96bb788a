"""The layers of a multiple impact in steps of controlled error; each change of mode is located."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.impact.multiple import events, law
from carom.impact.multiple.by_series import series_step
from carom.impact.multiple.by_stages import by_stages
from carom.impact.multiple.layout import DISC_T, SAVED_D, SAVED_P, SAVED_WHEN, WHEN, D, P, U
from carom.impact.multiple.motion import set_velocity

ENDED, TRAPPED = 0, 1

APART = 1e-12  # velocities of approach below this part of the scale, or 1e-4 rtol, are none
WEDGED = 1e-11  # greatest velocity of a group that rests wedged
_LASTING = 0.01
_FINE = 1e-10  # stages of order four go no further
_FIRST_STEP = 0.05
_STIFF_STEPS = 4  # steps by stages before series are tried again


@kernel
def start(k, work):
    """Set the clock and the state at the entry of the layer; velocities before are in U0."""
    clock = work.clock[0]
    clock.step = _FIRST_STEP
    clock.steps, clock.events, clock.idle, clock.branched, clock.stiff = 0, 0, 0, 0, 0
    clock.rest, clock.cut, clock.stretched = 0, 0, 0
    for i in range(3 * k):
        work.vector[P, i] = 0.0
        work.vector[DISC_T, i] = 0.0  # a first guess: not that of another impact
    for i in range(k):
        c = work.contact[i]
        c.mode, c.slope, c.rest, c.most = law.OPEN, 0.0, 0.0, 0.0
        c.d0, c.mark, c.sticks, c.wedged = 0.0, 0.0, 0, 0
        c.loading, c.unloading, c.absorbed, c.returned, c.loss = 0.0, 0.0, 0.0, 0.0, 0.0
        work.vector[D, i] = 0.0
    set_velocity(k, work)
    for i in range(k):
        if work.vector[U, 3 * i] <= APART:  # those that touch begin to load, if they are driven
            law.close(work.contact[i])


@kernel
def branch(k, work, latest):
    """Save the state at the first unloading: what came before does not depend on restitution."""
    clock = work.clock[0]
    clock.branched, clock.saved_step, clock.saved_latest = 1, clock.step, latest
    clock.saved_stiff = clock.stiff
    clock.saved_idle = clock.idle
    for i in range(3 * k):
        work.vector[SAVED_P, i] = work.vector[P, i]
    for i in range(k):
        work.saved[i] = work.contact[i]
        work.vector[SAVED_D, i] = work.vector[D, i]
        work.vector[SAVED_WHEN, i] = work.vector[WHEN, i]


@kernel
def resume(k, work, p):
    """Go back to the first unloading, with the coefficients e that the contacts have now; unload."""
    clock = work.clock[0]
    clock.step, clock.idle, clock.stiff = clock.saved_step, clock.saved_idle, clock.saved_stiff
    clock.rest, clock.cut, clock.stretched = 0, 0, 0
    for i in range(3 * k):
        work.vector[P, i] = work.vector[SAVED_P, i]
    for i in range(k):
        e = work.contact[i].e
        work.contact[i] = work.saved[i]
        work.contact[i].e = e
        work.vector[D, i] = work.vector[SAVED_D, i]
    when = work.vector[SAVED_WHEN]
    events.change_modes(k, work, when, clock.saved_latest, p, clock.idle > 2 * k)
    clock.events += 1


@inlined
def drift(k, work, apart, p):
    """Return 1 if the event is over. Where no force acts, move with constant velocities to the next closure."""
    u, d = work.vector[U], work.vector[D]
    for i in range(k):
        c = work.contact[i]
        forced = law.force(c, d[i], p) > events.ROUND_OFF
        if c.mode != law.OPEN and (forced or u[3 * i] < -apart):
            return 0
    time = math.inf
    for i in range(k):
        c = work.contact[i]
        if c.mode != law.OPEN:
            law.release(c, d[i], work.vector[P, 3 * i], p)
        if u[3 * i] < -apart:
            time = min(time, max(0.0, c.d0 - d[i]) / -u[3 * i])
    if not time < math.inf:
        return 1
    for i in range(k):
        c = work.contact[i]
        near = u[3 * i] < -apart and max(0.0, c.d0 - d[i]) / -u[3 * i] <= time + events.SAME_TIME
        d[i] -= u[3 * i] * time
        if near:
            d[i] = c.d0
            law.close(c)
            c.sticks = 0
    work.clock[0].events += 1
    return 0


@inlined
def wedged(k, work, h, p):
    """Return whether all that are closed rest though forces act: friction holds them, and so it stays.

    With u = 0 in all rows that have forces their power is nothing for good, so W times the forces is, and what
    has opened keeps its velocity too. At the deepest point all may rest for a moment: it must last for a
    step of some length `h`.
    """
    clock, u = work.clock[0], work.vector[U]
    for i in range(k):
        n, active = 3 * i, work.contact[i].mode != law.OPEN
        slip = abs(u[n + 1]) + abs(u[n + 2]) if active and work.contact[i].mu > 0.0 else 0.0
        if not (slip <= WEDGED and (abs(u[n]) if active else -u[n]) <= WEDGED):
            clock.rest = 0
            return False
    clock.rest += 1 if h >= _LASTING and clock.stretched == 0 else 0
    if clock.rest < 2:
        return False
    for i in range(k):  # what is stored is lost
        work.contact[i].wedged = 1 if law.force(work.contact[i], work.vector[D, i], p) > 0.0 else 0
        law.abandon(work.contact[i], work.vector[D, i], p)
    return True


@kernel
def traverse(k, work, rtol, p, max_events, max_steps):
    """Go on to the end of the event: ENDED, or TRAPPED after too many changes of mode or steps."""
    clock = work.clock[0]
    when = work.vector[WHEN]
    set_velocity(k, work)
    apart = max(APART, 1e-4 * rtol)
    first_events, first_steps, h = clock.events, clock.steps, 0.0
    while True:
        if drift(k, work, apart, p) == 1 or wedged(k, work, h, p):
            set_velocity(k, work)
            return ENDED
        if (
            clock.events - first_events > max_events
            or clock.steps - first_steps > max_steps
            or clock.steps > clock.left
            or not clock.step > 0.0
        ):
            return TRAPPED
        h, changes = -1.0, False
        if p == 1.0 and clock.stiff == 0:
            h, changes = series_step(k, work, rtol)
        if h < 0.0:
            fine = max(0.1 * rtol, min(rtol, _FINE)) if p == 1.0 else rtol  # as exact as series are
            by_stages(k, work, fine, p)
            h, changes = clock.length, clock.changes == 1
            clock.stiff = clock.stiff - 1 if clock.stiff > 0 else _STIFF_STEPS - 1
        if changes:
            latest = h + events.SAME_TIME
            clock.idle = clock.idle + 1 if h <= events.SAME_TIME else 0
            if clock.branched == 0 and events.would_unload(k, work, when, latest):
                branch(k, work, latest)
            events.change_modes(k, work, when, latest, p, clock.idle > 2 * k)
            clock.events += 1


@unit
def pass_layer(k, work, rtol, p, max_events, max_steps):
    """Traverse the layer; the code goes to the clock."""
    work.clock[0].code = traverse(k, work, rtol, p, max_events, max_steps)
