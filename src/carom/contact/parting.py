"""Bound of the time during which two convex cores stay separated along a fixed direction.

After a time t, the height of a core point p of a moving body along the fixed n is at least

    n.x + n.v t + (m + t c).p - a t^2/2,   m, c: n and n x w in body axes.

The least value over a core is a support function, h(d) = max d.p, so that the gap is at least

    F(t) = n.(x_a - x_b) + n.(v_a - v_b) t - h_A(-(m_a + t c_a)) - h_B(m_b + t c_b) - radii - a t^2/2.

F is concave, because it is a minimum of concave functions. So chords lie below it, and the root of a chord from
a point above zero to one below comes before the root of F. All points of the two cores are apart as long as
F > 0. For cores with vertices, the bound of `continuous_detection_pair.time_apart` is the same.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.layout import BOX, CYLINDER, ELLIPSOID, HULL, SEGMENT
from carom.contact.place_of_other import on_half_space
from carom.geometry.rotation import cross, rotate_back

HALVES = 30  # largest number of halvings of the step, until the bound is above zero
CHORDS = 4  # each comes nearer to the root


@kernel
def height(solid, hulls, x, y, z):
    """Return the support function of a core: the greatest d.p over its points, d in axes of its body."""
    s, o, h, kind = solid.Q, solid.x, solid.half, solid.kind
    base = o[0] * x + o[1] * y + o[2] * z
    x, y, z = rotate_back(s[0], s[1], s[2], s[3], x, y, z)
    if kind == SEGMENT:
        return base + h[2] * abs(z)
    if kind == BOX:
        return base + h[0] * abs(x) + h[1] * abs(y) + h[2] * abs(z)
    if kind == CYLINDER:
        return base + h[0] * math.sqrt(x * x + y * y) + h[2] * abs(z)
    if kind == ELLIPSOID:
        return base + math.sqrt((h[0] * x) ** 2 + (h[1] * y) ** 2 + (h[2] * z) ** 2)
    if kind == HULL:
        best = -math.inf
        for i in range(solid.first, solid.last):
            p = hulls.vertices[i]
            best = max(best, p[0] * x + p[1] * y + p[2] * z)
        return base + best
    return base


@kernel
def seen(n, body):
    """Return n and n x w in body axes, and height and speed along n of the mass centre."""
    q, w, x, v = body.Q, body.w, body.x, body.v
    mx, my, mz = rotate_back(q[0], q[1], q[2], q[3], n[0], n[1], n[2])
    wx, wy, wz = rotate_back(q[0], q[1], q[2], q[3], w[0], w[1], w[2])
    cx, cy, cz = cross(mx, my, mz, wx, wy, wz)
    z = n[0] * x[0] + n[1] * x[1] + n[2] * x[2]
    return mx, my, mz, cx, cy, cz, z, n[0] * v[0] + n[1] * v[1] + n[2] * v[2]


@kernel
def least_gap(system, contact, n, state, t, a):
    """Return F(t), negative t for the past; a bounds the relative acceleration of any two points."""
    m = seen(n, state[contact.body])
    hulls, solid = system.hulls, system.solids[contact.solid]
    gap = m[6] + t * m[7] - contact.radius - 0.5 * a * t * t
    gap -= height(solid, hulls, -m[0] - t * m[3], -m[1] - t * m[4], -m[2] - t * m[5])
    if on_half_space(contact):
        return gap - contact.offset
    solid = system.solids[contact.other_solid]
    if contact.static == 1:
        return gap - height(solid, hulls, n[0], n[1], n[2])
    m = seen(n, state[contact.other])
    gap -= m[6] + t * m[7]
    return gap - height(solid, hulls, m[0] + t * m[3], m[1] + t * m[4], m[2] + t * m[5])


@kernel
def time_parted(system, contact, n, sign, state, a, h):
    """Return for how long, up to h, all points of two cores stay apart along n; sign -1: in the past.

    They may touch at the beginning, for instance after an impact: because F is concave, F > 0 at a time t is
    enough for all earlier times.
    """
    g = least_gap(system, contact, n, state, sign * h, a)
    if g >= 0.0:
        return h
    t, end = h, h
    for _ in range(HALVES):
        t *= 0.5
        f = least_gap(system, contact, n, state, sign * t, a)
        if f > 0.0:
            for _ in range(CHORDS):
                t += (end - t) * f / (f - g)
                f = least_gap(system, contact, n, state, sign * t, a)
                if not f > 0.0:  # the root itself, to round-off
                    break
            return t
        end, g = t, f
    return 0.0
