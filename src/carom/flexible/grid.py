"""Shapes of modes as splines between the nodes of a grid: what compiled code reads, and files contain.

Along an axis the splines are cubic, with two coefficients more than nodes (not-a-knot at the ends), or linear
between two nodes: sections of beams move and turn, so that displacements are linear across them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from carom import checks
from carom.fields import keep
from carom.flexible.modes import Modes, places_of
from carom.flexible.thresholds import SHAPE_ERROR
from carom.geometry import quaternion

#: numbers of nodes along an axis that are tried, and how many a grid may have
NODES, MOST_NODES = (2, 4, 8, 16, 32, 64, 128, 256), 20_000
LINES = 12  # through a body, on which errors are measured


@dataclass(frozen=True, eq=False, repr=False)
class GridModes(Modes):
    """Modes whose shapes are splines on a grid.

    Attributes
    ----------
    low, spacing : (3,)
        First node of the grid, and distances of nodes [m].
    count : (3,)
        Numbers of nodes.
    coefficients : (a, b, c, 3, n)
        Of the splines [1/sqrt(kg)]; n + 2 along an axis of n > 2 nodes.
    """

    frequencies: np.ndarray
    damping: np.ndarray
    mass: float
    inertia: np.ndarray | None
    supported: bool
    participation: np.ndarray
    low: np.ndarray
    spacing: np.ndarray
    count: np.ndarray
    coefficients: np.ndarray

    def __post_init__(self):
        count = np.asarray(self.count)
        if count.shape != (3,) or not np.all((count == 2) | (count >= 4)):
            raise ValueError(
                f"count must be three numbers of nodes, 2 or at least 4, got {count!r}"
            )
        size = tuple(int(k if k == 2 else k + 2) for k in count)
        n = len(self.frequencies)
        checks.finite_array("coefficients", self.coefficients, (*size, 3, n))
        for name in ("low", "spacing"):
            checks.finite_array(name, getattr(self, name), (3,), "m")
        Modes(
            self.frequencies, self.damping, self.mass, self.at, inertia=self.inertia,
            supported=self.supported, participation=self.participation,
        )  # fmt: skip

    @property
    def _at(self) -> None:
        return None

    def _shapes(self, points: np.ndarray) -> np.ndarray:
        return self.at(points)

    def at(self, points: np.ndarray) -> np.ndarray:
        """Return the displacements (k, 3, n) at points (k, 3), as compiled code does."""
        places = places_of("points", points)
        out, weights = np.zeros((len(places), *self.coefficients.shape[3:])), []
        for axis in range(3):
            s = (places[:, axis] - self.low[axis]) / self.spacing[axis]
            n = int(self.count[axis])
            if n == 2:
                weights.append((np.zeros(len(s), dtype=int), np.stack([1.0 - s, s], axis=1)))
                continue
            i = np.clip(s, 0.0, n - 2).astype(int)
            f = np.clip(s - i, 0.0, 1.0)
            ends = (1.0 - f) ** 3 / 6.0, f**3 / 6.0
            two = 2.0 / 3.0 - f * f + 0.5 * f**3
            four = np.stack([ends[0], two, 1.0 - ends[0] - ends[1] - two, ends[1]], axis=1)
            weights.append((i, four))
        (i0, wx), (j0, wy), (k0, wz) = weights
        for i in range(wx.shape[1]):
            for j in range(wy.shape[1]):
                for k in range(wz.shape[1]):
                    weight = wx[:, i] * wy[:, j] * wz[:, k]
                    out += weight[:, None, None] * self.coefficients[i0 + i, j0 + j, k0 + k]
        return out


@lru_cache(maxsize=64)
def on_grid(modes: Modes, shape) -> GridModes:
    """Return modes with shapes on a grid over a box around a shape, to `SHAPE_ERROR` of the greatest."""
    if isinstance(modes, GridModes):
        return modes
    low, high = box_of(shape)
    count = [nodes_along(modes, low, high, axis) for axis in range(3)]
    while np.prod(count) > MOST_NODES:
        count[int(np.argmax(count))] //= 2
    lines = [np.linspace(a, b, n) for a, b, n in zip(low, high, count)]
    nodes = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
    values = modes.shapes(nodes).reshape(*count, 3, -1)
    for axis, n in enumerate(count):
        if n > 2:
            values = np.moveaxis(np.tensordot(_coefficients(n), values, axes=(1, axis)), 0, axis)
    made = object.__new__(GridModes)
    spacing = np.array([(b - a) / (n - 1) for a, b, n in zip(low, high, count)])
    keep(
        made, frequencies=modes.frequencies, damping=modes.damping, mass=modes.mass, inertia=modes.inertia,
        supported=modes.supported, participation=modes.participation, low=low, spacing=spacing,
        count=np.array(count), coefficients=np.ascontiguousarray(values),
    )  # fmt: skip
    return made


def nodes_along(modes, low: np.ndarray, high: np.ndarray, axis: int) -> int:
    """Return how many nodes along an axis give displacements to `SHAPE_ERROR` on lines through the body."""
    rng = np.random.default_rng(1)
    starts = low + rng.random((LINES, 3)) * (high - low)
    scale = np.abs(modes.shapes(starts)).max(axis=(0, 1))
    for n in NODES:
        line = np.linspace(0.0, 1.0, 2 * n - 1)  # nodes, and the middles between them
        places = np.repeat(starts, len(line), axis=0)
        places[:, axis] = np.tile(low[axis] + line * (high[axis] - low[axis]), LINES)
        exact = modes.shapes(places).reshape(LINES, len(line), 3, -1)
        scale = np.maximum(scale, np.abs(exact).max(axis=(0, 1, 2)))
        values = exact[:, ::2]
        if n == 2:
            middle = 0.5 * (values[:, :-1] + values[:, 1:])
        else:
            c = np.tensordot(_coefficients(n), values, axes=(1, 1)).transpose(1, 0, 2, 3)
            middle = (c[:, :-3] + 23.0 * (c[:, 1:-2] + c[:, 2:-1]) + c[:, 3:]) / 48.0
        off = np.abs(middle - exact[:, 1::2]).max(axis=(0, 1, 2))
        if np.all(off <= SHAPE_ERROR * np.where(scale > 0.0, scale, 1.0)):
            return n
    return NODES[-1]


def box_of(shape) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of a box, in body axes, that contains a shape."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for piece in shape.pieces:
        if piece.corners is not None:
            points = piece.corners
        else:
            half = np.asarray(piece.half, dtype=float)
            signs = np.array(np.meshgrid(*3 * [(-1.0, 1.0)])).reshape(3, -1).T
            points = piece.position + quaternion.rotate(
                np.broadcast_to(piece.orientation, (8, 4)), signs * half
            )
        low = np.minimum(low, points.min(axis=0) - piece.radius)
        high = np.maximum(high, points.max(axis=0) + piece.radius)
    return low, high


@lru_cache
def _coefficients(n: int) -> np.ndarray:
    """Return the matrix (n + 2, n) from values at nodes to coefficients of cubic B-splines."""
    rows = np.zeros((n + 2, n + 2))
    for i in range(n):
        rows[i, i : i + 3] = 1 / 6, 4 / 6, 1 / 6
    jump = -1.0, 4.0, -6.0, 4.0, -1.0  # of the third derivative at a node
    rows[n, :5], rows[n + 1, -5:] = jump, jump
    return np.linalg.inv(rows)[:, :n]
