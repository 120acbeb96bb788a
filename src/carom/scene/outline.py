"""The boundary of a plane region: a closed curve, counter-clockwise, that may have corners.

Its rows (start, c) are the points c0 + c1 t + ... + c5 t^5 with t = s - start, up to the start of the next row.
A corner is a row of length 0, with the direction in which the curve arrives there; the last row, at the whole
length, repeats the first point and direction. So the sign of the component of any vector along the curve is
known at the ends of all rows from c1 alone, at corners too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from carom import checks
from carom.scene.curve_table import PiecewiseCurve, between
from carom.scene.curves import Curve, Spline

TURN, SHARE = 0.2, 1 / 32  # greatest turn [rad] of a piece, and its greatest share of the length
PLACES_IN_ROW = 8  # of a piece, for its curvature and for crossings
DRAWN = 500  # places of a curve at which it may be found to cross itself
HOLLOW = 1e-3  # rise of the curvature, relative to the greatest, that separates two hollows
STRAIGHT = 1e-9  # turn at a corner that is none [rad]
SAME = 1e-9  # of the size of a curve: points nearer than this are one, and its square is no area
NODES, WEIGHTS = np.polynomial.legendre.leggauss(
    10
)  # exact for moments of second order, of degree 19


class Outline(PiecewiseCurve):
    """A closed plane curve of rows (n, 13), with corners."""

    def __init__(self, rows: np.ndarray):
        self.rows = rows
        super().__init__(rows[:, 0], rows[:, 1:].reshape(-1, 6, 2).transpose(1, 0, 2), closed=True)

    def polygon(self, count: int) -> np.ndarray:
        """Return points (K, 2) of the curve at distances of at most 1/count of its length, with all corners."""
        sharp = np.flatnonzero(np.diff(self.knots) == 0.0)
        firsts = np.concatenate([[0], sharp + 1]) if len(sharp) else np.array([0])
        lasts = np.append(sharp, len(self.knots) - 1)
        points = []
        for a, b in zip(firsts, lasts):
            if b <= a:
                continue
            line = b == a + 1 and not np.any(self.coefficients[2:, a])
            span = self.knots[b] - self.knots[a]
            n = 1 if line else max(int(np.ceil(count * span / self.length)), 2)
            s = self.knots[a] + span * np.arange(n) / n
            k = a + np.searchsorted(self.knots[a:b], s, side="right") - 1
            points.append(self._on(k, s - self.knots[k])[0])
        return np.concatenate(points)

    def moments(self) -> tuple[float, np.ndarray, np.ndarray]:
        """Return area, centroid (2,) and second moment about it, by area (2, 2): integrals along the curve."""
        length = np.diff(self.knots)
        k = np.repeat(np.flatnonzero(length > 0.0), len(NODES))
        half, weight = 0.5 * length[k], np.tile(WEIGHTS, len(k) // len(NODES)) * 0.5 * length[k]
        x, d, _ = self._on(k, half * (1.0 + np.tile(NODES, len(k) // len(NODES))))
        middle = x.mean(axis=0)
        area, shift, second = _about(middle, x, d * weight[:, None])
        for _ in range(2):  # again about the centroid, so that nothing cancels
            middle = middle + shift
            area, shift, second = _about(middle, x, d * weight[:, None])
        middle = middle + shift
        return area, middle, second / area - np.outer(shift, shift)

    def peaks(self, m: np.ndarray, w: float = 0.0) -> np.ndarray:
        """Return the points (K, 2) where m . c + w c . c / 2 is greatest nearby."""
        x, d = self.coefficients[:2]
        g = np.sum((m + w * x) * d, axis=1)
        k = np.flatnonzero((g[:-1] > 0.0) & (g[1:] <= 0.0))
        low, high = np.zeros(len(k)), np.diff(self.knots)[k]
        for _ in range(60):
            t = 0.5 * (low + high)
            x, d, _ = self._on(k, t)
            up = np.sum((m + w * x) * d, axis=1) > 0.0
            low, high = np.where(up, t, low), np.where(up, high, t)
        return self._on(k, 0.5 * (low + high))[0]

    def bends(self) -> tuple[np.ndarray, np.ndarray]:
        """Return arc lengths and signed curvatures (K,) along the curve; infinite at corners."""
        h = np.diff(self.knots)
        sharp = np.flatnonzero(h == 0.0)
        k = np.repeat(np.arange(len(h)), np.where(h > 0.0, PLACES_IN_ROW, 1))
        t = h[k] * (np.arange(len(k)) - np.searchsorted(k, k) + 0.5) / PLACES_IN_ROW
        _, d, e = self._on(k, t)
        bend = (d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]) / np.sum(d**2, axis=1) ** 1.5
        (a, b), (c, d) = self.coefficients[1, sharp].T, self.coefficients[1, sharp + 1].T
        turn = np.arctan2(a * d - b * c, a * c + b * d)
        is_turn = np.abs(turn) > STRAIGHT
        bend[np.searchsorted(k, sharp)] = np.where(is_turn, np.copysign(np.inf, turn), 0.0)
        return self.knots[k] + t, bend

    def hollows(self) -> np.ndarray:
        """Return arc lengths and curvatures (H, 2) where the curve is most hollow: curvature least, below 0."""
        s, bend = self.bends()
        finite = np.abs(bend[np.isfinite(bend)])
        rise = HOLLOW * max(np.max(finite, initial=0.0), 1e-3 / self.length)
        bend = np.clip(bend, -1e300, 1e300)
        first = int(np.argmax(bend))
        found, low, falls = [], first, True
        for k in np.roll(np.arange(len(s)), -first).tolist() + [first]:
            if falls:
                low = k if bend[k] < bend[low] else low
                if bend[k] > bend[low] + rise:
                    if bend[low] < -rise:
                        found.append((s[low], bend[low]))
                    falls, high = False, k
            else:
                high = k if bend[k] > bend[high] else high
                if bend[k] < bend[high] - rise:
                    falls, low = True, k
        return np.array(sorted(found)).reshape(-1, 2)


def _about(middle: np.ndarray, x: np.ndarray, d: np.ndarray):
    """Return area, centroid (2,) and second moment (2, 2) from points of the boundary about a point."""
    (u, v), (du, dv) = (x - middle).T, d.T
    area = 0.5 * float(np.sum(u * dv - v * du))
    shift = np.array([np.sum(u * u * dv), -np.sum(v * v * du)]) / (2.0 * area)
    mixed = np.sum(u * u * v * dv) / 2.0
    second = [[np.sum(u**3 * dv) / 3.0, mixed], [mixed, -np.sum(v**3 * du) / 3.0]]
    return area, shift, np.array(second)


def around(function: Callable) -> Outline:
    """Return the curve of a function of the angle; refuse one that crosses itself."""

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
    made = joined([_fine(curve)], corners=False)
    _check_simple(made.polygon(DRAWN))
    return made


def through(given, corners) -> Outline:
    """Return the curve through points, with corners at some of them; refuse one that crosses itself."""
    points = checks.finite_array("outline", given, (None, 2), "m")
    n = len(points)
    if n < 3:
        raise ValueError(f"outline must have at least 3 points, got {n}")
    sharp = _corners(corners, n)
    if _area(points) < 0.0:
        points, sharp = points[::-1], sorted(n - 1 - k for k in sharp)
    steps = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    size = np.max(np.ptp(points, axis=0))
    if not np.min(steps) > SAME * size:
        k = int(np.argmin(steps))
        raise ValueError(
            f"outline must have points that differ from the next ones, got {points[k]} twice; "
            "the first point is not repeated at the end"
        )
    solid = np.column_stack([points, np.zeros(n)])
    parts = [] if sharp else [_fine(Spline(solid, closed=True))]
    for a, b in pairwise([*sharp, *(k + n for k in sharp[:1])]):
        if b == a + 1:
            parts.append(straight(points[a], points[b % n], steps[a]))
        else:
            parts.append(_fine(Spline(solid[np.arange(a, b + 1) % n])))
    made = joined(parts, corners=bool(sharp))
    drawn = made.polygon(DRAWN)
    _check_simple(drawn)
    if not _area(drawn) > SAME * size**2:
        raise ValueError("outline must enclose an area, got points on a line")
    return made


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


def _fine(curve: Curve) -> PiecewiseCurve:
    """Return a curve in the plane z = 0 in pieces that turn little."""
    knots = [curve.knots[:1]]
    for a, b in pairwise(curve.knots.tolist()):
        bend = np.max(np.linalg.norm(curve._at(np.linspace(a, b, PLACES_IN_ROW))[2], axis=1))
        count = int(np.ceil(max(bend * (b - a) / TURN, (b - a) / (SHARE * curve.length))))
        knots.append(np.linspace(a, b, max(count, 1) + 1)[1:])
    s = np.concatenate(knots)
    ends = np.stack(curve._at(np.minimum(s, curve.length * (1.0 - 1e-16))), axis=1)
    ends[-1] = curve.ends[-1]
    return PiecewiseCurve(s, between(s, ends))


def straight(a: np.ndarray, b: np.ndarray, length: float) -> PiecewiseCurve:
    """Return a straight line between two points (2,)."""
    coefficients = np.zeros((6, 1, 2))
    coefficients[:2, 0] = a, (b - a) / np.linalg.norm(b - a)
    return PiecewiseCurve(np.array([0.0, length]), coefficients)


def joined(parts: list[PiecewiseCurve], corners: bool) -> Outline:
    """Return the closed curve of parts that follow each other, between which there may be corners."""
    rows, at = [], 0.0
    for part in parts:
        of_pieces = part.coefficients[:, :, :2].transpose(1, 0, 2).reshape(-1, 12)
        rows.append(np.column_stack([part.knots[:-1] + at, of_pieces]))
        at += part.length
        if corners:
            x, d, _ = part._on([-1], part.knots[-1:] - part.knots[-2])
            x, d = x[0, :2], d[0, :2]
            rows.append(np.array([[at, *x, *d / np.linalg.norm(d), *[0.0] * 8]]))
    rows.append(rows[0][:1].copy())
    rows[-1][0, 0] = at
    return Outline(np.concatenate(rows))


def _area(points: np.ndarray) -> float:
    """Return the area of a closed polygon (K, 2), negative if it runs clockwise."""
    x, y = (points - points.mean(axis=0)).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _check_simple(points: np.ndarray) -> None:
    """Refuse a closed polygon (K, 2) that crosses itself."""
    a, b, n = points, np.roll(points, -1, axis=0), len(points)

    def sides(p, d, q):
        """Return on which side of lines through p along d the points q are."""
        return d[..., 0] * (q[..., 1] - p[..., 1]) - d[..., 1] * (q[..., 0] - p[..., 0])

    for k in range(n):
        cut = sides(a[k], b[k] - a[k], a) * sides(a[k], b[k] - a[k], b) < 0.0
        cut &= sides(a, b - a, a[k]) * sides(a, b - a, b[k]) < 0.0
        cut[[(k - 1) % n, k, (k + 1) % n]] = False
        if np.any(cut):
            near = checks.shown(a[k].tolist())
            raise ValueError(f"outline must not cross itself, got a curve that does near {near}")
