"""Fields of frozen records: each checks the value that it is given, and keeps it read-only.

In a frozen dataclass a field stands where a default would stand, ``mass: Number = number(above=0)``. Messages
call it by its name.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, Generic, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from carom import checks

Kept = TypeVar("Kept")
Given = TypeVar("Given")
REQUIRED: Any = object()


class Value(Generic[Kept, Given]):
    """A field that keeps what ``check(name, value)`` returns; if its default is None, it also takes None."""

    def __init__(self, check: Callable[[str, Any], Any], default: Any = REQUIRED):
        self.check, self.default = check, default

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, record: Any, owner: type | None = None) -> Kept:
        if record is not None:
            return record.__dict__[self.name]
        if self.default is REQUIRED:  # so a dataclass learns that it has none
            raise AttributeError(self.name)
        return self.default

    def __set__(self, record: Any, value: Given) -> None:
        missing = value is None and self.default is None
        keep(record, **{self.name: None if missing else self.check(self.name, value)})


def keep(record, **fields) -> None:
    """Set `fields` of a frozen `record` without a check; arrays become read-only."""
    for name, value in fields.items():
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
        vars(record)[name] = value


Number: TypeAlias = Value[float, float]
NumberOrNone: TypeAlias = Value[float | None, float | None]
Integer: TypeAlias = Value[int, int]
Flag: TypeAlias = Value[bool, bool]
Word: TypeAlias = Value[str, str]
Vector: TypeAlias = Value[np.ndarray, ArrayLike]
VectorOrNone: TypeAlias = Value[np.ndarray | None, ArrayLike | None]
Function: TypeAlias = Value[Callable, Callable]
FunctionOrNone: TypeAlias = Value[Callable | None, Callable | None]


def number(default: Any = REQUIRED, **bounds) -> Value[Any, Any]:
    """Return a field for a number within the bounds of `checks.number`."""
    return Value(partial(checks.number, **bounds), default)


def length(default: Any = REQUIRED, *, zero: bool = False) -> Number:
    """Return a field for a length [m]."""
    return Value(partial(checks.length, zero=zero), default)


def integer(default: Any = REQUIRED, **bounds) -> Integer:
    """Return a field for a whole number within the bounds of `checks.integer`."""
    return Value(partial(checks.integer, **bounds), default)


def flag(default: Any = REQUIRED) -> Flag:
    """Return a field for True or False."""
    return Value(checks.flag, default)


def word(allowed: Iterable[str], default: Any = REQUIRED) -> Word:
    """Return a field for one of some words."""
    return Value(lambda name, value: checks.choice(name, value, allowed), default)


def vector(default: Any = REQUIRED, unit: str = "") -> Value[Any, Any]:
    """Return a field for a point or vector (3,)."""
    return Value(lambda name, value: checks.finite_array(name, value, (3,), unit), default)


def direction(default: Any = REQUIRED) -> Vector:
    """Return a field for a direction (3,), which is normalised."""
    return Value(checks.unit_vector, default)


def function(default: Any = REQUIRED) -> Value[Any, Any]:
    """Return a field for a function."""
    return Value(checks.function, default)
