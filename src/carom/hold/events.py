"""What can end the present mode of a held contact: its force would pull, it slips, or slip stops.

Each event is a function that is positive before and negative after, evaluated at the end of a step:

    SEPARATE   N                    the normal force
    CONE       mu N - |T|           while sticking
    REVERSE    u_t . d              while slipping; d is the direction of slip at the start of the step
"""

from __future__ import annotations

import math

from carom.jit import inlined, kernel
from carom.motion.acceleration import OPEN, SLIP, acceleration
from carom.motion.contact_point import contact_velocity, place

GAP, SEPARATE, CONE, REVERSE = range(4)


@kernel
def held_value(system, hold, kind, d1, d2, state, work):
    """Return the event function `kind`; the force of the contact must be that of `state`."""
    f, contact = hold.force, system.contacts[hold.contact]
    if kind == SEPARATE:
        return f[0]
    if kind == CONE:
        return contact.friction_held * f[0] - math.sqrt(f[1] * f[1] + f[2] * f[2])
    point = work.point[0]
    place(contact, hold.point, state, point)
    _, u1, u2 = contact_velocity(point, state)
    return u1 * d1 + u2 * d2


@inlined
def end_forces(system, held, state, work):
    """Put the forces of points that are held one to a body, at `state`, in place if any moves."""
    for i in range(held.count[0]):
        hold = held.points[i]
        if hold.mode != OPEN and hold.rest == 0 and hold.several == 0:
            acceleration(system, state, held, work, work.stages[0])
            return


@inlined
def find_held_event(system, held, end, work):
    """Return (event, place in the list, d1, d2) of the first held point whose mode ends; place -1 if none."""
    for i in range(held.count[0]):
        hold = held.points[i]
        if hold.mode == OPEN or hold.rest == 1 or hold.several == 1:
            continue
        if hold.force[0] < 0.0:
            return SEPARATE, i, 0.0, 0.0
        if hold.mode == SLIP:
            d1, d2 = hold.heading[0], hold.heading[1]
            if held_value(system, hold, REVERSE, d1, d2, end, work) < 0.0:
                return REVERSE, i, d1, d2
        # a cone met to round-off (a body on the verge of slip) is no event
        elif held_value(system, hold, CONE, 0.0, 0.0, end, work) < -1e-12 * hold.force[0]:
            return CONE, i, 0.0, 0.0
    return GAP, -1, 0.0, 0.0


@inlined
def turned(system, held, end, work):
    """Return whether slip of a point has turned by more than 60 degrees within the step.

    Friction turns with it; no method keeps its order over such a step.
    """
    for i in range(held.count[0]):
        hold = held.points[i]
        if hold.mode == SLIP and hold.rest == 0 and hold.several == 0:
            d1, d2 = hold.heading[0], hold.heading[1]
            point = work.point[0]
            place(system.contacts[hold.contact], hold.point, end, point)
            _, u1, u2 = contact_velocity(point, end)
            along, square = u1 * d1 + u2 * d2, u1 * u1 + u2 * u2
            if along * along < 0.25 * square * (d1 * d1 + d2 * d2):
                return True
    return False
