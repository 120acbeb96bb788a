"""Surfaces phi(x) = 0 that are not convex, in their own axes: value, gradient, Hessian, nearest point.

Free space is where phi > 0. For the closed forms phi is the distance from the surface, as far as the points
from which two places are nearest (the centre of a sphere, an axis). Hessians are (xx, yy, zz, xy, xz, yz).

A surface may have `planes` beside its curved part: free space is beyond all of them. What differs between the
kinds is in the files of `carom.collision.grounds`.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.collision.grounds import by_ground
from carom.collision.thresholds import FOOT_ERROR, FOOT_STEP
from carom.geometry.thresholds import ROUND_OFF
from carom.geometry.vectors import cross, dot, plus

MOST_STEPS_TO_FOOT = 40  # of Newton's method for a nearest point
SHORTEST = 12  # halvings of one of its steps


@by_ground
def field_at(surface, hulls, p):
    """Return phi, its gradient (3) and its Hessian (6) at a point p, all in axes of the surface."""
    return math.nan, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@by_ground
def planes(surface):
    """Return the number of planes beside the curved part."""
    return 0


@by_ground
def plane_at(surface, k, p):
    """Return the height of a point over plane k, and its normal."""
    return math.inf, (0.0, 0.0, 1.0)


@by_ground
def plane_counts(surface, k, p):
    """Return whether plane k says more than the nearest point of the curved part."""
    return True


@by_ground
def is_hollow(surface):
    """Return whether a surface is nowhere convex: all its free space is."""
    return False


@kernel
def times(H, v):
    """Return the product of a symmetric matrix and a vector."""
    return (
        H[0] * v[0] + H[3] * v[1] + H[4] * v[2],
        H[3] * v[0] + H[1] * v[1] + H[5] * v[2],
        H[4] * v[0] + H[5] * v[1] + H[2] * v[2],
    )


@kernel
def beside(n):
    """Return two unit vectors perpendicular to a unit vector n and to each other."""
    e = (0.0, -n[2], n[1]) if abs(n[0]) < 0.6 else (n[2], 0.0, -n[0])
    f = 1.0 / math.sqrt(dot(e, e))
    e = (f * e[0], f * e[1], f * e[2])
    return e, cross(n, e)


@kernel
def shape_operator(surface, hulls, q):
    """Return the normal at a point q of the surface, two tangents e, f, and S = P H P/|grad phi| along them.

    S is e.S e, f.S f, e.S f: a displacement t in the surface changes the normal by S t.
    """
    _, g, H = field_at(surface, hulls, q)
    k = 1.0 / math.sqrt(dot(g, g))
    n = (k * g[0], k * g[1], k * g[2])
    e, f = beside(n)
    He, Hf = times(H, e), times(H, f)
    return n, e, f, (k * dot(e, He), k * dot(f, Hf), k * dot(e, Hf))


@kernel
def solve_symmetric(a, b, c, u, v):
    """Return the solution of [a c; c b] (x, y) = (u, v), and whether the matrix is positive definite."""
    determinant = a * b - c * c
    good = determinant > 0.0 and a > 0.0
    k = 1.0 / determinant if good else 0.0
    return k * (b * u - c * v), k * (a * v - c * u), good


@by_ground
def onto(surface, hulls, p):
    """Return a point of the surface near p: along gradients."""
    size = math.sqrt(dot(p, p))
    for _ in range(MOST_STEPS_TO_FOOT):
        value, g, _ = field_at(surface, hulls, p)
        square = dot(g, g)
        if not square > 0.0:
            break
        p = plus(p, -value / square, g)
        if not abs(value) > FOOT_ERROR * size * math.sqrt(square):
            break
    return p


@kernel
def foot_of(surface, hulls, p):
    """Return the distance of a point p from the curved part, negative inside, and the normal there.

    Where phi is not the distance, Newton's method finds the point q of the surface with p - q along the normal:
    a step t in the surface changes the tangential part of p - q by -(1 + d S) t. From a point beneath p it goes
    to nearer ones only, because far from p there are others. The error after a step is about its square. A step
    t changes the square of the distance by t^2, so that short ones are judged with its round-off.
    """
    phi, g, _ = field_at(surface, hulls, p)
    if surface["size"][3] == 1.0:
        return phi, g
    q, size = onto(surface, hulls, p), math.sqrt(dot(p, p))
    r, n, d = plus(p, -1.0, q), g, 0.0
    blur = ROUND_OFF * size * math.sqrt(dot(r, r))
    for _ in range(MOST_STEPS_TO_FOOT):
        n, e, f, S = shape_operator(surface, hulls, q)
        d, u, v, square = dot(n, r), dot(e, r), dot(f, r), dot(r, r)
        x, y, good = solve_symmetric(1.0 + d * S[0], 1.0 + d * S[1], d * S[2], u, v)
        if not good:
            x, y = u, v
        last = not abs(x) + abs(y) > FOOT_STEP * (size + abs(d))
        nearer, part = False, 1.0
        for _ in range(SHORTEST):
            there = onto(surface, hulls, plus(plus(q, part * x, e), part * y, f))
            offset = plus(p, -1.0, there)
            if last or dot(offset, offset) < square + blur:
                q, r, nearer = there, offset, True
                break
            part *= 0.5
        if last or not nearer:
            break
    return math.copysign(math.sqrt(dot(r, r)), phi), shape_operator(surface, hulls, q)[0]


@kernel
def may_be_nearer(surface, d):
    """Return whether points of the surface may be nearer than a foot at the distance d: beyond a focus."""
    return surface["size"][3] != 1.0 and d < math.inf and surface["size"][0] * d >= 1.0


@kernel
def clearance(surface, hulls, p):
    """Return a lower bound of the distance of a point in free space from the solid."""
    least = field_at(surface, hulls, p)[0] / surface["size"][3]
    for k in range(planes(surface)):
        least = min(least, plane_at(surface, k, p)[0])
    return least


@kernel
def turn_of_normal(at_foot, d, v):
    """Return the change of the normal for a displacement v of a point at a distance d over its foot.

    It is (I + d S)^-1 S v; `at_foot` is from `shape_operator`.
    """
    _, e, f, S = at_foot
    u, w = dot(e, v), dot(f, v)
    u, w = S[0] * u + S[2] * w, S[2] * u + S[1] * w
    x, y, good = solve_symmetric(1.0 + d * S[0], 1.0 + d * S[1], d * S[2], u, w)
    if not good:
        x, y = u, w
    return plus((x * e[0], x * e[1], x * e[2]), y, f)


@kernel
def curvature_at(surface, hulls, p, d, n):
    """Return a bound of the curvatures of the surface at the distance d through p; n is the normal there."""
    exact = surface["size"][3] == 1.0  # phi is the distance: the Hessian at p has them
    _, _, _, S = shape_operator(surface, hulls, p if exact else plus(p, -d, n))
    k = 0.5 * abs(S[0] + S[1]) + math.sqrt(0.25 * (S[0] - S[1]) ** 2 + S[2] * S[2])
    if exact:
        return k
    k = max(
        k, surface["size"][0]
    )  # what it moves towards may be more hollow than what is beneath it
    return k / (1.0 - k * d) if k * d < 1.0 else math.inf


@entry
def values_at(surface, hulls, points, out):
    """Write phi at points (K, 3), in axes of the surface, for pictures."""
    for k in range(points.shape[0]):
        out[k] = field_at(surface, hulls, (points[k, 0], points[k, 1], points[k, 2]))[0]
