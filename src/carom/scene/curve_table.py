"""Curves as pieces of degree 5 in the arc length s: their points, and tables of them from those of a function.

The pieces of a table agree with the curve of a function in position, direction and curvature at their ends, so
that the table is C2. There are as many as keep it within `ACCURACY` of the size of the curve, and s within
`EVEN` of its arc length.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from carom import checks

ACCURACY = 1e-12  # error of a table, relative to the size of its curve
EVEN = 1e-11  # largest difference of |dx/ds| from 1
SERIES = 16  # degree of the polynomials that stand for a function while its table is made
RESOLVED = 1e-13  # their last coefficients, relative to the size of the curve
MOST_PANELS, MOST_PIECES = 4096, 256  # of these polynomials, and of pieces for one of them
SLOWEST = 1e-6  # least speed along a parameter, relative to the mean: below it is a cusp
SHARPEST = 1e-7  # least radius of curvature, relative to the length of the curve
#: greatest jump between two parts: of the size of the curve, of its direction, of its greatest curvature
JUMP = np.array([1e-8, 1e-7, 1e-5])
ROUND_OFF = 1e-15  # of coordinates
NODES = chebyshev.chebpts2(SERIES + 1)
TO_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(NODES, SERIES))


class PiecewiseCurve:
    """A curve in a plane or in space as polynomials of degree 5 in the arc length s, between knots.

    The `knots` (n + 1,) are arc lengths at the ends of its n pieces; at a corner is a piece of length 0. The
    `coefficients` (6, n, d) of the pieces are those in s - knot, the constant first; some may follow that are
    those at the last knot.
    """

    def __init__(self, knots: np.ndarray, coefficients: np.ndarray, closed: bool = False):
        self.knots, self.coefficients, self.closed = knots, coefficients, closed

    @property
    def length(self) -> float:
        """Arc length from the start to the end [m]."""
        return float(self.knots[-1])

    def _at(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return position, first and second derivative (..., d) at arc lengths (...)."""
        s = s % self.length if self.closed else s
        k = np.clip(np.searchsorted(self.knots, s, side="right") - 1, 0, len(self.knots) - 2)
        return self._on(k, s - self.knots[k])

    def _on(self, k: Any, t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return position, first and second derivative (..., d) at distances t from the starts of pieces k."""
        t, c = t[..., None], self.coefficients[:, k]
        value, slope, bend = c[5], np.zeros_like(c[5]), np.zeros_like(c[5])
        for power in range(4, -1, -1):
            bend = bend * t + 2.0 * slope
            slope, value = slope * t + value, value * t + c[power]
        return value, slope, bend


def between(knots: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return the coefficients (6, n, d) of pieces with these ends (n + 1, 3, d)."""
    h = np.diff(knots)[:, None]
    (p, v, a), (q, w, b) = np.moveaxis(ends[:-1], 1, 0), np.moveaxis(ends[1:], 1, 0)
    d, e, f = q - p - h * v - 0.5 * h * h * a, h * (w - v - h * a), h * h * (b - a)
    third, fourth = 10.0 * d - 4.0 * e + 0.5 * f, -15.0 * d + 7.0 * e - f
    fifth = 6.0 * d - 3.0 * e + 0.5 * f
    return np.stack([p, v, 0.5 * a, third / h**3, fourth / h**4, fifth / h**5])


def points_of(function: Callable, u: np.ndarray) -> np.ndarray:
    """Return the points (K, 3) of a function of the user's."""
    found = []
    for one in u.tolist():
        point = checks.call("function", function, one)
        try:
            found.append(np.array([float(x) for x in point]))
        except (OverflowError, TypeError, ValueError):
            found.append(np.zeros(0))
        if found[-1].shape != (3,) or not np.all(np.isfinite(found[-1])):
            raise ValueError(
                f"function must return a finite point (3,), got {checks.shown(point)} for {one!r}"
            )
    return np.array(found)


def table_of(function: Callable, edges: Sequence[float], closed: bool) -> dict[str, Any]:
    """Return the fields of a curve that is smooth between the edges of its parameter."""
    size = np.ptp(function(np.array(edges)), axis=0).max()
    panels, left = [], [*pairwise(edges)][::-1]
    while left:
        a, b = left.pop()
        values = function(0.5 * (a + b) + 0.5 * (b - a) * NODES)
        size = max(size, np.ptp(values, axis=0).max())
        if not size > 0.0:
            raise ValueError("a curve must have a length above 0, got one point")
        panel = _panel(values, a, b, size)
        if panel is not None:
            panels.append(panel)
            continue
        if len(left) + len(panels) > MOST_PANELS or not b - a > 1e-9 * (edges[-1] - edges[0]):
            raise ValueError(
                "a curve must be smooth, with continuous curvature and without a cusp, got one that is not "
                f"near the parameter {0.5 * (a + b):.6g}, the point {checks.shown(values[0].tolist())}"
            )
        left += [(0.5 * (a + b), b), (a, 0.5 * (a + b))]
    pieces = [panel.pieces(size) for panel in panels]
    first = np.concatenate([[0.0], np.cumsum([knots[-1] for knots, _ in pieces])])
    knots = np.concatenate([s[:-1] + at for (s, _), at in zip(pieces, first)] + [first[-1:]])
    ends = np.concatenate([e[:-1] for _, e in pieces] + [pieces[-1][1][-1:]])
    bend = np.linalg.norm(ends[:, 2], axis=1)
    k = int(np.argmax(bend))
    if not bend[k] * SHARPEST * knots[-1] < 1.0:
        raise ValueError(
            f"a curve must have radii of curvature above {SHARPEST:g} of its length, got {1.0 / bend[k]:.3g} m "
            f"at {checks.shown(ends[k, 0].tolist())}"
        )
    scale = JUMP * (size, 1.0, max(1.0 / size, bend.max()))
    scale *= 1.0 + 1e-4 * np.max(np.abs(ends[:, 0])) / size  # round-off
    for k, ((_, here), (_, there)) in enumerate(pairwise(pieces + pieces[: int(closed)])):
        jumps = np.linalg.norm(there[0] - here[-1], axis=1) / scale
        if not np.max(jumps) < 1.0:
            what = ("position", "direction", "curvature")[int(np.argmax(jumps))]
            need = "a curve must be continuous in position, direction and curvature"
            if k + 1 == len(pieces):
                need = "closed must be False of a curve whose ends do not meet so"
            raise ValueError(
                f"{need}, got a jump of its {what} at {checks.shown(here[-1, 0].tolist())}"
            )
    if closed:
        ends[-1] = ends[0]
    return {"knots": knots, "ends": ends, "closed": closed}


class _Panel(NamedTuple):
    """A part of a curve as polynomials of a parameter from -1 to 1."""

    #: (SERIES + 2, 11) Chebyshev coefficients of position, first and second derivatives, speed and arc length
    series: np.ndarray
    length: float

    def at(self, u: np.ndarray) -> list[np.ndarray]:
        """Return position, derivatives (K, 3), speed and arc length (K,) at parameters."""
        return np.split(chebyshev.chebvander(u, SERIES + 1) @ self.series, (3, 6, 9, 10), axis=1)

    def ends(self, s: np.ndarray) -> np.ndarray:
        """Return position, direction and curvature vector (K, 3, 3) at arc lengths."""
        u, step = 2.0 * s / self.length - 1.0, np.ones(1)
        for _ in range(20):
            x, d, e, pace, length = self.at(u)
            if np.max(np.abs(step)) < 1e-9:  # the error after it is its square
                break
            step = (length[:, 0] - s) / pace[:, 0]
            u = np.clip(u - step, -1.0, 1.0)
        square = np.sum(d**2, axis=1, keepdims=True)
        t = d / np.sqrt(square)
        return np.stack([x, t, (e - np.sum(e * t, axis=1, keepdims=True) * t) / square], axis=1)

    def pieces(self, size: float) -> tuple[np.ndarray, np.ndarray]:
        """Return knots and ends, with as few pieces of equal length as are accurate."""
        count = 1
        while True:
            s = np.linspace(0.0, self.length, count + 1)
            ends = self.ends(s)
            tried = (s[:-1, None] + self.length / count * np.array([0.25, 0.5, 0.75])).ravel()
            place, slope, _ = PiecewiseCurve(s, between(s, ends))._at(tried)
            exact = self.ends(tried)[:, 0]
            round_off = ROUND_OFF * np.max(np.abs(exact))
            off = np.max(np.abs(place - exact)) / max(ACCURACY * size, round_off)
            uneven = np.max(np.abs(np.linalg.norm(slope, axis=1) - 1.0)) / EVEN
            if max(off, uneven) <= 1.0 or count >= MOST_PIECES:
                return s, ends
            # errors are of the orders 6 and 5
            growth = 1.1 * max(off ** (1 / 6), uneven ** (1 / 5))
            count = min(max(count + 1, math.ceil(count * growth)), 8 * count, MOST_PIECES)


def _panel(values: np.ndarray, a: float, b: float, size: float) -> _Panel | None:
    """Return the polynomials through points (n, 3) at `NODES`; None if they do not stand for the curve."""
    x = TO_COEFFICIENTS @ values
    d = chebyshev.chebder(x)
    speed = np.linalg.norm(chebyshev.chebval(NODES, d), axis=0)
    if not speed.min() > SLOWEST * speed.mean():
        return None
    pace = TO_COEFFICIENTS @ speed
    round_off = max(RESOLVED * size, ROUND_OFF * np.max(np.abs(values)))
    # a derivative multiplies round-off by up to the square of the degree
    if np.max(np.abs(x[-3:])) > round_off or np.max(np.abs(pace[-3:])) > SERIES**2 * round_off:
        return None
    length = chebyshev.chebint(pace, lbnd=-1.0)
    columns = [*x.T, *d.T, *chebyshev.chebder(d).T, pace]
    series = np.stack(
        [np.pad(one, (0, SERIES + 2 - len(one))) for one in [*columns, length]], axis=1
    )
    return _Panel(series, float(np.sum(length)))
