"""Contact of a solid (A) with a surface that is not convex (B): the points of its core that are nearest.

Points and vertices are looked at one by one. Where the surface is hollow along an edge, the ends of the edge
are nearest to it; where it is convex, a point between them may be. The nearest point of an ellipsoid is that
whose normal is opposite to the normal of the surface beneath it, found by Newton's method; it must be
more curved than the surface (`SurfaceDefinition.refusal`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import by_reference, kernel
from carom._compiled.units import unit
from carom.collision.faces import vertex
from carom.collision.features import (
    EDGES,
    NOBODY,
    OF_SUPPORT,
    edge_part,
    of_edges,
    of_vertex_a,
    vertex_a,
)
from carom.collision.found import hand_on, put, put_parts, swap
from carom.collision.frame import enter, from_a, point_of_a, to_a
from carom.collision.implicit import (
    beside,
    field_at,
    foot_of,
    is_hollow,
    plane_at,
    plane_counts,
    planes,
    shape_operator,
    turn_of_normal,
)
from carom.collision.layout import BOX, ELLIPSOID, HULL, SEGMENT, Pair
from carom.collision.support import change_of_support
from carom.geometry.thresholds import LAST_DIGIT
from carom.geometry.vectors import dot, plus

MOST_CORRECTIONS_OF_NORMAL = 40  # of Newton's method for the normal of an ellipsoid
EDGE_HALVINGS = 60  # of an edge, for its lowest point
EDGE_PARTS = 8  # of an edge, in which a lowest point is sought where the ends do not show one


@kernel
def corners(solid):
    """Return the number of points of a core that are looked at one by one."""
    if solid.kind == SEGMENT:
        return 2
    if solid.kind == BOX:
        return 8
    return solid.last - solid.first if solid.kind == HULL else 1


@kernel
def corner(solid, hulls, i):
    """Return such a point, in the solid's own axes."""
    if solid.kind == SEGMENT or solid.kind == BOX or solid.kind == HULL:
        return vertex(solid, hulls, i)
    return 0.0, 0.0, 0.0


@kernel
def support_of_ellipsoid(solid, u):
    """Return the point of an ellipsoid that is farthest along a unit vector, in its own axes."""
    h = solid.half
    a, b, c = h[0] * u[0], h[1] * u[1], h[2] * u[2]
    f = 1.0 / math.sqrt(a * a + b * b + c * c)
    return f * h[0] * a, f * h[1] * b, f * h[2] * c


@kernel
def _down(s, n):
    """Return -n, given in axes of B, in axes of A."""
    return to_a(s, -n[0], -n[1], -n[2])


@kernel
def _bend_of_a(pair, n, v):
    """Return H v for the farthest point of A along -n, all in axes of B."""
    s = pair.state
    w = change_of_support(pair.a, _down(s, n), to_a(s, v[0], v[1], v[2]))
    return from_a(s, w[0], w[1], w[2])


@kernel
def lowest_of_ellipsoid(pair, surface):
    """Return the point of an ellipsoid that is nearest to the curved part, its distance and the normal.

    With p(n) the farthest point along -n and N the normal beneath it, N(p(n)) = n. A change t of n moves p by
    -H t, so Newton's step solves (I + S_d H) t = N - n, S_d the change of N with p.
    """
    s, hulls = pair.state, pair.hulls
    d, n = foot_of(surface, hulls, point_of_a(s, 0.0, 0.0, 0.0))
    p = point_of_a(s, 0.0, 0.0, 0.0)
    for _ in range(MOST_CORRECTIONS_OF_NORMAL):
        u = support_of_ellipsoid(pair.a, _down(s, n))
        p = point_of_a(s, u[0], u[1], u[2])
        d, there = foot_of(surface, hulls, p)
        miss = plus(there, -1.0, n)
        at = shape_operator(surface, hulls, plus(p, -d, there))
        e, f = beside(n)
        He = plus(e, 1.0, turn_of_normal(at, d, _bend_of_a(pair, n, e)))
        Hf = plus(f, 1.0, turn_of_normal(at, d, _bend_of_a(pair, n, f)))
        a, b, c, g = dot(e, He), dot(e, Hf), dot(f, He), dot(f, Hf)
        u, v, determinant = dot(e, miss), dot(f, miss), a * g - b * c
        if determinant > 0.0 and a + g > 0.0:
            u, v = (g * u - b * v) / determinant, (a * v - c * u) / determinant
        n = plus(plus(n, u, e), v, f)
        k = 1.0 / math.sqrt(dot(n, n))
        n = (k * n[0], k * n[1], k * n[2])
        if not u * u + v * v > LAST_DIGIT * LAST_DIGIT:
            break
    return p, d, n


