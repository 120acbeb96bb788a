"""The stiffness of a point contact of a ball or an ellipsoid by Hertz's law, from the curvatures of both sides.

With lambda_1 >= lambda_2 > 0 the relative principal curvatures, the sums of those of both surfaces,

    N = (4/3) E* R^(1/2) F^(-3/2) d^(3/2),     R = (lambda_1 lambda_2)^(-1/2),

where F is 1 for equal curvatures: two balls have R = 1/(1/R1 + 1/R2). Else the contact is an ellipse with the
semi-axes b/a = k, and with complete elliptic integrals K, E of the modulus (1 - k^2)^(1/2) (Johnson, Contact
Mechanics, 1985, eqs. 4.26 to 4.32)

    lambda_1/lambda_2 = (E/k^2 - K)/(K - E),
    F = (2/pi) k^(1/2) K / F_1,     F_1^3 = 4/(pi (1 - k^2)) k^(3/2) ((E/k^2 - K)(K - E))^(1/2).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.implicit import field_at, times
from carom.collision.layout import CURVED_GROUND, CYLINDER, ELLIPSOID, POINT, SEGMENT
from carom.collision.support import change_of_support
from carom.contact.place_of_other import pose_of
from carom.geometry.rotation import rotate_back
from carom.geometry.thresholds import RESOLUTION
from carom.geometry.vectors import dot
from carom.impact.thresholds import EQUAL_CURVATURES
from carom.model.arrays import KIND_VERTICES


@kernel
def stiffness(system, contact, point, state):
    """Return R^(1/2) F^(-3/2) of a point of a ball or an ellipsoid."""
    n, t, s = _vector(point.axes[0]), _vector(point.axes[1]), _vector(point.axes[2])
    if contact.kind == KIND_VERTICES:  # a vertex that a ball enlarges, on a half-space
        a11, a12, a22 = 1.0 / contact.radius, 0.0, 1.0 / contact.radius
    else:
        x, arm = state[point.a].x, point.arm_a
        place = (x[0] + arm[0], x[1] + arm[1], x[2] + arm[2])
        a11, a12, a22 = curvature(system, contact.solid, contact.body, state, (n, t, s, place))
        if contact.surface == 0 and (contact.other >= 0 or contact.static == 1):
            of_other = curvature(
                system, contact.other_solid, contact.other, state, (n, t, s, place)
            )
            a11, a12, a22 = a11 + of_other[0], a12 + of_other[1], a22 + of_other[2]
    middle, apart = 0.5 * (a11 + a22), math.hypot(0.5 * (a11 - a22), a12)
    high, low = middle + apart, middle - apart
    if not low > 0.0:  # they fit into each other along a line, which is no point contact
        low = high
    return (high * low) ** -0.25 * ellipse(high / low)


@kernel
def curvature(system, k, b, state, frame):
    """Return the curvatures (t t, t s, s s) of solid k of body b at a place with the normal n.

    They are above 0 where it is convex. Faces and edges count as flat.
    """
    solid, (n, t, s, place) = system.solids[k], frame
    x, q = pose_of(solid, b, state)
    n, t, s = rotate_back(q, n), rotate_back(q, t), rotate_back(q, s)
    r, half, kind = solid.radius, solid.half, solid.kind
    if kind == CURVED_GROUND:
        surface = system.hulls.surfaces[solid.surface]
        at = (place[0] - x[0], place[1] - x[1], place[2] - x[2])
        _, g, H = field_at(surface, system.hulls, rotate_back(q, at))
        size = math.sqrt(dot(g, g))
        if dot(g, n) < (1.0 - RESOLUTION) * size:  # on one of its planes
            return 0.0, 0.0, 0.0
        Ht, Hs = times(H, t), times(H, s)
        return dot(t, Ht) / size, dot(t, Hs) / size, dot(s, Hs) / size
    if kind == ELLIPSOID:
        Ht, Hs = change_of_support(solid, n, t), change_of_support(solid, n, s)
        a, b_, c = r + dot(t, Ht), dot(t, Hs), r + dot(s, Hs)
        f = 1.0 / (a * c - b_ * b_)
        return f * c, -f * b_, f * a
    if kind in (SEGMENT, CYLINDER) and abs(n[2]) <= RESOLUTION:
        f = 1.0 / (r + (half[0] if kind == CYLINDER else 0.0))
        return f * (1.0 - t[2] * t[2]), -f * t[2] * s[2], f * (1.0 - s[2] * s[2])
    if kind in (POINT, SEGMENT):
        return 1.0 / r, 0.0, 1.0 / r
    return 0.0, 0.0, 0.0


@kernel
def _vector(a):
    return a[0], a[1], a[2]


@kernel
def ellipse(ratio):
    """Return F^(-3/2) for a ratio of curvatures of at least 1; k is found by bisection."""
    if ratio < 1.0 + EQUAL_CURVATURES:
        return 1.0
    low, high, k, K, E = 0.0, 1.0, 0.5, 0.0, 0.0
    for _ in range(60):
        k = 0.5 * (low + high)
        K, E = complete(k)
        if E / (k * k) - K > ratio * (K - E):
            low = k
        else:
            high = k
    cube = 4.0 / (math.pi * (1.0 - k * k)) * k**1.5 * math.sqrt((E / (k * k) - K) * (K - E))
    return math.sqrt(cube) / (2.0 / math.pi * math.sqrt(k) * K) ** 1.5


@kernel
def complete(k):
    """Return the complete elliptic integrals K and E of the complementary modulus k (DLMF 19.8.5, 19.8.6)."""
    a, b, c = 1.0, k, math.sqrt(max(0.0, 1.0 - k * k))
    total, weight = 0.5 * c * c, 1.0
    for _ in range(12):
        a, b, c = 0.5 * (a + b), math.sqrt(a * b), 0.5 * (a - b)
        total, weight = total + weight * c * c, 2.0 * weight
    K = 0.5 * math.pi / a
    return K, K * (1.0 - total)
