"""Compiled code for the arguments of one run, whose types are looked at once.

`carom._compiled.decorators.address` goes through all arguments at each call: some 600 arrays and numbers for
the units of a die. Numba does the same each time an entry is called: 25 microseconds, of which 2 are the call.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from carom._compiled.decorators import address

_FLAGS = 0x1 | 0x2 | 0x100 | 0x400  # of an array: C order, Fortran order, aligned, writeable
_KINDS: dict[tuple, object] = {}  # something of its own for each: quicker to compare
_UNITS: dict[tuple, int] = {}
_ENTRIES: dict[tuple, Callable] = {}


def kind(value):
    """Return a key that values of one Numba type have in common."""
    if isinstance(value, tuple):
        return (type(value), *map(kind, value))
    if isinstance(value, np.ndarray):
        return value.dtype, value.ndim, value.flags.num & _FLAGS
    return type(value)


class Addresses:
    """Finds code for arguments that are made of these parts, of numbers, and of scratch and records.

    Scratch and records are named tuples of arrays that `carom` makes, of the same types in every run.
    """

    def __init__(self, *parts):
        self.__setstate__(kind(parts))

    def __getstate__(self) -> tuple:
        return self._kinds

    def __setstate__(self, kinds: tuple) -> None:
        self._kinds = kinds
        self._kind = _KINDS.setdefault(kinds, object())

    def __call__(self, unit, *arguments) -> int:
        """Return the address of a unit, compiled if need be; 0 without the JIT."""
        key = (unit, self._kind, *map(type, arguments))
        if key not in _UNITS:
            _UNITS[key] = address(unit, *arguments)
        return _UNITS[key]

    def entry(self, function, *arguments) -> Callable:
        """Return the compiled form of an entry, which takes its arguments without looking at their types."""
        key = (function, self._kind, *map(type, arguments))
        if key not in _ENTRIES:
            jitted = hasattr(function, "typeof_pyval")  # not with NUMBA_DISABLE_JIT=1
            types = tuple(map(function.typeof_pyval, arguments)) if jitted else ()
            _ENTRIES[key] = function.compile(types) if jitted else function
        return _ENTRIES[key]
