"""Curves in space for joints: `Spline` through points, and `Curve` of a function.

Every curve becomes a table by arc length (`carom.scene.curve_table`). Kernels know only this form, which the
outline of a `Profile` has too (`carom.scene.outline`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.fields import keep
from carom.scene.curve_table import ACCURACY, PiecewiseCurve, between, points_of, table_of


@arguments.known
@dataclass(frozen=True, init=False, eq=False, repr=False)
class Curve(PiecewiseCurve):
    """A curve of a function of one parameter, from its start to its end.

    Parameters
    ----------
    function : callable
        ``function(u)`` returns a point (3,) [m]: plain Python, NumPy or SymPy, for a float u. Position,
        direction and curvature must be continuous; the function may have any speed along u, but not 0.
    start, end : float
        Range of u. Default 0 to 1.
    closed : bool
        Whether the curve ends where it begins, with the same direction and curvature. Default False.

    Attributes
    ----------
    length : float
        Arc length from the start to the end [m].
    closed : bool
    knots : (n + 1,)
        Arc lengths s at the ends of the n pieces of the table.
    ends : (n + 1, 3, 3)
        Position [m], direction and curvature vector [1/m] at the knots.

    Raises
    ------
    ValueError
        If the function is not finite, stops, or has a corner or a jump of the curvature; if a closed curve does
        not close.

    Notes
    -----
    The table differs from the curve by less than 1e-12 of its size, or by round-off.

    Examples
    --------
    >>> import math
    >>> circle = carom.curves.Curve(lambda u: (math.cos(u), math.sin(u), 0.0), 0.0, 2 * math.pi, closed=True)
    >>> round(circle.length, 9)
    6.283185307
    """

    knots: np.ndarray
    ends: np.ndarray
    closed: bool

    def __init__(
        self,
        function: Callable[[float], Any],
        start: float = 0.0,
        end: float = 1.0,
        closed: bool = False,
    ):
        function = checks.function("function", function)
        start = checks.number("start", start)
        end = checks.number("end", end, above=start)
        edges = np.linspace(start, end, 9).tolist()
        table = table_of(lambda u: points_of(function, u), edges, checks.flag("closed", closed))
        keep(self, **table)

    def __repr__(self) -> str:
        pieces = f"{len(self.knots) - 1} pieces{', closed' * self.closed}"
        return f"{type(self).__name__}(length={self.length:g} m, {pieces})"

    @classmethod
    def _of(cls, knots: np.ndarray, ends: np.ndarray, closed: bool) -> Curve:
        """Return the curve with these ends of its pieces."""
        made = object.__new__(cls)
        keep(made, knots=knots, ends=ends, closed=closed)
        return made

    @cached_property
    def coefficients(self) -> np.ndarray:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Coefficients (6, n, 3) of the pieces in s - knot, the constant first."""
        return between(self.knots, self.ends)

    @cached_property
    def normals(self) -> np.ndarray:
        """Unit vectors (n, 3) across the curve at the start of each piece, which turn as little as possible.

        Those of a closed curve turn evenly about it, so that they close too. (Double reflection: Wang et al.
        2008.)
        """
        x, t = self.ends[:, 0], self.ends[:, 1]
        out = [np.cross(t[0], np.eye(3)[np.argmin(np.abs(t[0]))])]
        out[0] /= np.linalg.norm(out[0])
        for k in range(len(x) - 1):
            step, n = x[k + 1] - x[k], out[-1]
            n = n - 2.0 * (step @ n) / (step @ step) * step
            turned = t[k] - 2.0 * (step @ t[k]) / (step @ step) * step
            back = t[k + 1] - turned
            out.append(n - 2.0 * (back @ n) / max(back @ back, 1e-300) * back)
        normals, last = np.array(out[:-1]), out[-1]
        if self.closed:
            angle = math.atan2(last @ np.cross(t[0], out[0]), last @ out[0])
            turn = -angle * self.knots[:-1, None] / self.length
            across = np.cross(t[:-1], normals)
            normals = np.cos(turn) * normals + np.sin(turn) * across
        return normals

    @property
    def sharpest(self) -> float:
        """Largest curvature [1/m] of the curve, at its knots."""
        return float(np.max(np.linalg.norm(self.ends[:, 2], axis=1)))

    def point(self, s: ArrayLike) -> np.ndarray:
        """Return the points (..., 3) [m] at arc lengths s (...) [m]; beyond an end, those of the last piece."""
        return self._at(_lengths(s))[0]

    def tangent(self, s: ArrayLike) -> np.ndarray:
        """Return the unit tangents (..., 3) at arc lengths s (...) [m]."""
        slope = self._at(_lengths(s))[1]
        return slope / np.linalg.norm(slope, axis=-1, keepdims=True)

    def nearest(self, point: ArrayLike) -> float:
        """Return the arc length [m] of the point of the curve that is nearest to a point (3,)."""
        point = checks.finite_array("point", point, (3,), "m")
        s = self.foot_from(
            point, self.knots[np.argmin(np.sum((self.ends[:, 0] - point) ** 2, axis=1))]
        )
        return s if self.closed else min(max(s, 0.0), self.length)

    def foot_from(self, point: np.ndarray, s: float, far: bool = False) -> float:
        """Return the arc length of the foot of a point (3,), from one nearby, or `far` from the curve."""
        longest = np.max(np.diff(self.knots))
        for k in range(20):
            place, slope, bend = self._at(np.array([s]))
            e, square = point - place[0], np.sum(slope[0] ** 2)
            # the first corrections do without the curvature, which counts near the curve only
            below = square - (np.sum(e * bend[0]) if k > 1 or far else 0.0)
            step = np.sum(e * slope[0]) / max(below, 0.5 * square)
            s = s + (min(max(step, -longest), longest) if far else step)
        return float(s)


