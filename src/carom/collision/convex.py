"""Nearest points of any two convex solids: the distance of the cores, or the depth of their overlap.

The normal n maximizes the separation sigma(n) = min_A a.n - max_B b.n over unit vectors. For cores that are
apart, n is the direction of their distance. If they touch or overlap slightly, A is moved along the best normal
n0 so far until it is clear of B, and the direction of the new distance is the next n. This is the proximal
point method for sigma on the sphere, because a displacement d n0 adds d n.n0 = d - d |n - n0|^2 / 2 to sigma.
Each step raises sigma. The displacement leaves no margin in the result.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.collision import thresholds as limits
from carom.collision.faces import load_face
from carom.collision.features import (
    FACE,
    NOBODY,
    OF_A,
    OF_B,
    OF_SUPPORT,
    edge_part,
    face_part,
    of_edges,
    of_vertex_a,
    of_vertex_b,
)
from carom.collision.found import put, put_parts
from carom.collision.gjk import distance
from carom.collision.layout import CYLINDER
from carom.collision.polish import polish
from carom.collision.simplex import nearest_point
from carom.collision.support import separation
from carom.geometry.thresholds import LAST_DIGIT, RESOLUTION, ROUND_OFF
from carom.geometry.vectors import cross, dot, minus, plus

CLIMBS = 9  # starts of the search for the depth; with more, no sharp hull gave a better result
CLIMBS_CURVED = 3  # the same for curved cores, where each search takes longer
CLIMB_ROUNDS = 30


@unit
def closest(pair):
    """Write the nearest points of two convex solids as the first point.

    An overlap must be less than about half of either core. For a deeper one, the displacement that is found may
    not be the smallest.
    """
    s, a, b = pair.state, pair.a, pair.b
    size = min(a.extent, b.extent)
    curved = a.kind >= CYLINDER or b.kind >= CYLINDER
    accuracy = limits.CURVED_ERROR if curved else LAST_DIGIT
    best, (nx, ny, nz), (bx, by, bz), polished = _normal(pair, size, accuracy)
    # the normal of a face; of two faces, that of the one on which a vertex of the other solid lies
    owner, value, x, y, z = _normal_of_face(pair, (nx, ny, nz), best, curved)
    over = curved and owner != NOBODY
    if curved and not over:
        # parallel edges, or a face with the farthest point of the other solid beyond its sides
        owner, value, x, y, z = _normal_of_face(pair, (nx, ny, nz), best, False)
        if owner != NOBODY or polished == 0:
            best, (nx, ny, nz), (bx, by, bz), polished = _normal(pair, size, LAST_DIGIT)
            owner, value, x, y, z = _normal_of_face(pair, (nx, ny, nz), best, False)
    feature, part_a, part_b = _feature(s), _part(s, 0), _part(s, 1)
    if not curved and (owner != NOBODY or polished == 0):
        bx, by, bz = nearest_point(s, s.on_b)
        over = owner != NOBODY and feature == _farthest_vertex(s, owner)
    if owner != NOBODY:
        best, nx, ny, nz = value, x, y, z
        if curved:  # the points may be anywhere on the face
            feature = 0
        if over:
            bx, by, bz = _foot_on_b(s, owner, best, (nx, ny, nz))
            part_a = part_b = OF_SUPPORT
    owner, part_a, part_b = _owner_by_parts(owner, part_a, part_b)
    # The two points differ by `best` n; any other difference is rounding along a face, and is dropped.
    e = b.inner
    bx, by, bz = bx + e * nx, by + e * ny, bz + e * nz
    core = best - a.inner - b.inner
    on_a = (bx + core * nx, by + core * ny, bz + core * nz)
    gap = core - a.radius - b.radius
    put(pair.found[0], gap, (nx, ny, nz), on_a, (bx, by, bz), feature)
    put_parts(pair.found[0], owner, part_a, part_b)


@kernel
def _normal(pair, size, accuracy):
    """Return separation, normal, point of B by a search and Newton's method; 1 if the latter gave them."""
    best, nx, ny, nz = _search(pair, size, accuracy)
    value, x, y, z, polished = polish(pair, nx, ny, nz)
    if polished == 1:
        b = pair.state.on_b[4]
        return value, (x, y, z), (b[0], b[1], b[2]), 1
    return best, (nx, ny, nz), nearest_point(pair.state, pair.state.on_b), 0


