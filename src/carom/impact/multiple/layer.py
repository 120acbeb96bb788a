"""The state of a group in its layers: velocities, progress, opening, rest (mathematics page, §2.1).

The layers obey udot = W lambda, ddot = -u_n, Pdot = lambda.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.friction.dense import add_product
from carom.geometry.thresholds import ROUND_OFF
from carom.impact.multiple import normal_law as law
from carom.impact.thresholds import GROUP_ERROR, IMPACT_ERROR, INSTANT, LASTING_STEP, LAYER_STEP


@kernel
def set_velocity(k, work):
    """Write u = u0 + W P, so that momentum is exact at every step."""
    u, u0 = work.now.velocity, work.before
    for i in range(3 * k):
        u[i] = u0[i]
    add_product(3 * k, work.W, work.now.impulse, u)


@kernel
def start(k, work):
    """Set the clock and the state at the entry of the layer; velocities before are in `before`."""
    clock = work.clock[0]
    clock.step = LAYER_STEP
    clock.steps, clock.events, clock.idle, clock.branched, clock.stiff = 0, 0, 0, 0, 0
    clock.rest, clock.cut, clock.stretched = 0, 0, 0
    for i in range(3 * k):
        work.now.impulse[i] = 0.0
    for i in range(2 * k):
        work.disc_force[i] = 0.0  # a first guess, independent of other impacts
    for i in range(k):
        c = work.contact[i]
        c.mode, c.slope, c.rest, c.most = law.OPEN, 0.0, 0.0, 0.0
        c.d0, c.mark, c.sticks, c.wedged = 0.0, 0.0, 0, 0
        c.loading, c.unloading, c.absorbed, c.returned, c.loss = 0.0, 0.0, 0.0, 0.0, 0.0
        work.now.depth[i] = 0.0
    set_velocity(k, work)
    for i in range(k):
        if work.now.velocity[3 * i] <= ROUND_OFF:  # contacts at rest too, as forces may press them
            law.close(work.contact[i])


@kernel
def branch(k, work, latest):
    """Save the state at the first unloading; it does not depend on restitution."""
    clock = work.clock[0]
    clock.branched, clock.saved_step, clock.saved_latest = 1, clock.step, latest
    clock.saved_stiff = clock.stiff
    clock.saved_idle = clock.idle
    for i in range(3 * k):
        work.saved_impulse[i] = work.now.impulse[i]
    for i in range(k):
        work.saved[i] = work.contact[i]
        work.saved_depth[i] = work.now.depth[i]


@kernel
def resume(k, work, p):
    """Go back to the first unloading with the present coefficients e of the contacts; unload."""
    clock = work.clock[0]
    clock.step, clock.idle, clock.stiff = clock.saved_step, clock.saved_idle, clock.saved_stiff
    clock.rest, clock.cut, clock.stretched = 0, 0, 0
    for i in range(3 * k):
        work.now.impulse[i] = work.saved_impulse[i]
    for i in range(k):
        e = work.contact[i].e
        work.contact[i] = work.saved[i]
        work.contact[i].e = e
        work.now.depth[i] = work.saved_depth[i]
    law.change_modes(k, work, clock.saved_latest, p, clock.idle > 2 * k)
    clock.events += 1


@inlined
def drift(k, work, apart, p):
    """Return 1 if the event is over; if no force acts, move with constant velocities to the next closure."""
    u, d = work.now.velocity, work.now.depth
    for i in range(k):
        c = work.contact[i]
        forced = law.force(c, d[i], p) > IMPACT_ERROR
        if c.mode != law.OPEN and (forced or u[3 * i] < -apart):
            return 0
    time = math.inf
    for i in range(k):
        c = work.contact[i]
        if c.mode != law.OPEN:
            law.release(c, d[i], work.now.impulse[3 * i], p)
            law.note_stick(i, work)
        if u[3 * i] < -apart:
            time = min(time, max(0.0, c.d0 - d[i]) / -u[3 * i])
    if not time < math.inf:
        return 1
    for i in range(k):
        c = work.contact[i]
        near = u[3 * i] < -apart and max(0.0, c.d0 - d[i]) / -u[3 * i] <= time + INSTANT
        d[i] -= u[3 * i] * time
        if near:
            d[i] = c.d0
            law.close(c)
            c.sticks = 0
    work.clock[0].events += 1
    return 0


@inlined
def wedged(k, work, h, p):
    """Return whether all closed contacts rest although forces act: friction blocks them for good.

    With u = 0 in all rows with forces, their power stays zero. Then W times the forces is zero, so that open
    contacts keep their velocity too. At the deepest point all contacts may rest for an instant, so only rest
    during steps of some length counts; `h` is the last step.
    """
    clock, u = work.clock[0], work.now.velocity
    for i in range(k):
        n, active = 3 * i, work.contact[i].mode != law.OPEN
        slip = abs(u[n + 1]) + abs(u[n + 2]) if active and work.contact[i].mu > 0.0 else 0.0
        if not (slip <= GROUP_ERROR and (abs(u[n]) if active else -u[n]) <= GROUP_ERROR):
            clock.rest = 0
            return False
    clock.rest += 1 if h >= LASTING_STEP and clock.stretched == 0 else 0
    if clock.rest < 2:
        return False
    for i in range(k):  # stored energy is lost
        work.contact[i].wedged = 1 if law.force(work.contact[i], work.now.depth[i], p) > 0.0 else 0
        law.abandon(work.contact[i], work.now.depth[i], p)
    return True
