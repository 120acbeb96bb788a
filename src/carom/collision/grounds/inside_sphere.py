"""The inside of a sphere of radius size[0]."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel


@kernel
def field_at(surface, hulls, p):
    """Return phi, its gradient (3) and its Hessian (6) at a point."""
    x, y, z = p
    r = math.sqrt(x * x + y * y + z * z)
    u, v, w = (x / r, y / r, z / r) if r > 0.0 else (0.0, 0.0, -1.0)
    f = -1.0 / r if r > 0.0 else -math.inf
    H = (
        f * (1.0 - u * u),
        f * (1.0 - v * v),
        f * (1.0 - w * w),
        -f * u * v,
        -f * u * w,
        -f * v * w,
    )
    return surface["size"][0] - r, (-u, -v, -w), H


@kernel
def is_hollow(surface):
    """Return True: it is nowhere convex."""
    return True