@inlined
def _owner_by_parts(owner, part_a, part_b):
    """Return the owner and the parts, without faces among these: the owner has the face."""
    face_a, face_b = part_a >> 30 == FACE, part_b >> 30 == FACE
    if owner != NOBODY and face_a != face_b:
        owner = OF_A if face_a else OF_B
    return owner, OF_SUPPORT if face_a else part_a, OF_SUPPORT if face_b else part_b


@kernel
def _normal_of_face(pair, n, best, within):
    """Return the owner of the face whose normal is that of the contact, the separation, and the normal.

    The owner is NOBODY if there is none. A face counts if its normal separates the solids as much as n does;
    with `within`, if the foot of the farthest point of the other solid is inside the face: then no other
    direction near n separates them more.
    """
    s, size = pair.state, min(pair.a.extent, pair.b.extent)
    for side in (1, 0):
        f = 1.0 if side == 1 else -1.0
        if load_face(pair, side, f * n[0], f * n[1], f * n[2]) > 1.0 - limits.FACE_NORMAL:
            m = s.normal[side]
            value = separation(pair, f * m[0], f * m[1], f * m[2])
            if _over_face(pair, side) if within else value >= best - ROUND_OFF * size:
                owner = OF_B if side == 1 else OF_A
                return owner, value, f * m[0], f * m[1], f * m[2]
    return NOBODY, best, n[0], n[1], n[2]


