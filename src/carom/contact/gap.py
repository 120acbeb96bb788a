"""Gap of a contact: the least gap of the vertices of a body, and the point that strikes."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.geometry.rotation import cross, norm, rotate_back


@inlined
def along_normal(contact, a):
    """Return n . a for a world vector."""
    n = contact.axes
    return n[0, 0] * a[0] + n[0, 1] * a[1] + n[0, 2] * a[2]


@kernel
def plane_in_body(contact, state):
    """Return the plane in body axes: n and n x w, and the height and speed of the mass centre.

    A core point p then has the gap height + n.p and the rate speed + (n x w).p, because (w x R p).n =
    R p.(n x w). This needs two products for each vertex instead of two rotations.
    """
    body, n = state[contact.body], contact.axes
    q, w = body.Q, body.w
    nx, ny, nz = rotate_back(q, n[0])
    wx, wy, wz = rotate_back(q, w)
    cx, cy, cz = cross(nx, ny, nz, wx, wy, wz)
    height = along_normal(contact, body.x) - contact.offset - contact.radius
    return nx, ny, nz, cx, cy, cz, height, along_normal(contact, body.v)


@kernel
def gap_and_rate(plane, p):
    """Return the gap of the core point p (body axes) and its rate; `plane` is from `plane_in_body`."""
    return (
        plane[6] + plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2],
        plane[7] + plane[3] * p[0] + plane[4] * p[1] + plane[5] * p[2],
    )


@kernel
def lowest(contact, vertices, state):
    """Return rho, the least distance of the body from the half-space (negative inside), and its rate."""
    plane = plane_in_body(contact, state)
    least, its_rate = math.inf, 0.0
    for i in range(contact.first, contact.last):
        z, rate = gap_and_rate(plane, vertices[i])
        if z < least:
            least, its_rate = z, rate
    return least, its_rate


@kernel
def round_off(contact, state):
    """Return the round-off of a gap [m], from the size of the coordinates that it is computed from."""
    x = state[contact.body].x
    return 1e-15 * (abs(contact.offset) + abs(x[0]) + abs(x[1]) + abs(x[2]) + contact.extent)


@kernel
def speed_of(b, extent, state):
    """Return a bound of the speed of any point of a body."""
    return norm(state[b].v) + extent * norm(state[b].w)


@kernel
def slow(contact, state):
    """Return the speed [m/s] that counts as zero: the round-off of the speeds of the body, or of both.

    It is at least the round-off of the speed of a fall by the size of the body, because a body nearly at rest
    in a crowd has no larger speeds for comparison.
    """
    s = speed_of(contact.body, contact.extent, state)
    if contact.other >= 0:
        s += speed_of(contact.other, contact.other_extent, state)
    return 1e-13 * s + contact.still


@kernel
def strike_point(contact, vertices, state, tie, out):
    """Write the lowest core point (3,), in body axes; return its gap and its rate.

    Vertices within `tie` of the lowest form one contact at their mean point: an edge or a face strikes at its
    centre, so that planar motion stays planar. If only some of them approach, only these count.
    """
    plane = plane_in_body(contact, state)
    still = slow(contact, state)
    least, approaching = lowest(contact, vertices, state)[0], False
    for i in range(contact.first, contact.last):
        z, rate = gap_and_rate(plane, vertices[i])
        if z <= least + tie and rate < -still:
            approaching = True
    count, z_mean, rate_mean = 0, 0.0, 0.0
    p0, p1, p2 = 0.0, 0.0, 0.0
    for i in range(contact.first, contact.last):
        z, rate = gap_and_rate(plane, vertices[i])
        if z <= least + tie and (rate < -still or not approaching):
            count += 1
            z_mean += z
            rate_mean += rate
            p0, p1, p2 = p0 + vertices[i, 0], p1 + vertices[i, 1], p2 + vertices[i, 2]
    f = 1.0 / count
    out[0], out[1], out[2] = f * p0, f * p1, f * p2
    return f * z_mean, f * rate_mean
