"""Elliptic integrals of the first kind, to round-off: kernels. Arithmetic-geometric mean; Carlson's R_F."""

from __future__ import annotations

import math

from carom._compiled.decorators import entry
from carom.geometry.thresholds import CARLSON_RANGE, HALF_DIGITS


@entry
def quarter_period(kc):
    """Return K of the complementary modulus kc in [0, 1]: pi / 2 agm(1, kc), infinite for kc = 0."""
    if kc == 0.0:
        return math.inf
    a, b = 1.0, kc
    for _ in range(12):  # the number of digits doubles: 1e-150 takes 12
        if abs(a - b) <= HALF_DIGITS * a:
            break
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    return math.pi / (a + b)


@entry
def carlson(x, y, z):
    """Return R_F(x, y, z); at most one argument may be 0.

    R_F is half the integral over t > 0 of ((t + x)(t + y)(t + z))^(-1/2). Duplication makes the differences
    small, then the series to order 7 follows (Carlson, Numer. Algorithms 10, 13, 1995; NIST DLMF 19.36.1).
    """
    for _ in range(600):  # each divides the differences by four; 1e-300 and 1 take 20
        a = (x + y + z) / 3.0
        if not max(abs(a - x), max(abs(a - y), abs(a - z))) > CARLSON_RANGE * a:
            break
        p, q, r = math.sqrt(x), math.sqrt(y), math.sqrt(z)
        s = p * q + q * r + r * p
        x, y, z = 0.25 * (x + s), 0.25 * (y + s), 0.25 * (z + s)
    a = (x + y + z) / 3.0
    X, Y = 1.0 - x / a, 1.0 - y / a
    Z = -X - Y
    e2, e3 = X * Y - Z * Z, X * Y * Z
    series = (
        1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0
        - 5.0 * e2 * e2 * e2 / 208.0 + 3.0 * e3 * e3 / 104.0 + e2 * e2 * e3 / 16.0
    )  # fmt: skip
    return series / math.sqrt(a)
