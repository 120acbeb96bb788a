"""Newton's method on the separation: it gives the last digits of a normal for curved cores.

With v = a - b of the two farthest points and d = v.n, the separation over the unit sphere has the gradient
T^T v and the Hessian -(d + T^T H T): T spans the directions in which n may turn, H is the sum of the
Hessians of the two support functions. If a farthest point lies on an edge, n stays perpendicular to the edge,
and T excludes its direction. Two edges determine n. A farthest point that is then beyond an end of its edge
belongs to that end, a corner or a rim: a rough search does not tell the two apart near it.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision.faces import LOWEST, vertex
from carom.collision.frame import from_a, point_of_a, to_a
from carom.collision.layout import CYLINDER
from carom.collision.support import change_of_support, propose, separation
from carom.collision.thresholds import LEAST_SINE, POLISH_STEP, SAME_DIRECTION
from carom.geometry.thresholds import LAST_DIGIT, RESOLUTION, ROUND_OFF
from carom.geometry.vectors import cross, dot, minus, plus

POLISH_STEPS = 8


@kernel
def _normalized(x, y, z):
    f = math.sqrt(x * x + y * y + z * z)
    f = 1.0 / f if f > 0.0 else 0.0
    return f * x, f * y, f * z


@kernel
def _cross(a, b):
    return _normalized(*cross(a, b))


@inlined
def _along(s, k):
    """Return the direction of edge k."""
    return s.edge[k, 0], s.edge[k, 1], s.edge[k, 2]


@kernel
def _edge(pair, side, k):
    """Return the direction of the edge of a solid between corners 0 and k of the simplex."""
    s = pair.state
    if (pair.a.kind if side == 0 else pair.b.kind) == CYLINDER:
        return (0.0, 0.0, 1.0) if side == 1 else from_a(s, 0.0, 0.0, 1.0)
    p, q = (s.on_a[0], s.on_a[k]) if side == 0 else (s.on_b[0], s.on_b[k])
    return _normalized(q[0] - p[0], q[1] - p[1], q[2] - p[2])


@kernel
def _parallel(s, count, side, e):
    """Return 1 if e is parallel to a listed edge of its solid, -1 if to one of the other solid, else 0."""
    found = 0
    for i in range(count):
        c = dot(s.edge[i], e)
        if 1.0 - c * c < LEAST_SINE * LEAST_SINE:
            if s.owner[i] != side:
                return -1
            found = 1
    return found


@kernel
def _edges(pair):
    """Write the directions of the edges in the simplex to rows of `edge`, with their owners; return how many.

    The result is -1 for a face, more than two directions, or parallel edges: these do not determine the points.
    """
    s, count = pair.state, 0
    for side in range(2):
        for k in range(1, s.points):
            if s.ids[k, side] == s.ids[0, side]:
                continue
            e = _edge(pair, side, k)
            known = _parallel(s, count, side, e)
            if known < 0 or (known == 0 and count == 2):
                return -1
            if known == 0:
                s.edge[count, 0], s.edge[count, 1], s.edge[count, 2] = e
                s.owner[count] = side
                count += 1
    if count == 2 and s.owner[0] == s.owner[1]:
        return -1
    return count


@kernel
def _bend(solid, n, u, v):
    """Return u^T H v, with the Hessian H of the support function of the core at n, in the solid's axes."""
    return dot(u, change_of_support(solid, n, v)) - solid.inner * dot(u, v)


@kernel
def _curvature(pair, n, u, v):
    """Return u^T H v, with the sum H of the Hessians of both support functions at n, in axes of B."""
    s = pair.state
    back = to_a(s, -n[0], -n[1], -n[2])
    total = _bend(pair.a, back, to_a(s, u[0], u[1], u[2]), to_a(s, v[0], v[1], v[2]))
    return total + _bend(pair.b, n, u, v)


@kernel
def _step(pair, edges, n):
    """Return the normal after one step of Newton's method; zero without a smooth maximum (sharp corners)."""
    nx, ny, nz = n
    s = pair.state
    propose(pair, nx, ny, nz)
    v = s.w[4]
    d = dot(v, n)
    if edges == 1:  # n is perpendicular to the edge, t to both
        t = _cross(_along(s, 0), n)
        k = d + _curvature(pair, n, t, t)
        if not k > 0.0:
            return 0.0, 0.0, 0.0
        return _normalized(*plus(n, dot(t, v) / k, t))
    t = _normalized(0.0, -nz, ny) if abs(nx) < 0.6 else _normalized(nz, 0.0, -nx)
    u = cross(n, t)
    k11 = d + _curvature(pair, n, t, t)
    k12 = _curvature(pair, n, t, u)
    k22 = d + _curvature(pair, n, u, u)
    r1, r2 = dot(t, v), dot(u, v)
    determinant = k11 * k22 - k12 * k12
    if not (determinant > ROUND_OFF * k11 * k22 and k11 > 0.0):
        return 0.0, 0.0, 0.0
    f, g = (k22 * r1 - k12 * r2) / determinant, (k11 * r2 - k12 * r1) / determinant
    return _normalized(*plus(plus(n, f, t), g, u))


@kernel
def _iterate(pair, edges, n):
    """Return the normal to which Newton's method converges; zero if it does not converge."""
    for _ in range(POLISH_STEPS):
        x, y, z = _step(pair, edges, n)
        # The remaining error is about the square of this step, times lengths over radii of curvature.
        if (x - n[0]) ** 2 + (y - n[1]) ** 2 + (z - n[2]) ** 2 < POLISH_STEP:
            return x, y, z
        n = x, y, z
    return 0.0, 0.0, 0.0


