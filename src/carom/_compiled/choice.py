"""Functions that are chosen by a type, once, when the caller is compiled.

Uncompiled, the same choice is made at each call.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from numba.extending import overload

from carom._compiled.decorators import OPTIONS


def by_method(table: Mapping[type, Callable]) -> Callable:
    """Return a function whose first argument is a method, or another record of one of several classes.

    `table` has an implementation for each class.
    """

    def choose(method, *arguments):
        return table[type(method)](method, *arguments)

    def chosen(method, *arguments):
        implementation = table[method.instance_class]
        return lambda method, *arguments: implementation(method, *arguments)

    return _overloaded(choose, chosen, *table.values())


def _overloaded(choose: Any, chosen: Callable, *parts: Callable) -> Callable:
    """Let compiled code call what `chosen` returns; `parts` are what that may be."""
    options: Any = OPTIONS
    overload(choose, **options)(chosen)
    choose.parts = parts
    return choose
