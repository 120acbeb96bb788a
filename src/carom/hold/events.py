"""What can end the present mode of a held contact: its force would pull, it slips, or slip stops.

Each event is a function that is positive before and negative after, evaluated at the end of a step:

    SEPARATE   N                    the normal force
    CONE       mu N - |T|           while sticking
    REVERSE    u_t . d              while slipping; d is the direction of slip at the start of the step
"""

from __future__ import annotations

import math

from carom.jit import kernel
from carom.motion.acceleration import SLIP, STICK, acceleration
from carom.motion.contact_point import contact_arm, contact_velocity

GAP, SEPARATE, CONE, REVERSE = range(4)


@kernel
def slip(system, held, c, state):
    """Return the tangential velocity (2) of held contact c."""
    p = held.point[c]
    rx, ry, rz = contact_arm(system, c, state.Q, p[0], p[1], p[2])
    u = contact_velocity(system, c, state.v, state.w, rx, ry, rz)
    return u[1], u[2]


@kernel
def held_value(system, held, c, kind, d1, d2, state):
    """Return the event function `kind`; held.force must be that of `state`."""
    f = held.force[c]
    if kind == SEPARATE:
        return f[0]
    if kind == CONE:
        return system.contacts.friction[c] * f[0] - math.sqrt(f[1] * f[1] + f[2] * f[2])
    u1, u2 = slip(system, held, c, state)
    return u1 * d1 + u2 * d2


@kernel
def find_held_event(system, held, start, end, work):
    """Return (event, contact, d1, d2) of the first held contact whose mode ends, or event 0."""
    any_held = False
    for c in range(held.mode.size):
        if held.mode[c] != 0 and held.rest[c] == 0:
            any_held = True
    if not any_held:
        return GAP, -1, 0.0, 0.0
    acceleration(system, end.x, end.Q, end.v, end.w, held, work, work.rate[0])
    for c in range(held.mode.size):
        if held.mode[c] == 0 or held.rest[c] == 1:
            continue
        if held.force[c, 0] < 0.0:
            return SEPARATE, c, 0.0, 0.0
        if held.mode[c] == STICK:
            # a cone met to round-off (a body on the verge of slip) is no event
            room = held_value(system, held, c, CONE, 0.0, 0.0, end)
            if room < -1e-12 * held.force[c, 0]:
                return CONE, c, 0.0, 0.0
        elif held.mode[c] == SLIP:
            d1, d2 = slip(system, held, c, start)
            size = math.sqrt(d1 * d1 + d2 * d2)
            if size > 0.0:
                d1, d2 = d1 / size, d2 / size
                if held_value(system, held, c, REVERSE, d1, d2, end) < 0.0:
                    return REVERSE, c, d1, d2
    return GAP, -1, 0.0, 0.0
