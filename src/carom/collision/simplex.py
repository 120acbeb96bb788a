"""The point of a simplex that is nearest to the origin, as weights of its corners.

Each face is tried, and the nearest point is taken; no region is selected by signs. So even for a simplex that
is almost flat, the point is no worse than that of the best face.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.vectors import cross, dot, minus, plus


@kernel
def on_edge(a, b):
    """Return the weight of b in the nearest point of the segment a b, and the square of its distance."""
    e = minus(b, a)
    e2 = dot(e, e)
    t = max(0.0, min(1.0, -dot(a, e) / e2 if e2 > 0.0 else 0.0))
    p = plus(a, t, e)
    return t, dot(p, p)


@kernel
def on_triangle(a, b, c):
    """Return the weights of a, b, c in the nearest point of the triangle, and the square of its distance."""
    t, best = on_edge(a, b)
    wa, wb, wc = 1.0 - t, t, 0.0
    t, d2 = on_edge(b, c)
    if d2 < best:
        best, wa, wb, wc = d2, 0.0, 1.0 - t, t
    t, d2 = on_edge(c, a)
    if d2 < best:
        best, wa, wb, wc = d2, t, 0.0, 1.0 - t
    n = cross(minus(b, a), minus(c, a))
    n2 = dot(n, n)
    if n2 > 0.0:
        # Areas of the triangles between the sides and the projection of the origin: n.(x cross y) / n^2.
        h = dot(a, n) / n2
        pa, pb, pc = plus(a, -h, n), plus(b, -h, n), plus(c, -h, n)
        fa, fb = dot(n, cross(pb, pc)) / n2, dot(n, cross(pc, pa)) / n2
        fc = 1.0 - fa - fb
        if fa > 0.0 and fb > 0.0 and fc > 0.0:
            d2 = h * h * n2
            if d2 <= best:
                return fa, fb, fc, d2
    return wa, wb, wc, best


@kernel
def _holds_origin(a, b, c, d):
    """Return True if the origin lies in the tetrahedron: on the inner side of all four faces."""
    for k in range(4):
        p, q, r, o = (
            (a, b, c, d) if k == 0 else (a, c, d, b) if k == 1 else (a, d, b, c) if k == 2 else (b, d, c, a)
        )  # fmt: skip
        n = cross(minus(q, p), minus(r, p))
        if not dot(n, minus(o, p)) * dot(n, p) < 0.0:
            return False
    return True


@kernel
def reduce_simplex(s):
    """Drop the corners that the nearest point does not need; return the square of its distance."""
    w, points = s.w, s.points
    wa, wb, wc, wd, best = 1.0, 0.0, 0.0, 0.0, 0.0
    if points == 1:
        best = dot(w[0], w[0])
    elif points == 2:
        wb, best = on_edge(w[0], w[1])
        wa = 1.0 - wb
    elif points == 3:
        wa, wb, wc, best = on_triangle(w[0], w[1], w[2])
    elif _holds_origin(w[0], w[1], w[2], w[3]):
        return 0.0
    else:
        wa, wb, wd, best = on_triangle(w[0], w[1], w[3])
        t1, t2, t3, d2 = on_triangle(w[0], w[2], w[3])
        if d2 < best:
            wa, wb, wc, wd, best = t1, 0.0, t2, t3, d2
        t1, t2, t3, d2 = on_triangle(w[1], w[2], w[3])
        if d2 < best:
            wa, wb, wc, wd, best = 0.0, t1, t2, t3, d2
        t1, t2, t3, d2 = on_triangle(w[0], w[1], w[2])
        if d2 < best:
            wa, wb, wc, wd, best = t1, t2, t3, 0.0, d2
    kept = 0
    for k in range(points):
        weight = wa if k == 0 else wb if k == 1 else wc if k == 2 else wd
        if weight > 0.0:
            move_corner(s, k, kept)
            s.weight[kept] = weight
            kept += 1
    s.points = kept
    return best


@kernel
def move_corner(s, source, target):
    """Copy a corner of the simplex to another row."""
    if source != target:
        for i in range(3):
            s.w[target, i] = s.w[source, i]
            s.on_a[target, i] = s.on_a[source, i]
            s.on_b[target, i] = s.on_b[source, i]
        s.ids[target, 0], s.ids[target, 1] = s.ids[source, 0], s.ids[source, 1]


@kernel
def nearest_point(s, rows):
    """Return the point nearest to the origin, from the weights of the corners; `rows` has these: w or on_b."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(s.points):
        f, p = s.weight[k], rows[k]
        x, y, z = x + f * p[0], y + f * p[1], z + f * p[2]
    return x, y, z


@kernel
def size_of(s):
    """Return the greatest distance of a corner from the origin."""
    most = 0.0
    for k in range(s.points):
        most = max(most, dot(s.w[k], s.w[k]))
    return math.sqrt(most)
