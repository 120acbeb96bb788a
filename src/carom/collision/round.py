"""Nearest points of balls and capsules, in closed form: cores that are points and segments.

Each function writes the nearest pair as the first of the points `found`.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision.features import NOBODY, OF_SUPPORT, edge_part, of_vertex_a
from carom.collision.found import put, put_parts
from carom.collision.frame import from_a
from carom.collision.segments import edge_on_edge


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
