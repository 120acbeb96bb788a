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

from carom._compiled.decorators import entry, kernel
from carom.contact.operations import curvatures
from carom.impact.thresholds import EQUAL_CURVATURES


@kernel
def stiffness(system, contact, point, state):
    """Return R^(1/2) F^(-3/2) of a point of a ball or an ellipsoid."""
    a11, a12, a22 = curvatures(system, contact, point, state)
    middle, apart = 0.5 * (a11 + a22), math.hypot(0.5 * (a11 - a22), a12)
    high, low = middle + apart, middle - apart
    if not low > 0.0:  # they fit into each other along a line, which is no point contact
        low = high
    return (high * low) ** -0.25 * ellipse(high / low)


@entry
def root_of_radius(high, low):
    """Return R^(1/2) F^(-3/2) for the relative principal curvatures of a point [1/m], high >= low > 0."""
    return (high * low) ** -0.25 * ellipse(high / low)


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
