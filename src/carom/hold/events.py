"""What can end the present mode of a held contact: its force would pull, it slips, or slip stops.

Each event is a function that is positive before and negative after, evaluated at the end of a step:

    SEPARATE   N                    the normal force
    CONE       mu N - |T|           while sticking
    REVERSE    u_t . d              while slipping; d is the direction of slip at the start of the step
"""

from __future__ import annotations

import math

from carom.jit import inlined, kernel
from carom.motion.acceleration import OPEN, SLIP, STICK, acceleration
from carom.motion.contact_point import contact_arm, contact_velocity

GAP, SEPARATE, CONE, REVERSE = range(4)


@kernel
def slip(contact, hold, state):
    """Return the tangential velocity (2) of a held contact."""
    rx, ry, rz = contact_arm(contact, state, hold.point)
    u = contact_velocity(contact, state, rx, ry, rz)
    return u[1], u[2]


@kernel
def held_value(contact, hold, kind, d1, d2, state):
    """Return the event function `kind`; the force of the contact must be that of `state`."""
    f = hold.force
    if kind == SEPARATE:
        return f[0]
    if kind == CONE:
        return contact.friction * f[0] - math.sqrt(f[1] * f[1] + f[2] * f[2])
    u1, u2 = slip(contact, hold, state)
    return u1 * d1 + u2 * d2


@inlined
def end_forces(system, held, state, work):
    """Put the forces of held contacts at `state` in place, if any moves."""
    for c in range(held.shape[0]):
        if held[c].mode != OPEN and held[c].rest == 0:
            acceleration(system, state, held, work, work.stages[0])
            return


@inlined
def find_held_event(system, held, end):
    """Return (event, contact, d1, d2) of the first held contact whose mode ends; contact -1 if none."""
    for c in range(held.shape[0]):
        contact, hold = system.contacts[c], held[c]
        if hold.mode == OPEN or hold.rest == 1:
            continue
        if hold.force[0] < 0.0:
            return SEPARATE, c, 0.0, 0.0
        if hold.mode == STICK:
            # a cone met to round-off (a body on the verge of slip) is no event
            if held_value(contact, hold, CONE, 0.0, 0.0, end) < -1e-12 * hold.force[0]:
                return CONE, c, 0.0, 0.0
        elif hold.mode == SLIP:
            d1, d2 = hold.heading[0], hold.heading[1]
            if held_value(contact, hold, REVERSE, d1, d2, end) < 0.0:
                return REVERSE, c, d1, d2
    return GAP, -1, 0.0, 0.0
