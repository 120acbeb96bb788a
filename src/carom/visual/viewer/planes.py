"""Half-spaces as polygons around the motion, with the lines of a grid."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

TOP = 0.15  # height of walls above the motion, as a fraction of the radius of the region
LEVEL = 0.9  # cosine of the slope from which a half-space is a wall
#: half a side of the drawn part of a half-space, as a multiple of the radius of the region
WIDE = 1.5


class Plane(NamedTuple):
    """The part of a half-space that is drawn."""

    corners: np.ndarray  #: (P, 3) world [m], convex
    normal: np.ndarray  #: (3,)
    name: str
    colour: str | None = None


def planes_of(scene, place, position: np.ndarray) -> list[Plane]:
    """Return half-spaces as squares around the motion, cut off at walls that no body passes.

    Walls end a little above the motion. `position` (F, N, 3) are the mass centres.
    """
    points = position.reshape(-1, 3)
    walls = [h for h in scene.half_spaces if np.all((points - h.point) @ h.normal >= 0.0)]
    top = points[np.argmax(points @ place.up)] + TOP * place.radius * place.up
    out = []
    for h in scene.half_spaces:
        middle = place.centre - ((place.centre - h.point) @ h.normal) * h.normal
        across = place.side - (place.side @ h.normal) * h.normal
        if not np.linalg.norm(across) > 0.3:
            across = place.up - (place.up @ h.normal) * h.normal
        a = across / np.linalg.norm(across) * WIDE * place.radius
        b = np.cross(h.normal, a)
        corners = middle + np.array([a + b, b - a, -a - b, a - b])
        for wall in walls:
            if wall is not h:
                corners = _cut(corners, wall.point, wall.normal)
        if abs(h.normal @ place.up) < LEVEL:
            corners = _cut(corners, top, -place.up)
        if len(corners) > 2:
            out.append(Plane(corners, h.normal, h.name, h.color))
    return out


def _cut(corners: np.ndarray, point: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return the part of a convex polygon (P, 3) in front of a plane."""
    gap = (corners - point) @ normal
    kept = []
    for k in range(len(corners)):
        if gap[k - 1] * gap[k] < 0.0:
            part = gap[k - 1] / (gap[k - 1] - gap[k])
            kept.append(corners[k - 1] + part * (corners[k] - corners[k - 1]))
        if gap[k] >= 0.0:
            kept.append(corners[k])
    return np.array(kept).reshape(-1, 3)


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
