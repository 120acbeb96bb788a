"""What bodies touch with, by number: groups of pieces and their vertices, once for each body."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.scene.pieces import Piece
from carom.scene.shapes import Shape
from carom.system.arrays import table

#: pieces of a body that touch as one hull of vertices, or one curved piece
CORE = [
    ("piece", "i8"),  # the first of them
    ("several", "i8"),  # 1 where the body has other pieces
    ("curved", "i8"),  # 1 where it has no vertices
    ("radius", "f8"),  # of the ball that swells them
    ("extent", "f8"),  # of the whole shape
    ("reach", "f8"),  # largest distance of a core point from the mass centre
    ("first", "i8"),  # range of the vertices
    ("last", "i8"),
]


class Cores(NamedTuple):
    """G groups of pieces of N bodies, body by body, with V vertices."""

    group: np.recarray  # (G,) CORE
    first: np.ndarray  # (N + 1,) range of the groups of each body
    vertices: np.ndarray  # (V, 3) principal axes of their bodies


def singly(pieces: Sequence[Piece]) -> list[list[int]]:
    """Return the numbers of pieces, each for itself: as bodies touch each other."""
    return [[k] for k in range(len(pieces))]


def swollen_alike(pieces: Sequence[Piece]) -> list[list[int]]:
    """Return those with vertices by radius, then each curved one: as bodies touch a half-space."""
    alike: dict[float, list[int]] = {}
    for k, piece in enumerate(pieces):
        if piece.corners is not None:
            alike.setdefault(piece.radius, []).append(k)
    return [*alike.values(), *([k] for k, piece in enumerate(pieces) if piece.corners is None)]


def new_cores(
    shapes: Sequence[Shape | None], split: Callable[..., list[list[int]]], to_principal: np.ndarray
) -> Cores:
    """Return the cores of the shape of each body, None to leave one out; `split` groups the pieces."""
    known = {shape: _groups(shape, split) for shape in dict.fromkeys(shapes) if shape is not None}
    own = [([], []) if shape is None else known[shape] for shape in shapes]
    first = np.cumsum([0, *(len(leads) for leads, _ in own)])
    points = [corners for _, groups in own for corners in groups]
    lengths = np.array([len(corners) for corners in points], dtype=np.int64)
    body = np.repeat(np.repeat(np.arange(len(shapes)), np.diff(first)), lengths)
    q = to_principal[body]
    vertices = quaternion.rotate_back(q, np.concatenate([np.zeros((0, 3)), *points]))
    group = np.concatenate([table(CORE, 0), *(leads for leads, _ in own if len(leads))])
    group = group.view(np.recarray)
    group.last = np.cumsum(lengths)
    group.first = group.last - lengths
    distance = np.linalg.norm(vertices, axis=1)
    for row in group:
        if row.first < row.last:
            row.reach = np.max(distance[row.first : row.last])
    return Cores(group, first, vertices)


def _groups(shape: Shape, split) -> tuple[np.recarray, list[np.ndarray]]:
    """Return the groups of one shape, and the vertices of each in body axes."""
    pieces = shape.pieces
    groups = split(pieces)
    rows = table(CORE, len(groups))
    rows.several, rows.extent, rows.reach = len(pieces) > 1, shape.size, shape.size
    for row, mine in zip(rows, groups):
        row.piece, row.radius = mine[0], pieces[mine[0]].radius
        row.curved = pieces[mine[0]].corners is None
    return rows, [_corners([pieces[k] for k in mine], shape.size) for mine in groups]


def _corners(pieces: Sequence[Piece], size: float) -> np.ndarray:
    """Return the vertices (n, 3) of some pieces in body axes, each place once; none of a curved one."""
    corners = [piece.corners for piece in pieces]
    points = np.concatenate([np.zeros((0, 3)), *(c for c in corners if c is not None)])
    if len(pieces) > 1:
        places = np.round(points / (1e-12 * size))
        points = points[np.sort(np.unique(places, axis=0, return_index=True)[1])]
    return points
