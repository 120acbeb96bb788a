"""Arrays of records whose fields are columns: ``bodies.mass``."""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np

#: of an array, on which its type depends: C order, Fortran order, aligned, writeable
ARRAY_FLAGS = 0x1 | 0x2 | 0x100 | 0x400


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
    """Return a zero array of records with the given fields.

    Its memory is an array of bytes: NumPy takes ten times as long to make zeros of a type with many fields.
    An array without rows is made once for each type.
    """
    if id(fields) not in _KINDS:
        kind = np.dtype((np.record, np.dtype(fields, align=True)))
        _KINDS[id(fields)] = fields, kind, np.zeros(0, kind).view(Columns)
    _, kind, none = _KINDS[id(fields)]
    if shape == (0,):
        return none
    return np.ndarray.__new__(Columns, shape, kind, np.zeros(kind.itemsize * prod(shape), np.uint8))


def copied(rows: np.ndarray) -> Any:
    """Return a copy of contiguous rows, as bytes: NumPy copies records field by field."""
    return np.ndarray.__new__(type(rows), rows.shape, rows.dtype, bytearray(rows.tobytes()))


#: lists of fields and the types made from them: without this cache they took a tenth of a short run
_KINDS: dict[int, tuple[list, np.dtype, Columns]] = {}
