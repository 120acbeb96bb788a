"""Lines of a grid on a plane."""

from __future__ import annotations

import math

import numpy as np


def round_length(x: float) -> float:
    """Return 1, 2 or 5 times a power of ten, not above `x`."""
    power = 10.0 ** math.floor(math.log10(x))
    return max(m * power for m in (1.0, 2.0, 5.0) if m * power <= x * (1.0 + 1e-12))


def grid_lines(plane, cell: float) -> np.ndarray:
    """Return the lines (L, 2, 3) of a grid of width `cell` [m] inside a convex polygon."""
    first = plane.corners[1] - plane.corners[0]
    along = first / np.linalg.norm(first)
    beside = np.cross(plane.normal, along)
    lines = []
    for a, b in ((along, beside), (beside, along)):
        heights = plane.corners @ b
        low, high = math.ceil(np.min(heights) / cell), math.floor(np.max(heights) / cell)
        for k in range(low, high + 1):
            ends = _crossings(plane.corners, heights - k * cell)
            if len(ends) >= 2:
                far = ends @ a
                lines.append((ends[np.argmin(far)], ends[np.argmax(far)]))
    return np.array(lines).reshape(-1, 2, 3)


def _crossings(corners: np.ndarray, heights: np.ndarray) -> np.ndarray:
    """Return where the sides of a polygon (P, 3) pass the height 0."""
    out = []
    for k in range(len(corners)):
        here, there = heights[k - 1], heights[k]
        if (here < 0.0) != (there < 0.0):
            s = here / (here - there)
            out.append((1.0 - s) * corners[k - 1] + s * corners[k])
    return np.array(out).reshape(-1, 3)
