"""The cores with which bodies touch: groups of pieces and their vertices, once for each body."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import accumulate
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.geometry import quaternion
from carom.geometry.thresholds import ROUND_OFF
from carom.scene.pieces import Piece
from carom.scene.shapes import Shape

ROUND_KINDS = ("point", "ellipsoid")

#: pieces of a body that touch as one hull of vertices, or one curved piece
CORE = [
    ("piece", "i8"),  # the first of them
    ("several", "i8"),  # 1 if the body has other pieces
    ("curved", "i8"),  # 1 if it has no vertices
    ("ball_like", "i8"),  # 1 for a ball or an ellipsoid: point contact, as Hertz's law assumes
    ("radius", "f8"),  # of the ball that enlarges them
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
    """Return each piece as a group of its own, for contacts of bodies with each other."""
    return [[k] for k in range(len(pieces))]


def swollen_alike(pieces: Sequence[Piece]) -> list[list[int]]:
    """Group pieces with vertices by radius and material, then each curved piece alone, for half-spaces."""
    alike: dict[tuple, list[int]] = {}
    for k, piece in enumerate(pieces):
        if piece.corners is not None:
            alike.setdefault((piece.radius, piece.material), []).append(k)
    return [*alike.values(), *([k] for k, piece in enumerate(pieces) if piece.corners is None)]


def new_cores(
    shapes: Sequence[Shape | None], split: Callable[..., list[list[int]]], to_principal: np.ndarray,
    bends: Sequence[bool] | None = None,
) -> Cores:  # fmt: skip
    """Return the cores of the shape of each body; `split` groups the pieces. A shape None has no cores.

    The corners of a body that `bends` are found anew in each state, as points of curved pieces are.
    """
    own = [
        None if shape is None else _cores_of(shape, singly if bent else split, tuple(q), bent)
        for shape, q, bent in zip(shapes, to_principal.tolist(), bends or [False] * len(shapes))
    ]
    counts = [0 if one is None else len(one.group) for one in own]
    first = np.array([0, *accumulate(counts)], dtype=np.int64)
    there = [one for one in own if one is not None]
    if not there:
        return Cores(table(CORE, 0), first, np.zeros((0, 3)))
    group, at = table(CORE, int(first[-1])), 0
    for one in there:
        group[at : at + len(one.group)] = one.group
        at += len(one.group)
    length = group["last"]
    last = length.cumsum()
    group["first"], group["last"] = last - length, last
    return Cores(group, first, np.concatenate([one.vertices for one in there]))


class CoresOfShape(NamedTuple):
    """G groups of the pieces of one shape."""

    group: np.recarray  # (G,) CORE, with the number of vertices as `last`
    vertices: np.ndarray  # (V, 3) principal axes


@lru_cache(maxsize=64)
def arms_of(shape: Shape, to_principal: tuple[float, ...]) -> np.ndarray:
    """Return bounds (3,) of the distance of a point of a shape from each principal axis through its centre."""
    arms = np.zeros(3)
    for piece in shape.pieces:
        if piece.corners is not None:
            box = np.abs(quaternion.rotate_back(np.array(to_principal), piece.corners)).max(axis=0)
        else:
            o = quaternion.rotate_back(np.array(to_principal), piece.position)
            axes = quaternion.rotate(piece.orientation, np.eye(3))  # rows: the axes of the piece
            axes = np.abs(quaternion.rotate_back(np.array(to_principal), axes))
            box = np.abs(o) + (piece.extent if piece.kind == "profile" else piece.half @ axes)
        across = np.sqrt(np.maximum((box * box).sum() - box * box, 0.0)) + piece.radius
        arms = np.maximum(arms, across)
    return np.minimum(arms, shape.size)


@lru_cache(maxsize=64)
def _cores_of(
    shape: Shape, split, to_principal: tuple[float, ...], bends: bool = False
) -> CoresOfShape:
    """Return the groups of one shape; they are cached, because simulations often share shapes."""
    pieces = shape.pieces
    groups = split(pieces)
    rows, points = table(CORE, len(groups)), []
    rows["several"], rows["extent"], rows["reach"] = len(pieces) > 1, shape.size, shape.size
    for k, mine in enumerate(groups):
        corners = _corners([pieces[i] for i in mine], shape.size)
        points.append(quaternion.rotate_back(np.array(to_principal), corners))
        rows["piece"][k], rows["radius"][k] = mine[0], pieces[mine[0]].radius
        rows["curved"][k], rows["last"][k] = pieces[mine[0]].corners is None, len(corners)
        rows["ball_like"][k] = pieces[mine[0]].kind in ROUND_KINDS
        if len(corners):
            rows["reach"][k] = np.max(np.linalg.norm(points[k], axis=1))
    if bends:
        rows["curved"], rows["last"], points = 1, 0, [np.zeros((0, 3))]
    return CoresOfShape(rows, np.concatenate(points))


def _corners(pieces: Sequence[Piece], size: float) -> np.ndarray:
    """Return the vertices (n, 3) of pieces in body axes, equal ones once; a curved piece has none."""
    corners = [piece.corners for piece in pieces]
    points = np.concatenate([np.zeros((0, 3)), *(c for c in corners if c is not None)])
    if len(pieces) > 1:
        places = np.round(points / (ROUND_OFF * size))
        points = points[np.sort(np.unique(places, axis=0, return_index=True)[1])]
    return points
