"""The boundary of a plane region as rows of polynomials by arc length, counter-clockwise.

Row k is (start, c): the points c0 + c1 t + ... + c5 t^5 with t = s - start, up to the start of row k + 1. A
corner is a row of length 0, with the direction in which the curve arrives there; the last row, at the whole
length, repeats the first point and direction. So the sign of the component of any vector along the curve is
known at the ends of all rows from c1 alone, at corners too.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from carom import checks
from carom.fields import keep
from carom.scene.curves import Curve

ROW_WIDTH = 13  # numbers of a row: start, and 6 coefficients of x and y
TURN, SHARE = 0.2, 1 / 32  # greatest turn [rad] of a piece, and its greatest share of the length
PLACES_IN_ROW = 8  # of a piece, for its curvature and for crossings
HOLLOW = 1e-3  # rise of the curvature, relative to the greatest, that separates two hollows
STRAIGHT = 1e-9  # turn at a corner that is none [rad]
NODES, WEIGHTS = np.polynomial.legendre.leggauss(
    10
)  # exact for moments of second order, of degree 19


def of_curve(curve: Curve) -> np.ndarray:
    """Return the rows (n, 13) of a curve in the plane z = 0, in pieces that turn little."""
    knots = [curve.knots[:1]]
    for a, b in pairwise(curve.knots.tolist()):
        bend = np.max(np.linalg.norm(curve._at(np.linspace(a, b, PLACES_IN_ROW))[2], axis=1))
        count = int(np.ceil(max(bend * (b - a) / TURN, (b - a) / (SHARE * curve.length))))
        inner = np.linspace(a, b, max(count, 1) + 1)[1:]
        knots.append(inner)
    s = np.concatenate(knots)
    fine = object.__new__(Curve)
    ends = np.stack(curve._at(np.minimum(s, curve.length * (1.0 - 1e-16))), axis=1)
    ends[-1] = curve.ends[-1]
    keep(fine, knots=s, ends=ends, closed=False)
    rows = fine.coefficients[:, :, :2].transpose(1, 0, 2).reshape(-1, ROW_WIDTH - 1)
    return np.column_stack([s[:-1], rows])


def straight(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the row of a straight line between two points (2,)."""
    span = b - a
    row = np.zeros((1, ROW_WIDTH))
    row[0, 1:3], row[0, 3:5] = a, span / np.linalg.norm(span)
    return row


def joined(parts: list[np.ndarray], lengths: list[float], corners: bool) -> np.ndarray:
    """Return the rows of a closed curve from those of its parts, between which there may be corners."""
    rows, at = [], 0.0
    for part, length in zip(parts, lengths):
        rows.append(part + at * (np.arange(ROW_WIDTH) == 0))
        at += length
        if corners:
            end = np.zeros((1, ROW_WIDTH))
            x, d, _ = points_of(part[-1:], np.array([length - part[-1, 0]]))
            end[0, 0], end[0, 1:3], end[0, 3:5] = at, x[0], d[0] / np.linalg.norm(d[0])
            rows.append(end)
    last = rows[0][:1].copy()
    last[0, 0] = at
    return np.concatenate([*rows, last])


