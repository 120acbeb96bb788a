"""The inside of a cone with its apex at the origin; size is sine and cosine of its half-angle.

Four planes that touch it hold a ball which sits in it, touching it along a ring.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.grounds.axis import across


@kernel
def field_at(surface, hulls, p):
    """Return phi, its gradient (3) and its Hessian (6) at a point."""
    a, b, (r, c, s) = surface["size"][0], surface["size"][1], across(p[0], p[1])
    f = -b / r if r > 0.0 else -math.inf
    H = (f * s * s, f * c * c, 0.0, -f * c * s, 0.0, 0.0)
    return a * p[2] - b * r, (-b * c, -b * s, a), H


@kernel
def planes(surface):
    """Return 4."""
    return 4


@kernel
def plane_at(surface, k, p):
    """Return the height of a point over plane k, and its normal."""
    a, b = surface["size"][0], surface["size"][1]
    c, s = (1.0 - k if k % 2 == 0 else 0.0), (2.0 - k if k % 2 == 1 else 0.0)
    return a * p[2] - b * (c * p[0] + s * p[1]), (-b * c, -b * s, a)


@kernel
def plane_counts(surface, k, p):
    """Return whether plane k is away from the nearest point."""
    nearest = math.floor(math.atan2(p[1], p[0]) * (2.0 / math.pi) + 0.5) % 4
    return k != nearest


@kernel
def is_hollow(surface):
    """Return True: it is nowhere convex."""
    return True
