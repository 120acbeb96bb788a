"""Faces of a convex solid over a profile: points of the curve that lie beside a face.

See `carom.collision.profile`.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision import thresholds as limits
from carom.collision.faces import normal_of_face, vertex
from carom.collision.features import OF_A, face_part
from carom.collision.found import put, put_parts
from carom.collision.frame import from_a, point_of_a, to_a
from carom.collision.layout import BOX, HULL
from carom.collision.profile_curve import (
    ROWS_TOGETHER,
    block_at,
    curve_at,
    is_peak,
    is_straight,
    part_of_place,
    peak_in_row,
    stretch,
)
from carom.geometry.thresholds import ROUND_OFF
from carom.geometry.vectors import dot, minus


@inlined
def faces_of(a):
    """Return the number of faces of a box or a hull; 0 for others."""
    return 6 if a.kind == BOX else a.last_face - a.first_face if a.kind == HULL else 0


@kernel
def height_over(pair, face, q):
    """Return the height of a point over a face of A, in axes of A."""
    a, hulls = pair.a, pair.hulls
    n = normal_of_face(a, hulls, face)
    if a.kind == BOX:
        return dot(n, q) - a.half[face // 2]
    p = hulls.vertices[a.first + hulls.corners[hulls.faces[a.first_face + face].first]]
    return dot(n, minus(q, p))


@kernel
def shallowest_face(pair, q):
    """Return the face of A along the axis over which a point, in axes of A, is highest, and its height."""
    best, chosen = -math.inf, 0
    for k in range(faces_of(pair.a)):
        n = normal_of_face(pair.a, pair.hulls, k)
        height = height_over(pair, k, q)
        if height > best and abs(from_a(pair.state, n[0], n[1], n[2])[2]) < limits.FACING:
            best, chosen = height, k
    return chosen, best


@kernel
def leaves_by(pair, face, row, q, height):
    """Return whether no other face, towards which row k also is farthest, is nearer to a point inside A."""
    room = ROUND_OFF * pair.a.extent
    for k in range(faces_of(pair.a)):
        n = normal_of_face(pair.a, pair.hulls, k)
        x, y, z = from_a(pair.state, n[0], n[1], n[2])
        if k == face or not abs(z) < limits.FACING:
            continue
        other = height_over(pair, k, q)
        if other > height + room:
            also = is_peak(pair.hulls.outlines, row, -x, -y, 0.0, limits.NEARLY_FLAT)
            if also or other > room:
                return False
    return True


@kernel
def crossing(pair, z, count):
    """Add a point of the curve inside A, the deepest of the starts of rows, if there is one: a deep overlap."""
    s, a, b, rows, found = pair.state, pair.a, pair.b, pair.hulls.outlines, pair.found
    deepest, at = -ROUND_OFF * a.extent, -1
    for k in range(b.first, b.last):
        x, y = rows[k].c[0, 0] - s.p[0], rows[k].c[0, 1] - s.p[1]
        if x * x + y * y < a.extent * a.extent:
            height = shallowest_face(pair, to_a(s, x, y, z - s.p[2]))[1]
            if height < deepest:
                deepest, at = height, k
    if at < 0 or count >= len(found):
        return count
    x, y = rows[at].c[0, 0], rows[at].c[0, 1]
    face, gap = shallowest_face(pair, to_a(s, x - s.p[0], y - s.p[1], z - s.p[2]))
    n = normal_of_face(a, pair.hulls, face)
    nx, ny, nz = from_a(s, n[0], n[1], n[2])
    on_a = (x - gap * nx, y - gap * ny, z - gap * nz)
    name = (((1 << 14) | face) << 30) | (1 << 28)
    put(found[count], gap - a.radius, (-nx, -ny, -nz), on_a, (x, y, z), (2 << 60) | name)
    put_parts(found[count], OF_A, face_part(face), part_of_place(b, pair.hulls, at, 0.0))
    return count + 1


@kernel
def on_face(pair, face, z, reach, count):
    """Add the points of the curve farthest towards a face of A, beside it; return the new count.

    A point of the curve beside the face at the height h tells that the gap is at most h.
    """
    s, a, b, rows, found = pair.state, pair.a, pair.b, pair.hulls.outlines, pair.found
    m = normal_of_face(a, pair.hulls, face)
    mx, my, mz = from_a(s, m[0], m[1], m[2])
    across = math.sqrt(mx * mx + my * my)
    if not across > limits.FACING:  # a face across the axis
        return count
    low, high, room = math.inf, -math.inf, ROUND_OFF * b.extent
    for i in range(8 if a.kind == BOX else a.last - a.first):
        p = vertex(a, pair.hulls, i)
        if height_over(pair, face, p) > -ROUND_OFF * a.extent:
            p = point_of_a(s, p[0], p[1], p[2])
            along = (mx * p[1] - my * p[0]) / across
            low, high = min(low, along), max(high, along)
    zero = height_over(pair, face, to_a(s, -s.p[0], -s.p[1], z - s.p[2]))
    most = math.inf
    for k in range(b.first, b.last, ROWS_TOGETHER):
        _, at, _ = block_at(rows, k, b.last)
        x, y = rows[at].c[0, 0], rows[at].c[0, 1]
        height = zero + mx * x + my * y
        if height >= 0.0 and low <= (mx * y - my * x) / across <= high:
            most = min(most, height / across)
    most += reach + room
    for start in range(b.first, b.last, ROWS_TOGETHER):
        end, at, arc = block_at(rows, start, b.last)
        x, y = rows[at].c[0, 0], rows[at].c[0, 1]
        along = (mx * y - my * x) / across
        if zero + mx * x + my * y > most + arc:
            continue
        if not (low - room - arc <= along <= high + room + arc):
            continue
        for k in range(start, end):
            if not is_peak(rows, k, -mx, -my, 0.0, limits.NEARLY_FLAT) or count >= len(found):
                continue
            h = rows[k + 1].start - rows[k].start
            if is_straight(rows[k], h):  # its corners count
                continue
            t = peak_in_row(rows[k], h, -mx, -my, 0.0) if h > 0.0 else 0.0
            x, y, _, _, _, _ = curve_at(rows[k], t)
            along, q = (mx * y - my * x) / across, to_a(s, x - s.p[0], y - s.p[1], z - s.p[2])
            gap = height_over(pair, face, q)
            if not (low - room <= along <= high + room):
                continue
            if gap < -room and not leaves_by(pair, face, k, q, gap):
                continue
            name = (((1 << 14) | face) << 30) | stretch(b, pair.hulls, rows[k].start + t, math.inf)
            on_a = (x - gap * mx, y - gap * my, z - gap * mz)
            put(found[count], gap - a.radius, (-mx, -my, -mz), on_a, (x, y, z), (2 << 60) | name)
            put_parts(found[count], OF_A, face_part(face), part_of_place(b, pair.hulls, k, t))
            count += 1
    return count
