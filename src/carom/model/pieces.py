"""Pieces of polynomials: of prescribed motions, curves of springs, and coefficients that depend on a speed."""

from __future__ import annotations

import math

import numpy as np

from carom._compiled.record_arrays import Columns, table
from carom.model.thresholds import LAW_KINK
from carom.scene.speed_law import SpeedLaw, curve_of

#: a piece of a polynomial in (t - start)
PIECE = [
    ("start", "f8"),
    ("end", "f8"),
    ("c", "f8", 6),  # constant term first
    # of a law: nearest places at or below its start, and at or above its end, where a derivative jumps
    ("kinks", "f8", 2),
]
DEGREE = 5


def note_kinks(pieces: np.ndarray) -> None:
    """Write to the pieces of a law the places where a derivative jumps, the ends of a table among them.

    Beyond its pieces a law is constant. Jumps are those of the coefficients of both sides, by the least width.
    """
    width, c = pieces["end"] - pieces["start"], pieces["c"]
    after = np.vstack([c, np.zeros(DEGREE + 1)])
    before = np.zeros_like(after)
    for k in range(1, DEGREE + 1):
        for j in range(k, DEGREE + 1):
            before[1:, k] += math.comb(j, k) * c[:, j] * width ** (j - k)
    least = np.minimum(np.append(width, np.inf), np.insert(width, 0, np.inf))
    k = np.arange(1, DEGREE - 1)  # quintics have jumps above: two derivatives at each end are given
    jumps = np.max(np.abs(after - before)[:, k] * least[:, None] ** k, axis=1)
    places = np.append(pieces["start"], pieces["end"][-1])
    kinks = jumps > LAW_KINK * np.max(np.abs(c[:, 0]))
    pieces["kinks"][:, 0] = np.maximum.accumulate(np.where(kinks, places, -np.inf))[:-1]
    pieces["kinks"][:, 1] = np.minimum.accumulate(np.where(kinks, places, np.inf)[::-1])[::-1][1:]


class Pieces:
    """Pieces of all polynomials of a scene."""

    def __init__(self):
        self.rows = table(PIECE, 0)
        self.known: dict[tuple, tuple[int, int, float]] = {}  # laws of a speed

    def add(self, curve) -> tuple[int, int]:
        """Add a `scipy.interpolate.PPoly`; return the range of its pieces."""
        c, x = np.asarray(curve.c, dtype=float), np.asarray(curve.x, dtype=float)
        if c.ndim != 2 or len(c) > DEGREE + 1:
            raise ValueError(
                f"a polynomial in pieces must have one value and degree {DEGREE} at most, got coefficients of "
                f"shape {c.shape}"
            )
        pieces = table(PIECE, len(x) - 1)
        pieces.start, pieces.end = x[:-1], x[1:]
        pieces.c[:, : len(c)] = c[::-1].T
        first = len(self.rows)
        self.rows = np.concatenate([self.rows, pieces]).view(Columns)
        return first, len(self.rows)

    def add_law(self, law: float | SpeedLaw, length: float = 1.0) -> tuple[int, int, float]:
        """Return pieces and exponent of one whose speeds are `length` times those of a law."""
        if not isinstance(law, SpeedLaw) or not law.by_speed:
            return 0, 0, 0.0
        if (law, length) not in self.known:
            curve = curve_of(law).scaled(length)
            first, last = self.add(curve)
            note_kinks(self.rows[first:last])
            self.known[law, length] = first, last, curve.exponent
        return self.known[law, length]
