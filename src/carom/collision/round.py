"""Nearest points of balls and capsules, and of discs in one plane, in closed form.

Each function writes the nearest pair as the first of the points `found`.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision.faces import LOWEST
from carom.collision.features import NOBODY, OF_SUPPORT, edge_part, of_vertex_a
from carom.collision.found import put, put_parts
from carom.collision.frame import from_a
from carom.collision.layout import CYLINDER
from carom.collision.segments import edge_on_edge
from carom.collision.thresholds import LEAST_SINE
from carom.geometry.thresholds import RESOLUTION


@inlined
def direction(x, y, z, ex, ey, ez):
    """Return the length of a vector and its direction; for a zero vector, the direction (ex, ey, ez)."""
    d = math.sqrt(x * x + y * y + z * z)
    if d > 0.0:
        return d, x / d, y / d, z / d
    return 0.0, ex, ey, ez


@kernel
def point_point(pair):
    """Find the nearest points of two balls."""
    p = pair.state.p
    d, nx, ny, nz = direction(p[0], p[1], p[2], 0.0, 0.0, 1.0)
    gap = d - pair.a.radius - pair.b.radius
    put(
        pair.found[0], gap, (nx, ny, nz), (p[0], p[1], p[2]), (0.0, 0.0, 0.0), of_vertex_a(0)
    )  # fmt: skip
    put_parts(pair.found[0], NOBODY, OF_SUPPORT, OF_SUPPORT)


@kernel
def point_segment(pair):
    """Find the nearest points of a ball and a capsule."""
    p, h = pair.state.p, pair.b.half[2]
    z = max(-h, min(h, p[2]))
    d, nx, ny, nz = direction(p[0], p[1], p[2] - z, 1.0, 0.0, 0.0)
    gap = d - pair.a.radius - pair.b.radius
    put(pair.found[0], gap, (nx, ny, nz), (p[0], p[1], p[2]), (0.0, 0.0, z), of_vertex_a(0))
    put_parts(pair.found[0], NOBODY, OF_SUPPORT, OF_SUPPORT if abs(z) == h else edge_part(0, 1))


@kernel
def segment_segment(pair):
    """Find the nearest points of two capsules."""
    s = pair.state
    ux, uy, uz = from_a(s, 0.0, 0.0, 1.0)
    c, g, h = s.p, pair.a.half[2], pair.b.half[2]
    for k in range(2):
        t, z = (2 * k - 1) * g, (2 * k - 1) * h
        p, q = s.corner[0, k], s.corner[1, k]
        p[0], p[1], p[2] = c[0] + t * ux, c[1] + t * uy, c[2] + t * uz
        q[0], q[1], q[2] = 0.0, 0.0, z
        s.number[0, k], s.number[1, k] = k, k
    edge_on_edge(pair, (0, 1), (0, 1))


@kernel
def discs_in_one_plane(pair):
    """Find the nearest points of two discs in one plane, as circles; return whether there is one.

    They have no thickness: across their plane they touch wherever they overlap, by no depth. So their way
    apart is in the plane. It is theirs if the axes are parallel and the rims meet at one height.
    """
    s, a, b = pair.state, pair.a.half[0], pair.b.half[0]
    if pair.a.kind != CYLINDER or pair.a.half[2] > 0.0 or pair.b.half[2] > 0.0:
        return False
    if not s.R[0, 2] ** 2 + s.R[1, 2] ** 2 <= LEAST_SINE * LEAST_SINE:
        return False
    d, x, y, _ = direction(s.p[0], s.p[1], 0.0, 1.0, 0.0, 0.0)
    # the point of A towards B: its axis is (R02, R12, R22), so it is higher by a (x R02 + y R12)/R22
    height = s.p[2] + a * (x * s.R[0, 2] + y * s.R[1, 2]) / s.R[2, 2]
    if not abs(height) <= RESOLUTION * min(a, b):
        return False
    on_a, on_b = ((d - a) * x, (d - a) * y, 0.0), (b * x, b * y, 0.0)
    put(pair.found[0], d - a - b, (x, y, 0.0), on_a, on_b, of_vertex_a(LOWEST))
    put_parts(pair.found[0], NOBODY, OF_SUPPORT, OF_SUPPORT)
    return True
