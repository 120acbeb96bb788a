"""The face of a solid whose normal is nearest to a given direction, as a ring of corners.

Segments and lines of the mantle of a cylinder have two corners; points, ellipsoids and rims of discs have one.
Eight points of the rim, fixed in the body, represent a cap of a cylinder.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision.farthest import NORMALS, farthest
from carom.collision.features import OF_FIXED, OF_SUPPORT
from carom.collision.frame import from_a, point_of_a, to_a
from carom.collision.layout import BOX, CYLINDER, HULL, MOST_CORNERS, SEGMENT

RIM = 8  # points of a rim
# number of the point of a rim that is lowest along a normal; fixed points have smaller ones
LOWEST = 2 * RIM
HALF_ROOT = math.sqrt(0.5)


@inlined
def rim_point(k):
    """Return cosine and sine of k/8 of a turn; the values 0, 1 and -1 are exact."""
    i = k % 8
    c = 1.0 if i == 0 else -1.0 if i == 4 else 0.0 if i == 2 or i == 6 else HALF_ROOT
    z = 1.0 if i == 2 else -1.0 if i == 6 else 0.0 if i == 0 or i == 4 else HALF_ROOT
    return -c if 2 < i < 6 and i != 4 else c, -z if i > 4 and i != 6 else z


@inlined
def corner_part(solid, number):
    """Return the part of a corner of a face."""
    return OF_FIXED if solid.kind == CYLINDER and number < LOWEST else OF_SUPPORT


@kernel
def _corner(s, side, k, number, p):
    """Write corner k of the face of A (side 0) or B (side 1), given in the solid's own axes."""
    x, y, z = p
    if side == 0:
        x, y, z = point_of_a(s, x, y, z)
    row = s.corner[side, k]
    row[0], row[1], row[2] = x, y, z
    s.number[side, k] = number


@kernel
def _vertex(pair, side, k, number):
    """Write a vertex of a solid as corner k."""
    solid = pair.a if side == 0 else pair.b
    _corner(pair.state, side, k, number, vertex(solid, pair.hulls, number))


@kernel
def _box_face(pair, side, x, y, z):
    """Write the face of a box whose normal is nearest to (x, y, z); return the cosine."""
    axis, largest = 2, abs(z)
    if abs(y) > largest:
        axis, largest = 1, abs(y)
    if abs(x) > largest:
        axis, largest = 0, abs(x)
    up = (x if axis == 0 else y if axis == 1 else z) > 0.0
    j, k = (axis + 1) % 3, (axis + 2) % 3
    for n in range(4):  # counter-clockwise about +axis, in reverse order for -axis
        v, w = n == 1 or n == 2, n >= 2
        if not up:
            v, w = w, v
        _vertex(pair, side, n, (4 >> axis) * up + (4 >> j) * v + (4 >> k) * w)
    pair.state.count[side], pair.state.face[side] = 4, 2 * axis + up
    return largest


@kernel
def _hull_face(pair, side, x, y, z):
    """Write the face of a hull whose normal is nearest to (x, y, z); return the cosine."""
    solid, hulls = pair.a if side == 0 else pair.b, pair.hulls
    cosine, chosen = farthest(solid, hulls, NORMALS, x, y, z)
    number = hulls.candidates[chosen].number
    face = hulls.faces[solid.first_face + number]
    total = face.last - face.first
    count = min(total, MOST_CORNERS)
    for k in range(count):
        _vertex(pair, side, k, hulls.corners[face.first + (k * total) // count])
    pair.state.count[side], pair.state.face[side] = count, number
    return cosine


@kernel
def _cylinder_face(pair, side, x, y, z):
    """Write a cap of a cylinder, or a line of its mantle; return the cosine, 0 for the mantle.

    The mantle of a disc has no length: its line is one point.
    """
    s, half, across = pair.state, (pair.a if side == 0 else pair.b).half, math.sqrt(x * x + y * y)
    if abs(z) >= HALF_ROOT or not across > 0.0:
        up = z > 0.0
        for k in range(RIM):
            _vertex(pair, side, k, RIM * up + k)
        s.count[side], s.face[side] = RIM, 1 * up
        return abs(z)
    c, v = half[0] * x / across, half[0] * y / across
    _corner(s, side, 0, LOWEST, (c, v, -half[2]))
    if half[2] > 0.0:
        _corner(s, side, 1, LOWEST + 1, (c, v, half[2]))
        s.count[side] = 2
    return 0.0


@kernel
def load_face(pair, side, x, y, z):
    """Write the face of a solid whose normal is nearest to (x, y, z), in axes of B; return the cosine.

    `side` is 0 for A, 1 for B. The cosine is 0 for an edge or a point instead of a face.
    """
    s, solid, cosine = pair.state, pair.a if side == 0 else pair.b, 0.0
    if side == 0:
        x, y, z = to_a(s, x, y, z)
    s.count[side] = 1
    if solid.kind == BOX:
        cosine = _box_face(pair, side, x, y, z)
    elif solid.kind == HULL:
        cosine = _hull_face(pair, side, x, y, z)
    elif solid.kind == CYLINDER:
        cosine = _cylinder_face(pair, side, x, y, z)
    elif solid.kind == SEGMENT:
        _vertex(pair, side, 0, 0)
        _vertex(pair, side, 1, 1)
        s.count[side] = 2
    if s.count[side] > 2:
        x, y, z = normal_of_face(solid, pair.hulls, s.face[side])
        if side == 0:
            x, y, z = from_a(s, x, y, z)
        s.normal[side, 0], s.normal[side, 1], s.normal[side, 2] = x, y, z
    return cosine


@kernel
def normal_of_face(solid, hulls, face):
    """Return the outward normal of a face of a box, a hull or a cylinder, in the solid's own axes."""
    if solid.kind == HULL:
        n = hulls.faces[solid.first_face + face].normal
        return n[0], n[1], n[2]
    sense = 1.0 if face % 2 == 1 else -1.0
    axis = face // 2 if solid.kind == BOX else 2
    return sense * (axis == 0), sense * (axis == 1), sense * (axis == 2)


@kernel
def vertex(solid, hulls, i):
    """Return an end of a segment, or a corner of a box, a hull or a cap, in the solid's own axes."""
    h = solid.half
    if solid.kind == SEGMENT:
        return 0.0, 0.0, h[2] if i == 1 else -h[2]
    if solid.kind == HULL:
        p = hulls.vertices[solid.first + i]
        return p[0], p[1], p[2]
    if solid.kind == BOX:
        return h[0] if i & 4 else -h[0], h[1] if i & 2 else -h[1], h[2] if i & 1 else -h[2]
    c, z = rim_point(i)
    s = 1.0 if i >= RIM else -1.0
    return h[0] * c, s * h[0] * z, s * h[2]


@kernel
def along_edge(solid, hulls, i, j):
    """Return the unit direction of the edge from vertex i to j, in the solid's own axes."""
    if solid.kind == SEGMENT or (solid.kind == CYLINDER and i >= LOWEST):
        return 0.0, 0.0, 1.0
    p, q = vertex(solid, hulls, i), vertex(solid, hulls, j)
    x, y, z = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    f = 1.0 / math.sqrt(x * x + y * y + z * z)
    return f * x, f * y, f * z
