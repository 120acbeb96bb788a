"""Events that end a mode of a persistent contact: its normal force vanishes, it slips, or slip stops.

The function of an event is positive before it and negative after it, and is evaluated at the end of a step:

    SEPARATE   N                    the normal force
    CONE       mu N - |T|           while sticking
               (of one of several points: `carom.persistent.margins`)
    REVERSE    u_t . d              while slipping; d is the direction of slip at the start of the step
    JAM        k                    while slipping (`carom.persistent.jam`)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.contact.place import place_active
from carom.dynamics.acceleration import OPEN, SLIP, STICK, acceleration
from carom.kinematics.contact_point import contact_velocity
from carom.persistent.jam import JAMMED, yields

GAP, SEPARATE, CONE, REVERSE, JAM = range(5)
_NO_GRIP = 1e-9  # of mu N: less friction is round-off


@kernel
def contact_event_value(system, active_point, kind, d1, d2, state, work):
    """Return the event function `kind`; the force of the contact must be that of `state`."""
    f, contact = active_point.force, system.contacts[active_point.contact]
    if active_point.several == 1 and kind != JAM:
        return active_point.lift if kind == SEPARATE else active_point.grip
    if kind == SEPARATE:
        return f[0]
    if kind == CONE:
        return contact.friction_held * f[0] - math.sqrt(f[1] * f[1] + f[2] * f[2])
    point = work.point[0]
    place_active(system, active_point, state, point, work)
    _, u1, u2 = contact_velocity(point, state)
    if kind == JAM:
        return yields(active_point.W, contact.friction_held, u1, u2) - JAMMED * active_point.W[0, 0]
    return u1 * d1 + u2 * d2


@inlined
def note_first_forces(active):
    """Keep what the active points have at the start of a step: its trial steps write those of their ends."""
    for i in range(active.count[0]):
        active_point = active.points[i]
        first, turns = active_point.first_stop, active_point.turn_stop
        first[0], first[1], first[2] = active_point.stop, turns[0], turns[1]
        for r in range(3):
            active_point.first_force[r] = active_point.force[r]


@inlined
def end_forces(system, active, state, work):
    """Write the forces at `state` of points that are the only active points of their bodies, if any moves."""
    for i in range(active.count[0]):
        active_point = active.points[i]
        if active_point.mode != OPEN and active_point.rest == 0 and active_point.several == 0:
            acceleration(system, state, active, work, work.stages[0])
            return


@inlined
def find_contact_event(system, active, end, h, work):
    """Return (event, index, d1, d2) of the first active point whose mode ends; index -1 if there is none.

    Slip that is turned by the error of the step h is no sign of a jam; `turned` handles it.
    """
    for i in range(active.count[0]):
        active_point = active.points[i]
        if active_point.mode == OPEN or active_point.rest == 1:
            continue
        if active_point.several == 1:
            if work.search[0].eager == 1 and active_point.lift < 0.0:
                return SEPARATE, i, 0.0, 0.0
            if work.search[0].eager == 1 and active_point.grip < 0.0:
                return CONE, i, 0.0, 0.0
            continue
        jams = (
            active_point.mode == SLIP
            and contact_event_value(system, active_point, JAM, 0.0, 0.0, end, work) <= 0.0
        )
        if jams and not reverses(system, active_point, end, work):
            if strays(system, active_point, end, h, work) != 0:
                continue
            return JAM, i, 0.0, 0.0
        if active_point.force[0] < 0.0 and not jams and not grips(system, active_point):
            return SEPARATE, i, 0.0, 0.0
        if active_point.mode == SLIP:
            d1, d2 = active_point.heading[0], active_point.heading[1]
            if reverses(system, active_point, end, work):
                return REVERSE, i, d1, d2
        # a force on the cone to round-off (a body that is about to slip) is no event
        elif (
            contact_event_value(system, active_point, CONE, 0.0, 0.0, end, work)
            < -1e-12 * active_point.force[0]
        ):
            return CONE, i, 0.0, 0.0
    return GAP, -1, 0.0, 0.0


@inlined
def grips(system, active_point):
    """Return whether a point sticks with more friction than round-off, so that it slips before it opens."""
    f, mu = active_point.force, system.contacts[active_point.contact].friction_held
    return active_point.mode == STICK and math.sqrt(
        f[1] * f[1] + f[2] * f[2]
    ) > _NO_GRIP * mu * abs(f[0])


@inlined
def reverses(system, active_point, end, work):
    """Return whether slip has stopped and reversed; slip that has turned sideways does not count."""
    point = work.point[0]
    place_active(system, active_point, end, point, work)
    _, u1, u2 = contact_velocity(point, end)
    d1, d2 = active_point.heading[0], active_point.heading[1]
    across = abs(u1 * d2 - u2 * d1)
    return (
        active_point.speed > 0.0 and u1 * d1 + u2 * d2 < 0.0 and across <= 0.1 * active_point.speed
    )


@inlined
def turned(system, active, end, h, work):
    """Check for slip that turns within the step h: 0 none, 1 the step is too long, 2 use another method.

    The step is too long if slip turns by more than 60 degrees. If friction can reverse slip within the step, mu
    N h W_tt > |u_t|, an explicit step does not work: its stages oscillate about a slip that does not end, and
    this adds energy. Then the implicit step for several points moves the body
    (`carom.persistent.contact_step`).
    """
    found = 0
    for i in range(active.count[0]):
        active_point = active.points[i]
        if active_point.mode == SLIP and active_point.rest == 0 and active_point.several == 0:
            far = strays(system, active_point, end, h, work)
            if far == 2:
                active_point.several, active_point.stop = 1, math.inf
            found = max(found, far)
    return found


@kernel
def strays(system, active_point, end, h, work):
    """Return the result of `turned` for one point."""
    d1, d2 = active_point.heading[0], active_point.heading[1]
    point, contact = work.point[0], system.contacts[active_point.contact]
    place_active(system, active_point, end, point, work)
    _, u1, u2 = contact_velocity(point, end)
    along, across, square = u1 * d1 + u2 * d2, u1 * d2 - u2 * d1, u1 * u1 + u2 * u2
    if across * across > 1e-12 * square and braked(contact, active_point, h) ** 2 > square:
        return 2
    return 1 if along < 0.5 * math.sqrt(square * (d1 * d1 + d2 * d2)) else 0


@inlined
def braked(contact, active_point, h):
    """Return the slip that friction can remove in the time h."""
    return (
        h
        * contact.friction_held
        * abs(active_point.force[0])
        * (active_point.W[1, 1] + active_point.W[2, 2])
    )


@inlined
def slides_on(system, active_point, now, h, work):
    """Return whether a point slides too fast for friction to turn it within a step."""
    if active_point.mode != SLIP or active_point.other >= 0:
        return False
    contact, point = system.contacts[active_point.contact], work.point[0]
    place_active(system, active_point, now, point, work)
    _, u1, u2 = contact_velocity(point, now)
    return 100.0 * braked(contact, active_point, h) ** 2 < u1 * u1 + u2 * u2


@kernel
def residual(system, active, state, work):
    """Return the largest forbidden velocity of a single contact point: normal, and tangential if it sticks."""
    worst, point = 0.0, work.point[0]
    for i in range(active.count[0]):
        active_point = active.points[i]
        if active_point.several == 0 and active_point.rest == 0:
            place_active(system, active_point, state, point, work)
            u0, u1, u2 = contact_velocity(point, state)
            slip = math.sqrt(u1 * u1 + u2 * u2) if active_point.mode == STICK else 0.0
            worst = max(worst, max(abs(u0), slip))
    return worst
