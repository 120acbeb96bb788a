"""Surfaces of revolution about z."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel


@kernel
def across(x, y):
    """Return the distance from the z axis and the direction away from it, (1, 0) on the axis."""
    r = math.sqrt(x * x + y * y)
    return (r, x / r, y / r) if r > 0.0 else (0.0, 1.0, 0.0)
