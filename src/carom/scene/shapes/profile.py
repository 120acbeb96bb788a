"""`Profile`: a prism over a plane closed curve, convex or not: cams, ratchets, Geneva wheels."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.fields import keep
from carom.scene import outline
from carom.scene.curves import Curve, Spline
from carom.scene.pieces import Piece, Shape

SAMPLED = 1.05  # the greatest curvature by that of the samples of a piece


@arguments.known
@dataclass(frozen=True, init=False, eq=False, repr=False)
class Profile(Shape):
    """A solid of constant thickness over a plane closed curve, convex or not: a cam, a ratchet, a Geneva wheel.

    The curve lies in the plane of x and y; the solid extends by half the thickness to both sides of it. The
    shape is moved so that its centroid becomes the origin of the body: a point with the coordinates ``p`` here
    is at ``p - centroid`` in body axes.

    It touches half-spaces, boxes and convex prisms with faces across its plane, and cylinders, discs and
    capsules with parallel axes, along its thickness; and spheres anywhere. The flat sides of the prism touch
    spheres only. Other pairs are refused.

    Parameters
    ----------
    outline : (n, 2) or callable
        Points [m] through which a closed cubic spline goes, at least 3, the first of which is not repeated at
        the end. Or a function of the angle from 0 to 2 pi [rad], periodic with continuous curvature, that
        returns the distance from the axis [m] at this angle, or a point (2,) [m].
    thickness
        Thickness along z [m], above 0.
    corners : sequence of int or "all"
        Which of the points are corners, by number; "all": the curve is a polygon. Between two corners is a
        spline, or a straight line if there is no other point. Default: none.

    Attributes
    ----------
    thickness
        Thickness [m].
    length
        Length of the curve [m].
    centroid : (3,)
        Centroid of the solid, in the axes of `outline` [m].
    volume
        Volume [m^3].
    size
        Largest distance of a point of the shape from the centroid [m].

    Raises
    ------
    ValueError
        If the curve crosses itself or is not smooth between its corners.

    Notes
    -----
    A table of the curve by arc length is within 1e-12 of its size; area, centroid and inertia are exact
    integrals along the boundary of the table.

    Examples
    --------
    An eccentric disc as a function of the angle, and a ratchet of eight teeth:

    >>> import math
    >>> disc = carom.Profile(lambda a: (0.02 + 0.05 * math.cos(a), 0.05 * math.sin(a)), thickness=0.01)
    >>> round(float(disc.centroid[0]), 9), round(disc.length / math.pi, 9)
    (0.02, 0.1)
    >>> turn = [0.25 * math.pi * k for k in range(8)]
    >>> teeth = [(r * math.cos(a), r * math.sin(a)) for a in turn for r in (0.04, 0.05)]
    >>> carom.Profile(teeth, thickness=0.01, corners="all")
    Profile(<16 corners>, thickness=0.01)
    """

    thickness: float
    centroid: np.ndarray
    volume: float
    size: float
    rows: np.ndarray  # of `carom.scene.outline`, in body axes
    _spread: np.ndarray  # integral of x x^T over the solid, by volume [m^2]

    def __init__(
        self,
        outline: ArrayLike | Callable,
        thickness: float,
        corners: Sequence[int] | str = (),
    ):
        thickness = checks.length("thickness", thickness)
        if callable(outline):
            if not isinstance(corners, tuple) or corners:
                raise ValueError(
                    "corners must be left out where outline is a function, got "
                    f"{checks.shown(corners)}; give points for a curve with corners"
                )
            rows = _of_function(outline)
        else:
            rows = _of_points(outline, corners)
        self._keep(rows, thickness)

    def _keep(self, rows: np.ndarray, thickness: float) -> None:
        area, middle, second = outline.moments(rows)
        rows[:, 1:3] -= middle
        half = 0.5 * thickness
        far = np.max(np.linalg.norm(outline.peaks(rows, np.zeros(2), 1.0), axis=1), initial=0.0)
        far = max(far, np.max(np.linalg.norm(rows[:, 1:3], axis=1)))
        spread = np.diag([0.0, 0.0, half**2 / 3.0])
        spread[:2, :2] = second
        keep(self, thickness=thickness, rows=rows, centroid=np.array([*middle, 0.0]))
        keep(self, volume=area * thickness, size=math.hypot(far, half), _spread=spread)

    def __repr__(self) -> str:
        count = int(np.sum(np.diff(self.rows[:, 0]) == 0.0))
        of = f"<{count} corners>" if count else f"<length {self.length:g} m>"
        return f"Profile({of}, thickness={self.thickness!r})"

    @property
    def length(self) -> float:
        """Length of the curve [m]."""
        return float(self.rows[-1, 0])

    def points(self, count: int = 128) -> np.ndarray:
        """Return points (K, 2) of the curve in body axes [m], counter-clockwise: about `count`, and corners."""
        return outline.polygon(self.rows, checks.integer("count", count, least=3))

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """One piece: the prism, which is not convex."""
        half = np.array([np.max(np.abs(self.rows[:, k])) for k in (1, 2)] + [0.5 * self.thickness])
        of_curve: dict[str, Any] = {"outline": self.rows, "hollows": outline.hollows(self.rows)}
        bend = outline.bends(self.rows)[1]
        most = SAMPLED * max(0.0, -float(np.min(bend[np.isfinite(bend)], initial=0.0)))
        return (Piece("profile", half, extent=self.size, bend=most, **of_curve),)

    def _inertia(self, mass: float) -> np.ndarray:
        return mass * (np.trace(self._spread) * np.eye(3) - self._spread)


def _of_function(function: Callable) -> np.ndarray:
    """Return the rows of the curve of a function of the angle."""

    def place(angle: float) -> tuple[float, float, float]:
        value = checks.call("outline", function, angle)
        try:
            numbers = np.array(value, dtype=float).ravel()
        except (OverflowError, TypeError, ValueError):
            numbers = np.zeros(0)
        if len(numbers) not in (1, 2) or not np.all(np.isfinite(numbers)):
            raise ValueError(
                "outline must return the distance from the axis, or a point (2,), "
                f"got {checks.shown(value)} at the angle {angle:.6g}"
            )
        if len(numbers) == 2:
            return numbers[0], numbers[1], 0.0
        if not numbers[0] > 0.0:
            raise ValueError(
                f"outline must return a distance above 0, got {numbers[0]:g} at the angle {angle:.6g}"
            )
        return numbers[0] * math.cos(angle), numbers[0] * math.sin(angle), 0.0

    angles = np.linspace(0.0, 2.0 * math.pi, 64, endpoint=False)
    right = _area(np.array([place(a)[:2] for a in angles.tolist()])) < 0.0
    whole = 2.0 * math.pi
    curve = Curve(lambda u: place(whole - u if right else u), 0.0, whole, closed=True)
    rows = outline.joined([outline.of_curve(curve)], [curve.length], corners=False)
    outline.check_simple(outline.polygon(rows, 500))
    return rows


def _area(points: np.ndarray) -> float:
    """Return the area of a closed polygon (K, 2), negative if it runs clockwise."""
    x, y = (points - points.mean(axis=0)).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _of_points(given, corners) -> np.ndarray:
    """Return the rows of the curve through points, with corners at some of them."""
    points = checks.finite_array("outline", given, (None, 2), "m")
    n = len(points)
    if n < 3:
        raise ValueError(f"outline must have at least 3 points, got {n}")
    sharp = _corners(corners, n)
    if _area(points) < 0.0:
        points, sharp = points[::-1], sorted(n - 1 - k for k in sharp)
    steps = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    size = np.max(np.ptp(points, axis=0))
    if not np.min(steps) > 1e-9 * size:
        k = int(np.argmin(steps))
        raise ValueError(
            f"outline must have points that differ from the next ones, got {points[k]} twice; "
            "the first point is not repeated at the end"
        )
    solid = np.column_stack([points, np.zeros(n)])
    if not sharp:
        curve = Spline(solid, closed=True)
        rows = outline.joined([outline.of_curve(curve)], [curve.length], corners=False)
    else:
        parts, lengths = [], []
        for a, b in zip(sharp, [*sharp[1:], sharp[0] + n]):
            through = np.arange(a, b + 1) % n
            if b == a + 1:
                parts.append(outline.straight(points[a], points[b % n]))
                lengths.append(float(steps[a]))
            else:
                curve = Spline(solid[through])
                parts.append(outline.of_curve(curve))
                lengths.append(curve.length)
        rows = outline.joined(parts, lengths, corners=True)
    drawn = outline.polygon(rows, 500)
    outline.check_simple(drawn)
    if not _area(drawn) > 1e-9 * size**2:
        raise ValueError("outline must enclose an area, got points on a line")
    return rows


def _corners(given, n: int) -> list[int]:
    """Return the numbers of corners, in order."""
    if isinstance(given, str) and given == "all":
        return list(range(n))
    numbers = isinstance(given, Sequence) and not isinstance(given, (str, bytes))
    if type(given) is np.ndarray:
        numbers = given.ndim == 1
    if not numbers:
        raise ValueError(f"corners must be 'all' or numbers of points, got {checks.shown(given)}")
    found = [checks.integer("corners", k, least=0, most=n - 1) for k in given]
    return sorted(set(found))