@kernel
def _over_face(pair, side):
    """Return whether the farthest point of the other solid, in row 4, has its foot inside the face."""
    s = pair.state
    solid, p, n = pair.a if side == 0 else pair.b, s.corner[side], s.normal[side]
    count, q = s.count[side], s.on_b[4] if side == 0 else s.on_a[4]
    if solid.kind == CYLINDER:
        r = plus(plus(q, -0.5, p[0]), -0.5, p[count // 2])  # opposite corner 0
        return dot(r, r) - dot(r, n) ** 2 <= solid.half[0] * solid.half[0]
    for k in range(count):
        across = cross(minus(p[(k + 1) % count], p[k]), minus(q, p[k]))
        if not dot(n, across) >= 0.0:
            return False
    return True


@inlined
def _farthest_vertex(s, owner):
    """Return the feature of the farthest point, in row 4, of the solid that does not own the normal."""
    return of_vertex_a(s.ids[4, 0]) if owner == OF_B else of_vertex_b(s.ids[4, 1])


@inlined
def _foot_on_b(s, owner, best, n):
    """Return the point of B that belongs to the farthest point of the solid that does not own the normal."""
    p, f = (s.on_a[4], best) if owner == OF_B else (s.on_b[4], 0.0)
    return plus(p, -f, n)


@kernel
def _search(pair, size, accuracy):
    """Return separation and normal of the cores; the last simplex stays, perhaps one of a displaced A."""
    s, clear = pair.state, limits.CLEARANCE * size
    x, y, z = s.p[0], s.p[1], s.p[2]
    if x * x + y * y + z * z == 0.0:
        z = 1.0
    d, nx, ny, nz = distance(pair, accuracy, x, y, z)
    if d > clear:
        return d, nx / d, ny / d, nz / d
    if d > RESOLUTION * size:
        best, nx, ny, nz = _climb(pair, accuracy, clear, nx / d, ny / d, nz / d)
    else:
        best, nx, ny, nz = _way_out(pair, accuracy, clear)
    s.shift[0], s.shift[1], s.shift[2] = 0.0, 0.0, 0.0
    return best, nx, ny, nz


@kernel
def _candidate(s, k):
    """Return candidate k, of any length, for the direction that separates two overlapping cores.

    The candidates are the line of centres, the normals of the simplex and of the sides of a triangle, and the
    axes of both solids.
    """
    i = k % 3
    if k == 0:
        return s.p[0], s.p[1], s.p[2]
    if k < 9 and s.points < 3:
        return 0.0, 0.0, 0.0
    if k < 9:
        j = (k - 1) >> 1  # the corner that is not on this face, or the first one of this side
        i = j if s.points == 4 else 3
        o, u, v = s.w[0 if i > 0 else 1], s.w[1 if i > 1 else 2], s.w[2 if i > 2 else 3]
        n = cross(minus(u, o), minus(v, o))
        if s.points == 3 and j < 3:  # solids of the same thickness: the plane is their middle
            n = cross(n, minus(s.w[(j + 1) % 3], s.w[j]))
        f = -1.0 if k & 1 else 1.0
        return f * n[0], f * n[1], f * n[2]
    if k < 12:
        x, y, z = 1.0 * (i == 0), 1.0 * (i == 1), 1.0 * (i == 2)
    else:
        x, y, z = s.R[0, i], s.R[1, i], s.R[2, i]
    if x * s.p[0] + y * s.p[1] + z * s.p[2] < 0.0:
        x, y, z = -x, -y, -z
    return x, y, z


@kernel
def _way_out(pair, accuracy, clear):
    """Return the greatest separation and its direction; climbs start from the best of 15 candidates."""
    s = pair.state
    start = s.start
    for k in range(15):
        x, y, z = _candidate(s, k)
        size = math.sqrt(x * x + y * y + z * z)
        start[k, 3] = -math.inf
        if size > 0.0:
            start[k, 0], start[k, 1], start[k, 2] = x / size, y / size, z / size
            start[k, 3] = separation(pair, x / size, y / size, z / size)
    best, nx, ny, nz = -math.inf, 0.0, 0.0, 1.0
    curved = pair.a.kind >= CYLINDER or pair.b.kind >= CYLINDER
    for _ in range(CLIMBS_CURVED if curved else CLIMBS):
        chosen = 0
        for k in range(1, 15):
            if start[k, 3] > start[chosen, 3]:
                chosen = k
        if start[chosen, 3] == -math.inf:
            break
        first = start[chosen, 0], start[chosen, 1], start[chosen, 2]
        value, x, y, z = _climb(pair, accuracy, clear, first[0], first[1], first[2])
        if value > best:
            best, nx, ny, nz = value, x, y, z
        if best > -limits.LEAST_CLEARANCE * clear:
            break
        for k in range(15):
            if max(dot(first, start[k]), dot((x, y, z), start[k])) > limits.SAME_CLIMB:
                start[k, 3] = -math.inf
    # The best climb is repeated, so that the simplex is that of the result.
    return _climb(pair, accuracy, clear, nx, ny, nz)


@kernel
def _climb(pair, accuracy, clear, nx, ny, nz):
    """Return the greatest separation near a direction, and its direction; the last simplex stays.

    A step turns the normal by about the depth over the clearance. So for a small depth, the second of three
    phases uses a smaller clearance.
    """
    s = pair.state
    s.shift[0], s.shift[1], s.shift[2] = 0.0, 0.0, 0.0
    best = separation(pair, nx, ny, nz)
    for phase in range(3):
        near = -limits.DEPTH_CLEARANCE * best
        if phase > 0 and not limits.LEAST_CLEARANCE * clear < near < clear:
            continue
        gap = near if phase == 1 else clear
        for _ in range(CLIMB_ROUNDS):
            move = gap - best
            s.shift[0], s.shift[1], s.shift[2] = move * nx, move * ny, move * nz
            d, x, y, z = distance(pair, accuracy, nx, ny, nz)
            if not d > 0.0:
                break
            x, y, z = x / d, y / d, z / d
            # `separation` is that of the displaced A: the part of the displacement is subtracted.
            value = separation(pair, x, y, z) - move * (nx * x + ny * y + nz * z)
            if not value > best:
                break
            last, best = best, value
            nx, ny, nz = x, y, z
            if not best - last > 10.0 * accuracy * clear:
                break
    return best, nx, ny, nz


@kernel
def _feature(s):
    """Return the feature of the nearest points, from the number of vertices of A and of B in the simplex."""
    ids = s.ids
    a2, b2, more_a, more_b = ids[0, 0], ids[0, 1], False, False
    for k in range(1, s.points):
        i, j = ids[k, 0], ids[k, 1]
        if i != ids[0, 0]:
            more_a = more_a or a2 not in (ids[0, 0], i)
            a2 = i
        if j != ids[0, 1]:
            more_b = more_b or b2 not in (ids[0, 1], j)
            b2 = j
    if a2 == ids[0, 0] and not more_a:
        return of_vertex_a(a2)
    if b2 == ids[0, 1] and not more_b:
        return of_vertex_b(b2)
    if not more_a and not more_b:
        return of_edges(ids[0, 0], a2, ids[0, 1], b2)
    return 0


@kernel
def _part(s, side):
    """Return the part of a core on which its nearest point lies, from its vertices in the simplex."""
    i = j = s.ids[0, side]
    for k in range(1, s.points):
        if s.ids[k, side] != i:
            if j not in (i, s.ids[k, side]):
                return face_part(0)
            j = s.ids[k, side]
    return edge_part(i, j) if j != i else OF_SUPPORT