@kernel
def _add(pair, lowest, reach, foot, feature, part):
    """Add a point of the core, unless it is too high.

    `lowest` are the number of points so far and their least distance, which are returned anew; `foot` the
    distance, the normal, and the point of the core.
    """
    found, (count, least), (d, n, p) = pair.found, lowest, foot
    if d < least:
        least = d
    if d - pair.a.radius > least - pair.a.radius + reach:  # what is not finite is kept
        return count, least
    if count == len(found):
        count = _kept(pair, count, least, reach)
        if count == len(found):
            return count, least
    put(found[count], d - pair.a.radius, n, p, plus(p, -d, n), feature)
    put_parts(found[count], NOBODY, part, OF_SUPPORT | sheet_of(feature))
    return count + 1, least


@kernel
def sheet_of(feature):
    """Return 1 + the plane of a surface on which a point lies, 0 for its curved part."""
    return feature & 0x7FFF


@kernel
def _kept(pair, count, least, reach):
    """Keep the points that are not too high; return their number."""
    found, kept = pair.found, 0
    for i in range(count):
        if not found[i].gap > least - pair.a.radius + reach:
            if i != kept:
                swap(found, kept, i)
            kept += 1
    return kept


@kernel
def _slope(pair, surface, p, t, share):
    """Return the change of the distance along t at this share of the way."""
    return dot(foot_of(surface, pair.hulls, plus(p, share, t))[1], t)


@kernel
def _valley(pair, surface, p, t):
    """Return the ends of a part of the way t from p in which the distance is least, and the slopes there.

    It is the whole way, or where the surface is hollow at an end a part of it, for a core without
    a radius by gradients of phi, which are along those of the distance near the surface. If none is found a
    slope has the wrong sign.
    """
    falls, rises = _slope(pair, surface, p, t, 0.0), _slope(pair, surface, p, t, 1.0)
    if falls < 0.0 and rises > 0.0:
        return 0.0, 1.0, falls, rises
    before = 0.0
    for k in range(EDGE_PARTS + 1):
        share = k / EDGE_PARTS
        if pair.a.radius > 0.0:
            slope = _slope(pair, surface, p, t, share)
        else:
            slope = dot(field_at(surface, pair.hulls, plus(p, share, t))[1], t)
        if before < 0.0 and slope > 0.0:
            begin = (k - 1) / EDGE_PARTS
            falls = _slope(pair, surface, p, t, begin)
            return begin, share, falls, _slope(pair, surface, p, t, share)
        before = slope
    return 0.0, 1.0, falls, 0.0


@kernel
def _between(pair, surface, p, q):
    """Return the share of the way from p to q at the lowest point of a line, 0 if an end is lowest."""
    t = plus(q, -1.0, p)
    low, high, falls, rises = _valley(pair, surface, p, t)
    if not (falls < 0.0 and rises > 0.0):
        return 0.0
    for k in range(EDGE_HALVINGS):
        share = falls / (falls - rises) if k % 3 < 2 else 0.5  # a halving after two secants
        middle = low + (high - low) * share
        slope = _slope(pair, surface, p, t, middle)
        if slope < 0.0:
            low, falls = middle, slope
        else:
            high, rises = middle, slope
        if slope == 0.0 or not high - low > LAST_DIGIT:
            break
    return low if -falls < rises else high


@kernel
def _on_edge(pair, surface, i, j, lowest, reach):
    """Add the point between two corners that is lower than both, if any; return count and least distance."""
    s, a, hulls = pair.state, pair.a, pair.hulls
    u, v = corner(a, hulls, i), corner(a, hulls, j)
    p, q = point_of_a(s, u[0], u[1], u[2]), point_of_a(s, v[0], v[1], v[2])
    t = plus(q, -1.0, p)
    high = field_at(surface, hulls, p)[0] + field_at(surface, hulls, q)[0]
    # no point between them is lower than (high - length)/2
    most = 2.0 * (lowest[1] + reach) + math.sqrt(dot(t, t))
    if high > surface["size"][3] * most:
        return lowest
    share = _between(pair, surface, p, q)
    if not share > 0.0:
        return lowest
    p = plus(p, share, t)
    d, n = foot_of(surface, hulls, p)
    return _add(pair, lowest, reach, (d, n, p), of_edges(i, j, 0, 0), edge_part(i, j))


