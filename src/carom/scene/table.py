"""Tables of columns that have rows."""

from __future__ import annotations

import copy
import operator
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Generic, Self, TypeVar, overload

import numpy as np

from carom import checks
from carom.arguments import attributes
from carom.scene.shown import Shown

Row = TypeVar("Row")


@attributes()
class Table(Shown, Generic[Row]):
    """Base class of tables whose columns are arrays: ``len`` is the number of rows, ``table[k]`` is row k.

    ``table[3:9]`` is a table of these rows.
    """

    _a_row = "row"  # what a row is called in messages

    def __len__(self) -> int:
        return len(next(iter(self._columns().values())))

    @overload
    def __getitem__(self, k: int) -> Row: ...
    @overload
    def __getitem__(self, k: slice) -> Self: ...
    def __getitem__(self, k):
        if isinstance(k, slice):
            part = copy.copy(self)
            vars(part).update({name: column[k] for name, column in self._columns().items()})
            return part
        try:
            k = operator.index(k)
        except TypeError:
            raise TypeError(
                f"{self._a_row}s are found by number, from 0, or by a slice, got {checks.shown(k)}; "
                "columns are attributes"
            ) from None
        if not -len(self) <= k < len(self):
            raise IndexError(
                f"there is no {self._a_row} {k}: the table has {len(self)}, numbered from 0"
            )
        return self._row(k)

    def __iter__(self) -> Iterator[Row]:
        return (self._row(k) for k in range(len(self)))

    def _row(self, k: int) -> Any:
        return {name: plain(column[k]) for name, column in self._columns().items()}

    def __repr__(self) -> str:
        rows = [
            "  "
            + "  ".join(f"{name} = {_brief(value)}" for name, value in Table._row(self, k).items())
            for k in range(min(len(self), 8))
        ]
        more = [f"  ... {len(self) - 8} more"] if len(self) > 8 else []
        return "\n".join([f"<{type(self).__name__}: {len(self)} rows", *rows, *more]) + ">"

    def _columns(self) -> dict[str, np.ndarray]:
        return {name: one for name, one in vars(self).items() if isinstance(one, np.ndarray)}


class RecordTable(Table[Row]):
    """Base class of tables whose columns have the names of the fields of `_record`, of which a row is one."""

    _record: type

    def __init_subclass__(cls):
        cls.__annotations__ = dict.fromkeys(cls._record._fields, np.ndarray)

    def __init__(self, **columns: np.ndarray):
        assert columns.keys() == set(self._record._fields)
        vars(self).update({name: columns[name] for name in self._record._fields})

    def __setattr__(self, name: str, value) -> None:
        raise AttributeError(f"cannot assign to column {name!r}")

    def _row(self, k: int) -> Row:
        return self._record(**super()._row(k))

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> np.ndarray: ...


def plain(value):
    """Return a number of NumPy as one of Python, other values unchanged."""
    return value.item() if isinstance(value, np.generic) else value


def _brief(value) -> str:
    if isinstance(value, float):
        return f"{value:.9g}"
    return np.array2string(value, precision=6) if isinstance(value, np.ndarray) else str(value)
