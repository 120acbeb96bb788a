"""Functions made of functions: compiled if all that they call are. Numba is loaded only when needed."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from typing import Any

MOST_KEPT = 100  # functions for which `once` keeps what was made


def is_compiled(function) -> bool:
    """Return whether Numba has compiled a function."""
    numba = sys.modules.get("numba.core.dispatcher")  # without it nothing is compiled
    return numba is not None and isinstance(function, numba.Dispatcher)


def joined(function, *parts) -> Any:
    """Return `function`, compiled if all the functions that it calls are."""
    if not all(is_compiled(part) for part in parts):
        return function
    from numba import njit

    return njit(function)


def plainly(function) -> Any:
    """Return a function as plain Python: a call of it, and of what it calls, compiles nothing."""
    return _plain(function) if is_compiled(function) else function


def once(make: Callable) -> Callable:
    """Decorate a function that makes something of a user's function: of a compiled one it is made once."""
    kept = functools.lru_cache(maxsize=MOST_KEPT)(make)

    @functools.wraps(make)
    def made(function, *shapes):
        return (kept if is_compiled(function) else make)(function, *shapes)

    return made


@once
def _plain(function):
    try:
        from carom._compiled.snapshot import Snapshot

        return Snapshot(function.py_func, plain=True).function
    except Exception:  # `NotKept`, or another Numba
        return function.py_func
