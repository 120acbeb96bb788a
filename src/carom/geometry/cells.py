"""Which of many points are farthest along a direction: few candidates for each cell of directions.

A direction lies in the cell of the cube map [-1, 1]^3 in which it meets the surface. It is a combination, with
weights that are not negative, of the four corners of its cell. So a point that another one exceeds along all
four is farthest along no direction of the cell, and only the others must be compared. The answer is that of a
comparison of all points, to the last bit.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry.thresholds import ROUND_OFF

FEW_POINTS = 24  # points that are compared without cells
#: weights of the corners of a cell in the directions whose farthest points are compared with the others
SEEN = np.array(
    [(1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1), (1, 1, 1, 1),
     (1, 1, 0, 0), (0, 0, 1, 1), (1, 0, 1, 0), (0, 1, 0, 1)], dtype=float
)  # fmt: skip


class Cells(NamedTuple):
    """The candidates of each cell.

    Cells are counted by their side of the cube (+x, -x, +y, -y, +z, -z), and there by their places along the
    next two axes, the first slowest.
    """

    across: int  # cells along an edge of the cube; 0 for one cell of all points
    starts: np.ndarray  # (c + 1,) of the candidates of each cell
    members: np.ndarray  # (k,) candidates, cell by cell, ascending


def cells_of(points: np.ndarray) -> Cells:
    """Return the cells of directions of points (n,3)."""
    n = len(points)
    if n <= FEW_POINTS:
        return Cells(0, np.array([0, n]), np.arange(n))
    across, cell, member = 1, np.repeat(np.arange(6), n), np.tile(np.arange(n), 6)
    while True:
        kept = _candidates(points, across, cell, member)
        cell, member = cell[kept], member[kept]
        if 6 * across * across >= n:
            starts = np.searchsorted(cell, np.arange(6 * across * across + 1))
            return Cells(across, starts, member)
        side, i, j = np.unravel_index(cell, (6, across, across))
        across *= 2
        parts = [
            np.ravel_multi_index((side, 2 * i + k, 2 * j + m), (6, across, across))
            for k in (0, 1)
            for m in (0, 1)
        ]
        cell, member = np.concatenate(parts), np.tile(member, 4)
        order = np.argsort(cell, kind="stable")
        cell, member = cell[order], member[order]


def _candidates(points, across, cell, member) -> np.ndarray:
    """Return which of the pairs (k,) of a cell and a point, sorted by cells, may be farthest in it."""
    first = np.flatnonzero(np.diff(cell, prepend=-1))
    of = np.cumsum(np.diff(cell, prepend=-1) > 0) - 1
    along = np.einsum("kci,ki->kc", _corners(across)[cell], points[member])
    limit = along + ROUND_OFF * np.max(np.abs(points))
    beaten = np.zeros(len(cell), dtype=bool)
    for weight in SEEN:
        value = along @ weight
        best = np.flatnonzero(value == np.maximum.reduceat(value, first)[of])
        best = best[np.diff(of[best], prepend=-1) > 0]
        beaten |= np.all(along[best][of] > limit, axis=1)
    return ~beaten


def _corners(across: int) -> np.ndarray:
    """Return the directions (6 n n, 4, 3) of the corners of all cells, n along an edge of the cube."""
    side, i, j = np.indices((6, across, across)).reshape(3, -1)
    corners = np.empty((len(side), 4, 3))
    axis, rows = side // 2, np.arange(len(side))
    for c in range(4):
        corners[rows, c, axis] = 1.0 - 2.0 * (side % 2)
        corners[rows, c, (axis + 1) % 3] = 2.0 * (i + c // 2) / across - 1.0
        corners[rows, c, (axis + 2) % 3] = 2.0 * (j + c % 2) / across - 1.0
    return corners
