"""The polygon in which two opposite faces overlap, seen along a normal.

Method of Sutherland and Hodgman: the polygon of one face (the incident face) is cut by planes through the sides
of the other (the reference face), parallel to the normal of the reference face. Every corner of the result lies
on the incident face; its gap is its height above the reference face. The feature of a corner is a corner of
either face, or a side of each.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision import features as of
from carom.collision.faces import corner_part
from carom.collision.found import keep_new, put, put_parts
from carom.collision.layout import CYLINDER, MOST_CORNERS
from carom.collision.thresholds import CROSSING, TILT
from carom.geometry.thresholds import ROUND_OFF
from carom.geometry.vectors import cross, dot, minus


@inlined
def _vertex(side, i):
    """Return the feature of corner i of the face of A (side 0) or of B (side 1)."""
    return of.of_vertex_a(i) if side == 0 else of.of_vertex_b(i)


@kernel
def _crossing(s, inc, k, ref, j):
    """Return the feature of side k of the incident face and side j of the reference face."""
    a1, a2 = s.number[inc, k], s.number[inc, (k + 1) % s.count[inc]]
    b1, b2 = s.number[ref, j], s.number[ref, (j + 1) % s.count[ref]]
    return of.of_edges(a1, a2, b1, b2) if inc == 0 else of.of_edges(b1, b2, a1, a2)


@kernel
def _cut(s, ref, source, count, j, tolerance):
    """Cut polygon `source` by side j of the reference face; return the new number of corners."""
    inc, target = 1 - ref, 1 - source
    n, p = s.normal[ref], s.corner[ref, j]
    q = s.corner[ref, (j + 1) % s.count[ref]]
    m = cross(n, minus(q, p))
    size = math.sqrt(dot(m, m))
    if not size > 0.0:  # two corners coincide
        size = 1.0
    m = m[0] / size, m[1] / size, m[2] / size
    old, new = s.ring[source], s.ring[target]
    made = 0
    for k in range(count):
        nxt = k + 1 if k + 1 < count else 0
        u, v = old[k], old[nxt]
        f, g = dot(minus(u, p), m), dot(minus(v, p), m)
        inside, goes_on = f >= -tolerance, g >= -tolerance
        if inside and made < 2 * MOST_CORNERS:
            new[made, 0], new[made, 1], new[made, 2] = u[0], u[1], u[2]
            s.label[target, made], s.side[target, made] = s.label[source, k], s.side[source, k]
            made += 1
        if inside != goes_on and made < 2 * MOST_CORNERS:
            t = max(0.0, min(1.0, f / (f - g)))
            for i in range(3):
                new[made, i] = u[i] + t * (v[i] - u[i])
            origin = s.side[source, k]
            if origin >= 0:
                label = _crossing(s, inc, origin, ref, j)
            else:  # this side lies on a side of the reference, which meets side j in a corner
                i = -1 - origin
                label = _vertex(ref, s.number[ref, j if (i + 1) % s.count[ref] == j else i])
            s.label[target, made] = label
            s.side[target, made] = -1 - j if inside else origin
            made += 1
    return made


@kernel
def _parts(pair, label):
    """Return the parts of A and of B on which a corner with this feature lies."""
    s = pair.state
    if label >> 60 == of.EDGES:
        a1, a2, b1, b2 = label >> 45, label >> 30, label >> 15, label
        return of.edge_part(a1 & 0x7FFF, a2 & 0x7FFF), of.edge_part(b1 & 0x7FFF, b2 & 0x7FFF)
    if label >> 60 == of.VERTEX_A:
        return corner_part(pair.a, of.vertex_a(label)), of.face_part(s.face[1])
    return of.face_part(s.face[0]), corner_part(pair.b, of.vertex_b(label))


@kernel
def _normal(pair, ref, source, k, corners, height):
    """Return the normal of a corner of the overlap, outward of the reference, and its owner.

    On level faces a corner moves over the other face, and sides that cross determine it: bodies tip over edges.
    """
    s, owner, kind = pair.state, of.OF_B if ref == 1 else of.OF_A, pair.state.label[source, k] >> 60
    n, m = s.normal[ref], s.normal[1 - ref]
    rims = pair.a.kind == CYLINDER or pair.b.kind == CYLINDER
    one, two = s.side[source, k], s.side[source, (k + corners - 1) % corners]
    i, j = max(one, two), -1 - min(one, two)  # sides of the incident face, of the reference
    angle = math.sqrt(max(0.0, 2.0 + 2.0 * (n[0] * m[0] + n[1] * m[1] + n[2] * m[2])))
    level = angle <= TILT and angle * abs(height) <= ROUND_OFF * min(pair.a.extent, pair.b.extent)
    if level and kind != of.EDGES and (kind == of.VERTEX_A) != (ref == 1):
        return (-m[0], -m[1], -m[2]), 3 - owner
    if level and kind == of.EDGES and min(i, j) >= 0 and not rims:  # sides of a rim are no edges
        a, b = s.corner[1 - ref, i], s.corner[1 - ref, (i + 1) % s.count[1 - ref]]
        c, d = s.corner[ref, j], s.corner[ref, (j + 1) % s.count[ref]]
        x, y, z = cross(minus(b, a), minus(d, c))
        size = math.copysign(math.sqrt(x * x + y * y + z * z), x * n[0] + y * n[1] + z * n[2])
        if abs(size) > CROSSING * pair.a.extent * pair.b.extent:
            return (x / size, y / size, z / size), of.NOBODY
    return (n[0], n[1], n[2]), owner


@kernel
def overlap(pair, ref, least, most, count):
    """Add the corners over the face `ref` (0 of A, 1 of B) with gaps in a range; return the new count."""
    s, found, inc, corners = pair.state, pair.found, 1 - ref, pair.state.count[1 - ref]
    for k in range(corners):
        for i in range(3):
            s.ring[0, k, i] = s.corner[inc, k, i]
        s.label[0, k], s.side[0, k] = _vertex(inc, s.number[inc, k]), k
    n, p, source = s.normal[ref], s.corner[ref, 0], 0
    # Sides that lie on each other to round-off do not cross, which it would say where, and corners are one. No
    # more than that: what slides over a side is located to the tolerance, which may be 1e-12 of a size.
    same = ROUND_OFF * min(pair.a.extent, pair.b.extent)
    for j in range(s.count[ref]):
        corners = _cut(s, ref, source, corners, j, same)
        source = 1 - source
    for k in range(corners):
        x = s.ring[source, k]
        height = dot(minus(x, p), n)
        gap, label = height - (pair.a.radius + pair.b.radius), s.label[source, k]
        if least <= gap <= most and count < len(found):
            m, owner = _normal(pair, ref, source, k, corners, height)
            foot = (x[0] - height * m[0], x[1] - height * m[1], x[2] - height * m[2])
            if ref == 1:
                put(found[count], gap, m, (x[0], x[1], x[2]), foot, label)
            else:
                put(found[count], gap, (-m[0], -m[1], -m[2]), foot, (x[0], x[1], x[2]), label)
            parts = _parts(pair, label)
            put_parts(found[count], owner, parts[0], parts[1])
            count = keep_new(found, count, same, False)
    return count
