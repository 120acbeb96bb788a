"""Gap of a contact: the least over the vertices of a body, and the point that strikes."""

from __future__ import annotations

import math

from carom.geometry.rotation import rotate
from carom.jit import kernel
from carom.motion.contact_point import contact_velocity


@kernel
def height(system, c, x, Q):
    """Return the height of the mass centre over the plane of contact c."""
    b, n = system.contacts.body[c], system.contacts.axes[c]
    s = n[0, 0] * x[b, 0] + n[0, 1] * x[b, 1] + n[0, 2] * x[b, 2]
    return s - system.contacts.offset[c]


@kernel
def vertex_height(system, c, i, Q):
    """Return the height of vertex i over the mass centre, along n."""
    b, n, p = system.contacts.body[c], system.contacts.axes[c], system.contacts.vertices[i]
    rx, ry, rz = rotate(Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3], p[0], p[1], p[2])
    return n[0, 0] * rx + n[0, 1] * ry + n[0, 2] * rz


@kernel
def gap(system, c, x, Q):
    """Return rho, the least distance of the body from the half-space; negative inside."""
    contacts = system.contacts
    least = math.inf
    for i in range(contacts.start[c], contacts.start[c + 1]):
        least = min(least, vertex_height(system, c, i, Q))
    return least + height(system, c, x, Q) - contacts.radius[c]


@kernel
def vertex_state(system, c, i, x, Q, v, w):
    """Return the gap of vertex i and its rate."""
    contacts = system.contacts
    b, n, p = contacts.body[c], contacts.axes[c], contacts.vertices[i]
    r = contacts.radius[c]
    rx, ry, rz = rotate(Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3], p[0], p[1], p[2])
    rx, ry, rz = rx - r * n[0, 0], ry - r * n[0, 1], rz - r * n[0, 2]
    z = n[0, 0] * (x[b, 0] + rx) + n[0, 1] * (x[b, 1] + ry) + n[0, 2] * (x[b, 2] + rz)
    return z - contacts.offset[c], contact_velocity(system, c, v, w, rx, ry, rz)[0]


@kernel
def round_off(system, c, x):
    """Return the round-off of a gap: of the order of the unit of the coordinates it is made of [m]."""
    b = system.contacts.body[c]
    s = abs(system.contacts.offset[c]) + abs(x[b, 0]) + abs(x[b, 1]) + abs(x[b, 2])
    return 1e-15 * (s + system.contacts.size[c])


@kernel
def slow(system, c, x, v, w):
    """Return the speed [m/s] that counts as none: round-off of the speeds of the body."""
    b, size = system.contacts.body[c], system.contacts.size[c]
    s = math.sqrt(v[b, 0] ** 2 + v[b, 1] ** 2 + v[b, 2] ** 2)
    return 1e-13 * (s + size * math.sqrt(w[b, 0] ** 2 + w[b, 1] ** 2 + w[b, 2] ** 2))


@kernel
def strike_point(system, c, x, Q, v, w, tie, out):
    """Write the core point (3,) that is lowest, in body axes; return its gap and its rate.

    Vertices within `tie` of the lowest are one contact, their mean: an edge or a face strikes at its
    centre, so that planar motion stays planar. If only some of them approach, they alone count.
    """
    contacts = system.contacts
    first, last = contacts.start[c], contacts.start[c + 1]
    least = gap(system, c, x, Q)
    approaching = False
    still = slow(system, c, x, v, w)
    for i in range(first, last):
        z, rate = vertex_state(system, c, i, x, Q, v, w)
        if z <= least + tie and rate < -still:
            approaching = True
    count, z_mean, rate_mean = 0, 0.0, 0.0
    out[0], out[1], out[2] = 0.0, 0.0, 0.0
    for i in range(first, last):
        z, rate = vertex_state(system, c, i, x, Q, v, w)
        if z <= least + tie and (rate < -still or not approaching):
            count += 1
            z_mean += z
            rate_mean += rate
            for k in range(3):
                out[k] += contacts.vertices[i, k]
    for k in range(3):
        out[k] /= count
    return z_mean / count, rate_mean / count
