"""Gap of a contact: the least over the vertices of a body, and the point that strikes."""

from __future__ import annotations

import math

from carom.geometry.rotation import rotate_back
from carom.jit import inlined, kernel
from carom.motion.contact_point import contact_arm, contact_velocity


@inlined
def along_normal(contact, a):
    """Return n . a for a world vector."""
    n = contact.axes
    return n[0, 0] * a[0] + n[0, 1] * a[1] + n[0, 2] * a[2]


@kernel
def lowest(contact, vertices, state):
    """Return rho, the least distance of the body from the half-space (negative inside), and its vertex."""
    x, q, n = state[contact.body].x, state[contact.body].Q, contact.axes
    # n in body axes, so that a vertex costs one product
    nx, ny, nz = rotate_back(q[0], q[1], q[2], q[3], n[0, 0], n[0, 1], n[0, 2])
    least, which = math.inf, contact.first
    for i in range(contact.first, contact.last):
        height = nx * vertices[i, 0] + ny * vertices[i, 1] + nz * vertices[i, 2]
        if height < least:
            least, which = height, i
    return least + along_normal(contact, x) - contact.offset - contact.radius, which


@kernel
def point_state(contact, p, state):
    """Return the gap of the core point p (body axes) and its rate."""
    rx, ry, rz = contact_arm(contact, state, p)
    n = contact.axes
    z = n[0, 0] * rx + n[0, 1] * ry + n[0, 2] * rz
    z += along_normal(contact, state[contact.body].x) - contact.offset
    return z, contact_velocity(contact, state, rx, ry, rz)[0]


@kernel
def round_off(contact, state):
    """Return the round-off of a gap: of the order of the unit of the coordinates it is made of [m]."""
    x = state[contact.body].x
    return 1e-15 * (abs(contact.offset) + abs(x[0]) + abs(x[1]) + abs(x[2]) + contact.extent)


@kernel
def slow(contact, state):
    """Return the speed [m/s] that counts as none: round-off of the speeds of the body."""
    v, w = state[contact.body].v, state[contact.body].w
    s = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    return 1e-13 * (s + contact.extent * math.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]))


@kernel
def strike_point(contact, vertices, state, tie, out):
    """Write the core point (3,) that is lowest, in body axes; return its gap and its rate.

    Vertices within `tie` of the lowest are one contact, their mean: an edge or a face strikes at its
    centre, so that planar motion stays planar. If only some of them approach, they alone count.
    """
    least, _ = lowest(contact, vertices, state)
    still = slow(contact, state)
    approaching = False
    for i in range(contact.first, contact.last):
        z, rate = point_state(contact, vertices[i], state)
        if z <= least + tie and rate < -still:
            approaching = True
    count, z_mean, rate_mean = 0, 0.0, 0.0
    p0, p1, p2 = 0.0, 0.0, 0.0
    for i in range(contact.first, contact.last):
        z, rate = point_state(contact, vertices[i], state)
        if z <= least + tie and (rate < -still or not approaching):
            count += 1
            z_mean += z
            rate_mean += rate
            p0, p1, p2 = p0 + vertices[i, 0], p1 + vertices[i, 1], p2 + vertices[i, 2]
    f = 1.0 / count
    out[0], out[1], out[2] = f * p0, f * p1, f * p2
    return f * z_mean, f * rate_mean
