"""The point of a core that is farthest in a direction."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision.faces import LOWEST
from carom.collision.farthest import VERTICES, farthest
from carom.collision.frame import point_of_a, to_a
from carom.collision.layout import BOX, CYLINDER, ELLIPSOID, HULL, SEGMENT


@inlined
def _end(x, h):
    return h if x > 0.0 else -h


@kernel
def support(solid, hulls, x, y, z):
    """Return the farthest point along (x, y, z), in the solid's own axes, and the number of the vertex.

    For an ellipsoid, it is the farthest point of a smaller convex body; a ball of radius `inner` enlarges this
    body to the ellipsoid. Smooth points have the number 0, those of a rim the number of its lowest point.
    """
    h, kind = solid.half, solid.kind
    if kind == SEGMENT:
        return 0.0, 0.0, _end(z, h[2]), 1 if z > 0.0 else 0
    if kind == BOX:
        number = 4 * (x > 0.0) + 2 * (y > 0.0) + 1 * (z > 0.0)
        return _end(x, h[0]), _end(y, h[1]), _end(z, h[2]), number
    if kind == HULL:
        _, i = farthest(solid, hulls, VERTICES, x, y, z)
        p = hulls.candidates[i].point
        return p[0], p[1], p[2], hulls.candidates[i].number
    if kind == CYLINDER:
        across = math.sqrt(x * x + y * y)
        f = h[0] / across if across > 0.0 else 0.0
        return f * x, f * y, _end(z, h[2]), LOWEST + (1 if z > 0.0 and h[2] > 0.0 else 0)
    if kind == ELLIPSOID:
        u, v, w = h[0] * x, h[1] * y, h[2] * z
        f = math.sqrt(u * u + v * v + w * w)
        f = 1.0 / f if f > 0.0 else 0.0
        d = math.sqrt(x * x + y * y + z * z)
        e = solid.inner / d if d > 0.0 else 0.0
        return f * h[0] * u - e * x, f * h[1] * v - e * y, f * h[2] * w - e * z, 0
    return 0.0, 0.0, 0.0, 0


@kernel
def change_of_support(solid, n, v):
    """Return H v, the change of the farthest point along a unit vector n that changes by v.

    All are in the solid's own axes. H is the Hessian of the support function, with H n = 0:

        rim, mantle    r/s^3 g g^T,  g = (-n_y, n_x, 0), s = |g|
        ellipsoid      D/s - D n (D n)^T/s^3,  D = diag(a^2, b^2, c^2), s^2 = n.D n
        all else       0: a vertex.
    """
    h, (x, y, z) = solid.half, n
    if solid.kind == CYLINDER:
        across = math.sqrt(x * x + y * y)
        if across > 0.0:
            f = h[0] * (x * v[1] - y * v[0]) / across**3
            return -f * y, f * x, 0.0
    if solid.kind == ELLIPSOID:
        p, q, r = h[0] * h[0], h[1] * h[1], h[2] * h[2]
        square = p * x * x + q * y * y + r * z * z
        f = (p * x * v[0] + q * y * v[1] + r * z * v[2]) / square
        s = square**-0.5
        return p * s * (v[0] - f * x), q * s * (v[1] - f * y), r * s * (v[2] - f * z)
    return 0.0, 0.0, 0.0


@kernel
def propose(pair, x, y, z):
    """Write the point of A - B that is farthest along -(x, y, z), axes of B, as row 4 of the simplex."""
    s = pair.state
    dx, dy, dz = to_a(s, x, y, z)
    ax, ay, az, i = support(pair.a, pair.hulls, -dx, -dy, -dz)
    ax, ay, az = point_of_a(s, ax, ay, az)
    bx, by, bz, j = support(pair.b, pair.hulls, x, y, z)
    w, on_a, on_b = s.w[4], s.on_a[4], s.on_b[4]
    on_a[0], on_a[1], on_a[2] = ax, ay, az
    on_b[0], on_b[1], on_b[2] = bx, by, bz
    w[0], w[1], w[2] = ax - bx, ay - by, az - bz
    s.ids[4, 0], s.ids[4, 1] = i, j


@kernel
def separation(pair, x, y, z):
    """Return the separation of the cores along the unit vector (x, y, z), at most their distance."""
    propose(pair, x, y, z)
    w = pair.state.w[4]
    return w[0] * x + w[1] * y + w[2] * z
