"""Tables of columns that have rows."""

from __future__ import annotations

import copy
import operator
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Generic, Self, TypeVar, overload

import numpy as np

from carom import checks
from carom.arguments import attributes
from carom.scene.shown import Shown

Row = TypeVar("Row")


@attributes()
class Table(Shown, Generic[Row]):
    """Base class of tables whose columns are arrays: ``len`` is the number of rows, ``table[k]`` is row k.

    ``table[3:9]`` and ``table[mask]``, with a boolean array of a value for each row, are tables of these rows.
    """

    _a_row = "row"  # what a row is called in messages
    _of = "contact"  # column with the numbers of the parts, by whose names rows are found too
    _numbers: Callable[[], dict[str, int]] | None = None  # of these parts, by name

    def __len__(self) -> int:
        return len(next(iter(self._columns().values())))

    @overload
    def __getitem__(self, k: int) -> Row: ...
    @overload
    def __getitem__(self, k: slice | np.ndarray | list | str) -> Self: ...
    def __getitem__(self, k: Any):
        if isinstance(k, str) and self._numbers is not None:
            k = self._columns()[self._of] == self._number(k)
        if isinstance(k, (slice, list)) or (isinstance(k, np.ndarray) and k.ndim > 0):
            k = k if isinstance(k, slice) else self._checked_rows(np.asarray(k))
            part = copy.copy(self)
            vars(part).update({name: column[k] for name, column in self._columns().items()})
            return part
        try:
            k = operator.index(k)  # pyright: ignore[reportArgumentType]
        except TypeError:
            name = "" if self._numbers is None else f", by the name of a {self._of}"
            raise TypeError(
                f"{self._a_row}s are found by number, from 0, by a slice, by a mask{name}, got "
                f"{checks.shown(k)}; columns are attributes"
            ) from None
        self._check_there(np.array([k]))
        return self._row(k)

    def _number(self, name: str) -> int:
        """Return the number of the part with this name."""
        assert self._numbers is not None
        known = self._numbers()
        if name not in known:
            near = checks.nearest(name, known) or f"; there are {len(set(known.values()))}"
            raise KeyError(f"there is no {self._of} called {checks.shown(name)}{near}")
        return known[name]

    def _checked_rows(self, k: np.ndarray) -> np.ndarray:
        """Return a mask, or numbers of rows; refuse other arrays."""
        if k.dtype == bool and k.shape == (len(self),):
            return k
        if k.ndim != 1 or not (k.dtype.kind in "iu" or k.size == 0):
            raise IndexError(
                f"rows must be a boolean array of shape ({len(self)},), one value for each {self._a_row}, or "
                f"numbers of rows, got {checks.shown(k)}"
            )
        k = k.astype(np.int64)
        self._check_there(k)
        return k

    def _check_there(self, k: np.ndarray) -> None:
        """Refuse numbers of rows that the table does not have."""
        beyond = k[(k < -len(self)) | (k >= len(self))]
        if beyond.size:
            raise IndexError(
                f"there is no {self._a_row} {beyond[0]}: the table has {len(self)}, numbered from 0"
            )

    def _ipython_key_completions_(self) -> list[str]:
        return [] if self._numbers is None else first_names(self._numbers())

    def _by_name(self, numbers: Callable[[], dict[str, int]]) -> Self:
        """Let rows be found by the names of parts too; `numbers()` are those of the parts."""
        vars(self)["_numbers"] = numbers
        return self

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


def first_names(numbers: dict[str, int]) -> list[str]:
    """Return one name of each part, the first, of numbers by name."""
    first: dict[int, str] = {}
    for name, number in numbers.items():
        first.setdefault(number, name)
    return list(first.values())


def plain(value):
    """Return a number of NumPy as one of Python, other values unchanged."""
    return value.item() if isinstance(value, np.generic) else value


def _brief(value) -> str:
    if isinstance(value, float):
        return f"{value:.9g}"
    return np.array2string(value, precision=6) if isinstance(value, np.ndarray) else str(value)
