"""The inside of a cylinder of radius size[0]; flat ends at -size[1] and size[1] close it if that is above 0."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.grounds.axis import across


@kernel
def field_at(surface, hulls, p):
    """Return phi, its gradient (3) and its Hessian (6) at a point."""
    r, c, s = across(p[0], p[1])
    f = -1.0 / r if r > 0.0 else -math.inf
    H = f * s * s, f * c * c, 0.0, -f * c * s, 0.0, 0.0
    return surface["size"][0] - r, (-c, -s, 0.0), H


@kernel
def planes(surface):
    """Return 2 if it has ends."""
    return 2 if surface["size"][1] > 0.0 else 0


@kernel
def plane_at(surface, k, p):
    """Return the height of a point over an end, and its normal."""
    f = 2.0 * k - 1.0
    return surface["size"][1] - f * p[2], (0.0, 0.0, -f)


@kernel
def is_hollow(surface):
    """Return True: it is nowhere convex."""
    return True