@kernel
def polish(pair, nx, ny, nz):
    """Return the greatest separation near n and its direction, and 1 if the points are refined too.

    The two points are then in row 4 of the simplex.
    """
    s, edges = pair.state, _edges(pair)
    best = separation(pair, nx, ny, nz)
    if edges < 0:
        return best, nx, ny, nz, 0
    start = (nx, ny, nz)
    for _ in range(3):
        value, x, y, z = _refine(pair, edges, best, start)
        if not dot((x, y, z), (nx, ny, nz)) > SAME_DIRECTION:  # or there is none
            break
        k, end, sense = _passed_end(pair, edges)
        if k < 0:
            return value, x, y, z, 1
        edges, start = _end_of_edge(s, edges, k, end, sense, (x, y, z))
    return separation(pair, nx, ny, nz), nx, ny, nz, 0


@kernel
def _refine(pair, edges, best, n):
    """Return the greatest separation near n and its direction, zero if there is none, with its points."""
    s, (x, y, z) = pair.state, n
    if edges == 2:
        x, y, z = _cross(_along(s, 0), _along(s, 1))
        if dot((x, y, z), n) < 0.0:
            x, y, z = -x, -y, -z
    elif edges == 1:
        x, y, z = _normalized(*plus(n, -dot(s.edge[0], n), s.edge[0]))
    if edges < 2:
        x, y, z = _iterate(pair, edges, (x, y, z))
    value = separation(pair, x, y, z)
    _keep_vertices(pair, (x, y, z))
    if not value >= best - LAST_DIGIT * min(pair.a.extent, pair.b.extent):
        return best, 0.0, 0.0, 0.0
    _points(s, edges, value, x, y, z)
    return value, x, y, z


@kernel
def _passed_end(pair, edges):
    """Return an edge whose point is beyond an end, the corner of the end and the sense to it; -1 if none is."""
    s = pair.state
    tie = ROUND_OFF * min(pair.a.extent, pair.b.extent)
    for k in range(edges):
        side, e = s.owner[k], s.edge[k]
        p = s.on_a[4] if side == 0 else s.on_b[4]
        i = j = s.ids[0, side]
        for m in range(1, s.points):
            j = s.ids[m, side] if s.ids[m, side] != i else j
        a, b = _corner(pair, side, i), _corner(pair, side, j)
        low, high = dot(a, e), dot(b, e)
        if low > high:
            low, high, i, j = high, low, j, i
        at = dot(p, e)
        if at < low - tie:
            return k, i, -1.0
        if at > high + tie:
            return k, j, 1.0
    return -1, 0, 0.0


@kernel
def _corner(pair, side, number):
    """Return a corner of a solid, or the centre of a rim of a cylinder, in axes of B."""
    s, solid = pair.state, pair.a if side == 0 else pair.b
    if solid.kind == CYLINDER:
        x, y, z = 0.0, 0.0, solid.half[2] if number > LOWEST else -solid.half[2]
    else:
        x, y, z = vertex(solid, pair.hulls, number)
    return point_of_a(s, x, y, z) if side == 0 else (x, y, z)


@kernel
def _end_of_edge(s, edges, k, end, sense, n):
    """Let an end of edge k be the corner of its solid; return the count of other edges, and a normal near n."""
    side, e = s.owner[k], s.edge[k]
    start = plus(n, -sense * RESOLUTION if side == 0 else sense * RESOLUTION, e)
    for m in range(s.points):
        s.ids[m, side] = end
    if k == 0 and edges == 2:
        s.edge[0, 0], s.edge[0, 1], s.edge[0, 2] = _along(s, 1)
        s.owner[0] = s.owner[1]
    return edges - 1, start


@kernel
def _keep_vertices(pair, n):
    """Replace a farthest vertex that is not in the simplex by one that is, if both are as far.

    All ends of an edge, and all corners of a face, are as far if n is perpendicular to it.
    """
    s = pair.state
    tie = ROUND_OFF * min(pair.a.extent, pair.b.extent)
    for side in range(2):
        i, there = s.ids[0, side], False
        for k in range(s.points):
            there = there or s.ids[k, side] == s.ids[4, side]
        if there:
            continue
        p = s.on_a[4] if side == 0 else s.on_b[4]
        other = minus(_corner(pair, side, i), _corner(pair, side, s.ids[4, side]))
        if abs(dot(other, n)) <= tie:
            p[0], p[1], p[2] = plus(p, 1.0, other)
            s.ids[4, side] = i


@kernel
def _points(s, edges, best, nx, ny, nz):
    """Move the farthest points, in row 4, along their edges until they differ by `best` n."""
    p, q = s.on_a[4], s.on_b[4]
    r = plus(minus(p, q), -best, (nx, ny, nz))
    e, g = s.edge[0], s.edge[1]
    f1, f2 = dot(r, e) if edges >= 1 else 0.0, 0.0
    if edges == 2:
        f2, c = dot(r, g), dot(e, g)
        across = 1.0 - c * c
        f1, f2 = (f1 - c * f2) / across, (f2 - c * f1) / across
    for k in range(edges):
        u, f = s.edge[k], f1 if k == 0 else f2
        for i in range(3):
            if s.owner[k] == 0:
                p[i] -= f * u[i]
            else:
                q[i] += f * u[i]
