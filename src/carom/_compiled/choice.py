"""Functions that are chosen by a type, once, when the caller is compiled, or called by address.

Uncompiled, the same choice is made at each call.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from numba.core import types
from numba.extending import intrinsic, overload

from carom._compiled.by_reference import refer_to
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


def by_address(function: Callable) -> Callable:
    """Return a function that calls a unit (see `carom._compiled.decorators.unit`) at the address given first.

    `function` does the same uncompiled.
    """

    def choose(address, *arguments):
        function(*arguments)

    def chosen(address, *arguments):
        return lambda address, *arguments: _call(address, *arguments)

    return _overloaded(choose, chosen)


@intrinsic
def _call(typing, address, *arguments):
    """Call a unit that returns nothing, by Numba's own calling convention."""
    given = arguments[0] if len(arguments) == 1 else arguments  # *arguments come as one tuple
    kinds = tuple(types.unliteral(kind) for kind in given)
    signature = types.none(address, types.StarArgTuple(kinds))

    def generate(context, builder, signature, values):
        pointer, packed = values
        given = [
            refer_to(builder, t, builder.extract_value(packed, i)) for i, t in enumerate(kinds)
        ]
        taken, unpacked = zip(*given)
        function = context.call_conv.get_function_type(types.none, taken)
        pointer = builder.inttoptr(pointer, function.as_pointer())
        context.call_conv.call_function(builder, pointer, types.none, taken, unpacked)
        return context.get_dummy_value()

    return signature, generate


def _overloaded(choose: Any, chosen: Callable, *parts: Callable) -> Callable:
    """Let compiled code call what `chosen` returns; `parts` are what that may be."""
    options: Any = OPTIONS
    overload(choose, **options)(chosen)
    choose.parts = parts
    return choose
