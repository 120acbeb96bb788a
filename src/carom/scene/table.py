"""Tables of columns that have rows."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np


class Table:
    """Base class of tables whose columns are arrays: ``len`` is the number of rows, ``table[k]`` is row k."""

    def __len__(self) -> int:
        return len(next(iter(self._columns().values())))

    def __getitem__(self, k: int) -> dict:
        if not -len(self) <= k < len(self):
            raise IndexError(f"there is no row {k}: the table has {len(self)}, numbered from 0")
        return {name: plain(column[k]) for name, column in self._columns().items()}

    def __iter__(self) -> Iterator[dict]:
        return (self[k] for k in range(len(self)))

    def __repr__(self) -> str:
        rows = [
            "  " + "  ".join(f"{name} = {_brief(value)}" for name, value in self[k].items())
            for k in range(min(len(self), 8))
        ]
        more = [f"  ... {len(self) - 8} more"] if len(self) > 8 else []
        return "\n".join([f"<{type(self).__name__}: {len(self)} rows", *rows, *more]) + ">"

    def _columns(self) -> dict[str, np.ndarray]:
        return {name: one for name, one in vars(self).items() if isinstance(one, np.ndarray)}


def plain(value):
    """Return a number of NumPy as one of Python, other values unchanged."""
    return value.item() if isinstance(value, np.generic) else value


def _brief(value) -> str:
    if isinstance(value, float):
        return f"{value:.9g}"
    return np.array2string(value, precision=6) if isinstance(value, np.ndarray) else str(value)
