"""Arrays of records whose fields are columns: ``bodies.mass``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np


class Columns(np.recarray):
    """A record array that looks for a column only if an array has no attribute of that name.

    `numpy.recarray` uses Python code for every attribute, index and view, half a microsecond each, which took a
    third of a short run. Rows are `numpy.record` here too. As an attribute a column is a plain array;
    ``bodies["mass"]`` is still of this class, and ten times faster.
    """

    if not TYPE_CHECKING:
        __getattribute__ = np.ndarray.__getattribute__
        __getitem__ = np.ndarray.__getitem__
        __array_finalize__ = np.ndarray.__array_finalize__

        def __getattr__(self, name: str) -> np.ndarray:
            try:
                return np.ndarray.__getitem__(self, name).view(np.ndarray)
            except (ValueError, IndexError):
                raise AttributeError(f"there is no column {name!r}") from None

        def __setattr__(self, name: str, value) -> None:
            if name in (self.dtype.names or ()):
                self[name] = value
            else:
                np.ndarray.__setattr__(self, name, value)


def table(fields: list, *shape: int) -> Columns:
    """Return a zero array of records with the given fields."""
    kind = _KINDS.get(id(fields))
    if kind is None:
        kind = fields, np.dtype((np.record, np.dtype(fields, align=True)))
        _KINDS[id(fields)] = kind
    return np.zeros(shape, kind[1]).view(Columns)


#: lists of fields and the types made from them: without this cache they took a tenth of a short run
_KINDS: dict[int, tuple[list, np.dtype]] = {}
