"""Functions made of functions: compiled if all that they call are. Numba is loaded only when needed."""

from __future__ import annotations

from typing import Any


def is_compiled(function) -> bool:
    """Return whether Numba has compiled a function."""
    from numba.core.dispatcher import Dispatcher

    return isinstance(function, Dispatcher)


def joined(function, *parts) -> Any:
    """Return `function`, compiled if all the functions that it calls are."""
    if not all(is_compiled(part) for part in parts):
        return function
    from numba import njit

    return njit(function)