@arguments.known
@dataclass(frozen=True, init=False, eq=False, repr=False)
class Spline(Curve):
    """A cubic spline (C2) through points.

    Parameters
    ----------
    points : (N, 3)
        Points [m] of the curve, in order: at least 2, and of a closed one at least 3, the first of which is
        not repeated at the end.
    closed : bool
        Whether the curve goes on from the last point to the first. Default False.

    Notes
    -----
    The parameter of the spline is the length of the chords; beyond that it is like `Curve`.

    Examples
    --------
    >>> rail = carom.curves.Spline([(0, 0, 0), (3, 4, 0), (6, 8, 0)])
    >>> round(rail.length, 9), round(rail.nearest((3, 4, 0)), 9)
    (10.0, 5.0)
    """

    def __init__(self, points: ArrayLike, closed: bool = False):
        from scipy.interpolate import CubicSpline

        points = checks.finite_array("points", points, (None, 3), "m")
        closed, least = checks.flag("closed", closed), 3 if closed else 2
        if len(points) < least:
            kind = "a closed" if closed else "an open"
            raise ValueError(f"points must be at least {least} of {kind} spline, got {len(points)}")
        through = np.vstack([points, points[:1]]) if closed else points
        chords = np.linalg.norm(np.diff(through, axis=0), axis=1)
        short = int(np.argmin(chords))
        if not chords[short] > ACCURACY * np.max(np.abs(points)):
            other = (short + 1) % len(points)
            again = "; the first point of a closed spline is not repeated" if closed else ""
            raise ValueError(
                f"points must differ from the next ones, got {points[short]} for points {short} and "
                f"{other}{again}"
            )
        u = np.concatenate([[0.0], np.cumsum(chords)])
        bounds = "periodic" if closed else "not-a-knot"
        table = table_of(CubicSpline(u, through - points[0], bc_type=bounds), u.tolist(), closed)
        table["ends"][:, 0] += points[0]  # small numbers have less round-off
        keep(self, **table)


def _lengths(s: ArrayLike) -> np.ndarray:
    """Return arc lengths as an array; refuse those that are not finite."""
    array = checks.real_array("s", s, "any")
    if not np.all(np.isfinite(array)):
        raise ValueError(f"s must be finite, got {checks.shown(s)}")
    return array


CURVES = (Curve, Spline)

__getattr__ = arguments.members_of("carom.curves", ["Curve", "Spline"])


def __dir__() -> list[str]:
    return ["Curve", "Spline"]
