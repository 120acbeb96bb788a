"""Frames from one direction."""

from __future__ import annotations

import numpy as np


def triad(axis: np.ndarray) -> np.ndarray:
    """Return a right-handed frame whose first column is the unit vector `axis`."""
    across = np.eye(3)[np.argmin(np.abs(axis))]
    second = across - (across @ axis) * axis
    second /= np.linalg.norm(second)
    return np.stack([axis, second, np.cross(axis, second)], axis=1)


def contact_axes(normal: np.ndarray) -> np.ndarray:
    """Return rows n, t1, t2: t1 the world axis least along n (x first), made tangent; t2 = n x t1."""
    return np.ascontiguousarray(triad(normal).T)