def points_of(rows: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return position, first and second derivative (K, 2) at distances t (K,) from the starts of K rows."""
    c, t = rows[:, 1:].reshape(-1, 6, 2), t[:, None]
    x, d, e = c[:, 5], np.zeros_like(c[:, 5]), np.zeros_like(c[:, 5])
    for power in range(4, -1, -1):
        e, d, x = e * t + 2.0 * d, d * t + x, x * t + c[:, power]
    return x, d, e


def polygon(rows: np.ndarray, count: int) -> np.ndarray:
    """Return points (K, 2) of the curve at distances of at most 1/count of its length, with all corners."""
    sharp = np.flatnonzero(np.diff(rows[:, 0]) == 0.0)
    firsts = np.concatenate([[0], sharp + 1]) if len(sharp) else np.array([0])
    lasts = np.append(sharp, len(rows) - 1)
    points = []
    for a, b in zip(firsts, lasts):
        if b <= a:
            continue
        line = b == a + 1 and not np.any(rows[a, 5:])
        span = rows[b, 0] - rows[a, 0]
        n = 1 if line else max(int(np.ceil(count * span / rows[-1, 0])), 2)
        s = rows[a, 0] + span * np.arange(n) / n
        k = a + np.searchsorted(rows[a:b, 0], s, side="right") - 1
        points.append(points_of(rows[k], s - rows[k, 0])[0])
    return np.concatenate(points)


def moments(rows: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Return area, centroid (2,) and second moment about it, by area (2, 2): integrals along the boundary."""
    length = np.diff(rows[:, 0])
    k = np.repeat(np.flatnonzero(length > 0.0), len(NODES))
    half, weight = 0.5 * length[k], np.tile(WEIGHTS, len(k) // len(NODES)) * 0.5 * length[k]
    x, d, _ = points_of(rows[k], half * (1.0 + np.tile(NODES, len(k) // len(NODES))))
    middle = x.mean(axis=0)
    area, shift, second = _about(middle, x, d * weight[:, None])
    for _ in range(2):  # again about the centroid, so that nothing cancels
        middle = middle + shift
        area, shift, second = _about(middle, x, d * weight[:, None])
    middle = middle + shift
    return area, middle, second / area - np.outer(shift, shift)


def _about(middle: np.ndarray, x: np.ndarray, d: np.ndarray):
    """Return area, centroid (2,) and second moment (2, 2) from points of the boundary about a point."""
    (u, v), (du, dv) = (x - middle).T, d.T
    area = 0.5 * float(np.sum(u * dv - v * du))
    shift = np.array([np.sum(u * u * dv), -np.sum(v * v * du)]) / (2.0 * area)
    mixed = np.sum(u * u * v * dv) / 2.0
    second = [[np.sum(u**3 * dv) / 3.0, mixed], [mixed, -np.sum(v**3 * du) / 3.0]]
    return area, shift, np.array(second)


def peaks(rows: np.ndarray, m: np.ndarray, w: float = 0.0) -> np.ndarray:
    """Return the points (K, 2) where m . c + w c . c / 2 is greatest nearby."""
    x, d = rows[:, 1:3], rows[:, 3:5]
    g = np.sum((m + w * x) * d, axis=1)
    k = np.flatnonzero((g[:-1] > 0.0) & (g[1:] <= 0.0))
    low, high = np.zeros(len(k)), np.diff(rows[:, 0])[k]
    for _ in range(60):
        t = 0.5 * (low + high)
        x, d, _ = points_of(rows[k], t)
        up = np.sum((m + w * x) * d, axis=1) > 0.0
        low, high = np.where(up, t, low), np.where(up, high, t)
    return points_of(rows[k], 0.5 * (low + high))[0]


def bends(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return arc lengths and signed curvatures (K,) along the curve; infinite at corners."""
    s, bend = [], []
    for k, h in enumerate(np.diff(rows[:, 0])):
        if h > 0.0:
            t = h * (np.arange(PLACES_IN_ROW) + 0.5) / PLACES_IN_ROW
            _, d, e = points_of(np.repeat(rows[k : k + 1], PLACES_IN_ROW, axis=0), t)
            s.append(rows[k, 0] + t)
            bend.append((d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]) / np.sum(d**2, axis=1) ** 1.5)
        else:
            (a, b), (c, d) = rows[k, 3:5], rows[k + 1, 3:5]
            turn = np.arctan2(a * d - b * c, a * c + b * d)
            s.append(rows[k : k + 1, 0])
            bend.append(np.array([np.copysign(np.inf, turn) if abs(turn) > STRAIGHT else 0.0]))
    return np.concatenate(s), np.concatenate(bend)


def hollows(rows: np.ndarray) -> np.ndarray:
    """Return the arc lengths and curvatures (H, 2) where a curve is most hollow: curvature least, below 0."""
    s, bend = bends(rows)
    finite = np.abs(bend[np.isfinite(bend)])
    rise = HOLLOW * max(np.max(finite, initial=0.0), 1e-3 / rows[-1, 0])
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


def check_simple(points: np.ndarray) -> None:
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
