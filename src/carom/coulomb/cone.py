"""Projection on the friction cone in the form of Alart and Curnier."""

from __future__ import annotations

import math

from carom.coulomb.layout import CONE, SLIDING
from carom.jit import kernel


@kernel
def project(kind, mu, h1, h2, x0, x1, x2):
    """Return the point that x = p - rho w is projected on: normal first, the disc with radius mu x_n after.

    A solution is a fixed point: p = project(p - rho w) for one and hence every rho > 0.
    """
    if not x0 > 0.0:
        if kind == CONE or kind == SLIDING:
            return 0.0, 0.0, 0.0
        return 0.0, x1, x2
    if kind == SLIDING:
        return x0, -mu * x0 * h1, -mu * x0 * h2
    if kind == CONE:
        size = math.sqrt(x1 * x1 + x2 * x2)
        if size > mu * x0:
            r = mu * x0 / size
            return x0, r * x1, r * x2
    return x0, x1, x2


@kernel
def slope(kind, mu, h1, h2, x0, x1, x2):
    """Return the derivative of `project` as 3x3 in a tuple, without the zeros of its first row.

    Order: d00, d10, d11, d12, d20, d21, d22.
    """
    if not x0 > 0.0:
        if kind == CONE or kind == SLIDING:
            return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        return 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    if kind == SLIDING:
        return 1.0, -mu * h1, 0.0, 0.0, -mu * h2, 0.0, 0.0
    if kind == CONE:
        size = math.sqrt(x1 * x1 + x2 * x2)
        if size > mu * x0:
            e1, e2 = x1 / size, x2 / size
            r = mu * x0 / size
            return 1.0, mu * e1, r * e2 * e2, -r * e1 * e2, mu * e2, -r * e1 * e2, r * e1 * e1
    return 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
