"""Can a body have touched the half-space between two states? No impact is missed, however large the step.

Of each vertex the gap z and its rate are known at both ends, and |d2z/dt2| <= a in between. Then

    z(t) >= z0 + z0' t - a t^2/2,      z(t) >= z1 - z1' s - a s^2/2,   s = h - t,

and the path is clear if the times for which either bound is positive, (z0' + sqrt(z0'^2 + 2 a z0))/a
and the same from the end, together reach h. If not, the caller cuts the step in half. In free flight a is
exact: |n.g| + |w|^2 r, with |w| bounded by the energy of rotation; otherwise it is taken as twice what the
stages of the step have seen.
"""

from __future__ import annotations

import math

from carom.contact.gap import height, round_off, vertex_state
from carom.jit import kernel
from carom.motion.acceleration import OPEN
from carom.motion.explicit import is_held

CLEAR, BELOW, UNSURE = range(3)


@kernel
def greatest_acceleration(system, held, c, state, work):
    """Return bounds of the normal acceleration of the mass centre and of a point, for contact c."""
    bodies, contacts = system.bodies, system.contacts
    b, n, r = contacts.body[c], contacts.axes[c], contacts.size[c]
    if bodies.ballistic[b] == 1 and not is_held(system, held, b):
        g, w, J = bodies.gravity, state.w[b], bodies.inertia[b]
        centre = abs(n[0, 0] * g[0] + n[0, 1] * g[1] + n[0, 2] * g[2])
        spin2 = w[0] * w[0] + w[1] * w[1] + w[2] * w[2]
        if bodies.isotropic[b] == 1:
            return centre, centre + spin2 * r
        # 2T = W.J W is kept: |w|^2 <= 2T/J_min <= |w0|^2 J_max/J_min, |w'| <= |w|^2 (J_max - J_min)/J_min
        low, high = min(J[0], min(J[1], J[2])), max(J[0], max(J[1], J[2]))
        spin2 *= high / low
        return centre, centre + spin2 * r * (1.0 + (high - low) / low)
    centre = 2.0 * work.bound[b, 0]
    return centre, centre + 2.0 * r * (work.bound[b, 1] + work.bound[b, 2] * work.bound[b, 2])


@kernel
def reach(z, rate, a):
    """Return for how long z + rate t - a t^2/2 stays positive."""
    z = max(z, 0.0)
    if a <= 0.0:
        return math.inf if rate >= 0.0 else -z / rate
    return (rate + math.sqrt(rate * rate + 2.0 * a * z)) / a


@kernel
def passage(system, held, c, start, end, h, work, tolerance, tie):
    """Return CLEAR, BELOW (the end is inside the half-space) or UNSURE, and a time before any contact.

    Vertices that carry a held contact (gap below `tie` at both ends) are left out.
    """
    bodies, contacts = system.bodies, system.contacts
    b, n = contacts.body[c], contacts.axes[c]
    if held.rest[c] == 1:
        return CLEAR, h
    flying = bodies.ballistic[b] == 1 and not is_held(system, held, b)
    centre, a = greatest_acceleration(system, held, c, start, work)
    # the ball around the body first
    margin = contacts.size[c] + contacts.radius[c]
    z0, z1 = height(system, c, start.x, start.Q) - margin, height(system, c, end.x, end.Q) - margin
    if z0 > 0.0 and z1 > 0.0:
        s0 = n[0, 0] * start.v[b, 0] + n[0, 1] * start.v[b, 1] + n[0, 2] * start.v[b, 2]
        s1 = n[0, 0] * end.v[b, 0] + n[0, 1] * end.v[b, 1] + n[0, 2] * end.v[b, 2]
        if flying and (s1 <= 0.0 or s0 >= 0.0):  # constant acceleration: least at an end
            return CLEAR, h
        if reach(z0, s0, centre) + reach(z1, -s1, centre) >= h:
            return CLEAR, h
    verdict, first = CLEAR, h
    tiny = max(tolerance * contacts.size[c], round_off(system, c, end.x))
    for i in range(contacts.start[c], contacts.start[c + 1]):
        z0, rate0 = vertex_state(system, c, i, start.x, start.Q, start.v, start.w)
        z1, rate1 = vertex_state(system, c, i, end.x, end.Q, end.v, end.w)
        if held.mode[c] != OPEN and z0 <= tie and z1 <= tie:
            continue
        t0 = reach(z0, rate0, a)
        first = min(first, t0)
        if not (z1 >= -tiny):
            verdict = BELOW
        elif verdict == CLEAR and t0 + reach(z1, -rate1, a) < h * (1.0 - 1e-12):
            if a * h * h > 8.0 * tiny and held.leaving[c] == 0:
                verdict = UNSURE
    return verdict, first
