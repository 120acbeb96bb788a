"""Two segments: their nearest points, and the ends of the line along which parallel segments touch.

A segment joins two corners of the face of A or of B in the workspace of the pair.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.faces import corner_part
from carom.collision.features import (
    NOBODY,
    OF_SUPPORT,
    edge_part,
    of_edges,
    of_vertex_a,
    of_vertex_b,
)
from carom.collision.found import keep_new, put, put_parts
from carom.collision.layout import CYLINDER
from carom.collision.thresholds import LEAST_SINE, LINE_CONTACT, SAME_DIRECTION
from carom.geometry.thresholds import RESOLUTION, ROUND_OFF
from carom.geometry.vectors import cross, dot, minus, plus


@kernel
def _line(s, side, ends):
    """Return first corner, direction and length of a segment; for length 0 the direction is zero."""
    p, q = s.corner[side, ends[0]], s.corner[side, ends[1]]
    x, y, z = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    d = math.sqrt(x * x + y * y + z * z)
    f = 1.0 / d if d > 0.0 else 0.0
    return (p[0], p[1], p[2]), (f * x, f * y, f * z), d


@kernel
def _axis_below(pair, side, p, u):
    """Return the point of the axis below a point of the mantle of a cylinder, and the radius.

    An edge of another solid is its own axis, with the radius 0. `u` is the direction of the axis.
    """
    s, solid = pair.state, pair.a if side == 0 else pair.b
    if solid.kind != CYLINDER:
        return p, 0.0
    c = (s.p[0], s.p[1], s.p[2]) if side == 0 else (0.0, 0.0, 0.0)
    return plus(c, dot(minus(p, c), u), u), solid.half[0]


@kernel
def are_parallel(s, ends_a, ends_b):
    """Return whether two segments, given by their corners, have no common normal."""
    _, u, _ = _line(s, 0, ends_a)
    _, w, _ = _line(s, 1, ends_b)
    n = cross(u, w)
    return dot(n, n) <= LEAST_SINE * LEAST_SINE


@kernel
def nearest(d, u, g, w, h):
    """Return t in [0, g] and z in [0, h] where d + t u and z w are nearest; u, w are unit vectors or zero.

    The squared distance is convex: t starts at the free minimum, then z and t are limited to their intervals
    in turn (Ericson, *Real-Time Collision Detection*, 2005, 5.1.9). Parallel segments have the same distance
    along their whole overlap; the result is one end of it.
    """
    c, n = dot(u, w), cross(u, w)
    across, du, dw = dot(n, n), dot(d, u), dot(d, w)
    if across > LEAST_SINE * LEAST_SINE:
        t = (c * dw - du) / across
    else:
        t = h - dw if c > 0.0 else dw  # here z = dw + c t is at an end
    t = max(0.0, min(g, t))
    z = max(0.0, min(h, dw + c * t))
    t = max(0.0, min(g, c * z - du))
    return t, max(0.0, min(h, dw + c * t))


@kernel
def edge_on_edge(pair, ends_a, ends_b):
    """Write the nearest points of two segments, given by their corners, as the first point."""
    s, (i, j), (k, l) = pair.state, ends_a, ends_b
    p, u, g = _line(s, 0, ends_a)
    q, w, h = _line(s, 1, ends_b)
    t, z = nearest(minus(p, q), u, g, w, h)
    on_a, on_b = plus(p, t, u), plus(q, z, w)
    n = minus(on_a, on_b)
    d = math.sqrt(dot(n, n))
    size = d
    if not d > 0.0:  # they cross: the common normal is used, with either sign
        n = cross(u, w)
        size = math.sqrt(dot(n, n))
    n = (n[0] / size, n[1] / size, n[2] / size) if size > 0.0 else (0.0, 0.0, 1.0)
    feature = of_edges(s.number[0, i], s.number[0, j], s.number[1, k], s.number[1, l])
    if t == 0.0 or t == g:
        feature = of_vertex_a(s.number[0, i] if t == 0.0 else s.number[0, j])
    elif z == 0.0 or z == h:
        feature = of_vertex_b(s.number[1, k] if z == 0.0 else s.number[1, l])
    put(pair.found[0], d - (pair.a.radius + pair.b.radius), n, on_a, on_b, feature)
    part_a = OF_SUPPORT if t == 0.0 or t == g else edge_part(0, 1)
    put_parts(pair.found[0], NOBODY, part_a, OF_SUPPORT if z == 0.0 or z == h else edge_part(0, 1))


@kernel
def ends_of_line(pair, ends_a, ends_b, most, count):
    """Add the ends of each segment that project into the other, with gaps up to `most`.

    These ends carry a contact along a line. Each has its own distance and normal; those of a line of a mantle
    are found from the axis, exactly at any gap. The first point may be an end that is higher by round-off. The
    normal must be near that of the first point: an end that hangs over another edge is no contact. Ends that
    lie on each other are one, so that two equal segments side by side have two ends, whatever round-off says.
    Return the new count.
    """
    s, found = pair.state, pair.found
    p, u, g = _line(s, 0, ends_a)
    q, w, h = _line(s, 1, ends_b)
    p, round_a = _axis_below(pair, 0, p, u)
    q, round_b = _axis_below(pair, 1, q, w)
    radii = pair.a.radius + pair.b.radius + round_a + round_b
    edge_a = edge_part(s.number[0, ends_a[0]], s.number[0, ends_a[1]])
    edge_b = edge_part(s.number[1, ends_b[0]], s.number[1, ends_b[1]])
    d, c = minus(p, q), dot(u, w)
    du, dw = dot(d, u), dot(d, w)
    # at s from where axes cross with the sine e the normal is tilted by s e^2/(sum of the radii): there the end
    # of a line of a mantle, found from its axis, is no point of the cylinder
    if round_a + round_b > 0.0 and (1.0 - c * c) * max(g, h) > LINE_CONTACT * radii:
        return count
    m, flush = found[0].normal, ROUND_OFF * min(pair.a.extent, pair.b.extent)
    first, first_owner = (m[0], m[1], m[2]), found[0].owner
    for end in range(4):
        if end < 2:
            t = g * end
            z = dw + c * t
            i = s.number[0, ends_a[end]]
            inside, feature = -flush <= z <= h + flush, of_vertex_a(i)
            part_a, part_b = corner_part(pair.a, i), edge_b
        else:
            z = h * (end - 2)
            t = c * z - du
            i = s.number[1, ends_b[end - 2]]
            inside, feature = -flush <= t <= g + flush, of_vertex_b(i)
            part_a, part_b = edge_a, corner_part(pair.b, i)
        on_a, on_b = plus(p, t, u), plus(q, z, w)
        n = minus(on_a, on_b)
        size = math.sqrt(dot(n, n))
        gap, owner = size - radii, NOBODY
        if size > RESOLUTION * (g + h):
            n = n[0] / size, n[1] / size, n[2] / size
        else:  # sharp edges that touch: their distance has no direction
            n, owner = first, first_owner
        beside = n[0] * first[0] + n[1] * first[1] + n[2] * first[2] > SAME_DIRECTION
        if not (inside and beside and gap <= most):
            continue
        on_a, on_b = plus(on_a, -round_a, n), plus(on_b, round_b, n)
        put(found[count], gap, n, on_a, on_b, feature)
        put_parts(found[count], owner, part_a, part_b)
        # from its axis the end of a line of a mantle is more exact than by a search
        count = keep_new(found, count, flush, round_a + round_b > 0.0)
    return count
