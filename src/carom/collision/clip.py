"""The polygon in which two opposite faces overlap, seen along a normal.

Method of Sutherland and Hodgman: the polygon of one face (the incident face) is cut by planes through the sides
of the other (the reference face), parallel to the normal of the reference face. Every corner of the result lies
on the incident face; its gap is its height above the reference face. The feature of a corner is a corner of
either face, or a side of each.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision.faces import corner_part
from carom.collision.features import (
    EDGES,
    OF_A,
    OF_B,
    VERTEX_A,
    edge_part,
    face_part,
    of_edges,
    of_vertex_a,
    of_vertex_b,
    vertex_a,
    vertex_b,
)
from carom.collision.found import known, put, put_parts
from carom.collision.layout import MOST_CORNERS

ROUNDING = 1e-12  # tolerance relative to the size of the reference face: a corner on a side is kept


@inlined
def _vertex(side, i):
    """Return the feature of corner i of the face of A (side 0) or of B (side 1)."""
    return of_vertex_a(i) if side == 0 else of_vertex_b(i)


@kernel
def _crossing(s, inc, k, ref, j):
    """Return the feature of side k of the incident face and side j of the reference face."""
    a1, a2 = s.number[inc, k], s.number[inc, (k + 1) % s.count[inc]]
    b1, b2 = s.number[ref, j], s.number[ref, (j + 1) % s.count[ref]]
    return of_edges(a1, a2, b1, b2) if inc == 0 else of_edges(b1, b2, a1, a2)


@kernel
def _cut(s, ref, source, count, j, tolerance):
    """Cut polygon `source` by side j of the reference face; return the new number of corners."""
    inc, target = 1 - ref, 1 - source
    n, p = s.normal[ref], s.corner[ref, j]
    q = s.corner[ref, (j + 1) % s.count[ref]]
    ex, ey, ez = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    mx, my, mz = n[1] * ez - n[2] * ey, n[2] * ex - n[0] * ez, n[0] * ey - n[1] * ex
    size = math.sqrt(mx * mx + my * my + mz * mz)
    if not size > 0.0:  # two corners coincide
        size = 1.0
    mx, my, mz = mx / size, my / size, mz / size
    old, new = s.ring[source], s.ring[target]
    made = 0
    for k in range(count):
        nxt = k + 1 if k + 1 < count else 0
        u, v = old[k], old[nxt]
        f = (u[0] - p[0]) * mx + (u[1] - p[1]) * my + (u[2] - p[2]) * mz
        g = (v[0] - p[0]) * mx + (v[1] - p[1]) * my + (v[2] - p[2]) * mz
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
    if label >> 60 == EDGES:
        return edge_part((label >> 45) & 0x7FFF, (label >> 30) & 0x7FFF), edge_part(
            (label >> 15) & 0x7FFF, label & 0x7FFF
        )
    if label >> 60 == VERTEX_A:
        return corner_part(pair.a, vertex_a(label)), face_part(s.face[1])
    return face_part(s.face[0]), corner_part(pair.b, vertex_b(label))


@kernel
def overlap(pair, ref, least, most, count):
    """Add the corners of the overlap with gaps from `least` to `most`; return the new count.

    `ref` is 0 if the face of A is the reference, 1 if that of B is.
    """
    s, found, inc = pair.state, pair.found, 1 - ref
    corners = s.count[inc]
    scale = 0.0
    for k in range(corners):
        for i in range(3):
            s.ring[0, k, i] = s.corner[inc, k, i]
        s.label[0, k], s.side[0, k] = _vertex(inc, s.number[inc, k]), k
    p = s.corner[ref, 0]
    for k in range(s.count[ref]):
        q = s.corner[ref, k]
        scale = max(scale, abs(q[0] - p[0]) + abs(q[1] - p[1]) + abs(q[2] - p[2]))
    source = 0
    for j in range(s.count[ref]):
        corners = _cut(s, ref, source, corners, j, ROUNDING * scale)
        source = 1 - source
    n = s.normal[ref]
    for k in range(corners):
        x = s.ring[source, k]
        height = (x[0] - p[0]) * n[0] + (x[1] - p[1]) * n[1] + (x[2] - p[2]) * n[2]
        gap, label = height - (pair.a.radius + pair.b.radius), s.label[source, k]
        if least <= gap <= most and count < len(found) and not known(found, count, label):
            foot = (x[0] - height * n[0], x[1] - height * n[1], x[2] - height * n[2])
            corner = (x[0], x[1], x[2])
            if ref == 1:
                put(found[count], gap, (n[0], n[1], n[2]), corner, foot, label)
            else:
                put(found[count], gap, (-n[0], -n[1], -n[2]), foot, corner, label)
            part_a, part_b = _parts(pair, label)
            put_parts(found[count], OF_B if ref == 1 else OF_A, part_a, part_b)
            count += 1
    return count
