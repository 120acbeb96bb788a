"""Values of frozen records: read-only arrays, and the rotation matrix of a quaternion."""

from __future__ import annotations

import numpy as np

from carom import check


def keep(record, **fields) -> None:
    """Set `fields` of a frozen `record` while it is made; arrays become read-only."""
    for name, value in fields.items():
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
        object.__setattr__(record, name, value)


def point(name: str, value) -> np.ndarray:
    """Return `value` as a point or vector (3,)."""
    return check.finite_array(name, value, (3,))


def optional_point(name: str, value) -> np.ndarray | None:
    """Return `value` as a point (3,), or None."""
    return None if value is None else point(name, value)


def rotation_matrix(orientation: np.ndarray) -> np.ndarray:
    """Return the matrix (3,3), body to world, of a unit quaternion (w, x, y, z)."""
    w, x, y, z = orientation
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
