"""Values of frozen records: read-only arrays."""

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