@kernel
def _on_edges(pair, surface, lowest, reach):
    """Add the points between the ends of edges; return count and least distance."""
    a, hulls = pair.a, pair.hulls
    if a.kind == SEGMENT:
        return _on_edge(pair, surface, 0, 1, lowest, reach)
    if a.kind == BOX:
        for i in range(8):
            for k in range(3):
                if i & (1 << k) == 0:
                    lowest = _on_edge(pair, surface, i, i | (1 << k), lowest, reach)
    if a.kind == HULL:
        for f in range(a.first_face, a.last_face):
            face = hulls.faces[f]
            for k in range(face.first, face.last):
                i = hulls.corners[k]
                j = hulls.corners[k + 1 if k + 1 < face.last else face.first]
                if i < j:  # the other face of the edge has it the other way round
                    lowest = _on_edge(pair, surface, i, j, lowest, reach)
    return lowest


@kernel
def _on_planes(pair, surface, lowest, reach):
    """Add the points beside planes of a surface; return the count and the least distance."""
    s, a = pair.state, pair.a
    for k in range(planes(surface)):
        for i in range(corners(a)):
            u = corner(a, pair.hulls, i)
            if a.kind == ELLIPSOID:
                _, n = plane_at(surface, k, u)
                u = support_of_ellipsoid(a, _down(s, n))
            p = point_of_a(s, u[0], u[1], u[2])
            d, n = plane_at(surface, k, p)
            if plane_counts(surface, k, p):
                feature = of_vertex_a(i) | (k + 1)
                lowest = _add(pair, lowest, reach, (d, n, p), feature, OF_SUPPORT)
    return lowest


@unit
def on_surface(a, b, hulls, reach, work):
    """Find the points of a solid and a surface: their number goes to ``work.state[0].total``."""
    pair = Pair(a, b, hulls, work.state[0], work.found, work.poses, work.known)
    s, surface = pair.state, hulls.surfaces[b.surface]
    lowest = 0, math.inf
    if a.kind == ELLIPSOID:
        p, d, n = lowest_of_ellipsoid(pair, surface)
        lowest = _add(pair, lowest, reach, (d, n, p), of_vertex_a(0), OF_SUPPORT)
    else:
        for i in range(corners(a)):
            u = corner(a, hulls, i)
            p = point_of_a(s, u[0], u[1], u[2])
            d, n = foot_of(surface, hulls, p)
            lowest = _add(pair, lowest, reach, (d, n, p), of_vertex_a(i), OF_SUPPORT)
    if not is_hollow(surface):
        lowest = _on_edges(pair, surface, lowest, reach)
    lowest = _on_planes(pair, surface, lowest, reach)
    work.state[0].total = _kept(pair, lowest[0], lowest[1], reach)


@unit
def feature_on_surface(a, b, hulls, feature, work, out):
    """Write the point that has a feature, wherever it is, as the first of `out`; arguments as of `touch`.

    Of a list of the lowest points it might be left out.
    """
    enter(work.state[0], a, b)
    pair = by_reference(
        Pair(a.solid, b.solid, hulls, work.state[0], work.found, work.poses, work.known)
    )
    s, surface = pair.state, hulls.surfaces[b.solid.surface]
    sheet, part = sheet_of(feature), OF_SUPPORT
    if feature >> 60 == EDGES:
        i, j = (feature >> 45) & 0x7FFF, (feature >> 30) & 0x7FFF
        u, v = corner(a.solid, hulls, i), corner(a.solid, hulls, j)
        p, q = point_of_a(s, u[0], u[1], u[2]), point_of_a(s, v[0], v[1], v[2])
        share = _between(pair, surface, p, q)
        if share > 0.0:
            p, part = plus(p, share, plus(q, -1.0, p)), edge_part(i, j)
        elif foot_of(surface, hulls, q)[0] < foot_of(surface, hulls, p)[0]:
            p = q
        d, n = foot_of(surface, hulls, p)
    elif a.solid.kind == ELLIPSOID and sheet == 0:
        p, d, n = lowest_of_ellipsoid(pair, surface)
    else:
        u = corner(a.solid, hulls, vertex_a(feature))
        if a.solid.kind == ELLIPSOID:
            _, n = plane_at(surface, sheet - 1, u)
            u = support_of_ellipsoid(a.solid, _down(s, n))
        p = point_of_a(s, u[0], u[1], u[2])
        if sheet == 0:
            d, n = foot_of(surface, hulls, p)
        else:
            d, n = plane_at(surface, sheet - 1, p)
    put(pair.found[0], d - a.solid.radius, n, p, plus(p, -d, n), feature)
    put_parts(pair.found[0], NOBODY, part, OF_SUPPORT | sheet)
    work.state[0].total = hand_on(pair, 1, False, out)
