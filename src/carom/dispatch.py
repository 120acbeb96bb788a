"""Functions that are chosen by a type, once, when the caller is compiled.

A run contains only the back end and the method that it needs; uncompiled, the same choice is made at each call.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from numba.core import types
from numba.extending import intrinsic, overload

from carom.contact.pairs.layout import NoHulls
from carom.jit import OPTIONS
from carom.references import refer_to
from carom.system.arrays import FreeSolver, LoopSolver, Relations, TreeSolver


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


def by_solver(table: Mapping[type, Callable]) -> Callable:
    """Return a function whose first argument is a system; `table` is keyed by the class of its solver."""

    def choose(system, *arguments):
        return table[type(system.solver)](system, *arguments)

    def chosen(system, *arguments):
        solver = system.types[system.fields.index("solver")]
        implementation = table[solver.instance_class]
        return lambda system, *arguments: implementation(system, *arguments)

    return _overloaded(choose, chosen, *table.values())


def by_address(function: Callable) -> Callable:
    """Return a function that calls a unit (`carom.jit.unit`) at the address in its first argument.

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


def only_with_joints(function: Callable, without: Callable) -> Callable:
    """Return `function` for systems with joints and `without` for those without.

    So that a scene of free bodies does not wait for the compiler to go through its joints.
    """
    return by_solver({FreeSolver: without, TreeSolver: function, LoopSolver: function})


def only_with_relations(function: Callable, without: Callable) -> Callable:
    """Return `function` for systems with relations or rows of the user's among their joints."""
    return _by_relations(function, without, (LoopSolver,))


def only_with_coordinates(function: Callable, without: Callable) -> Callable:
    """Return `function` for systems with coordinates of joints, or functions of the user's."""
    return _by_relations(function, without, (LoopSolver, TreeSolver, FreeSolver))


def _by_relations(function, without, solvers):
    def choose(system, *arguments):
        there = type(system.relations) is Relations and type(system.solver) in solvers
        return (function if there else without)(system, *arguments)

    def chosen(system, *arguments):
        relations, solver = (
            system.types[system.fields.index(name)].instance_class
            for name in ("relations", "solver")
        )
        implementation = function if relations is Relations and solver in solvers else without
        return lambda system, *arguments: implementation(system, *arguments)

    return _overloaded(choose, chosen, function, without)


def only_with_pairs(function: Callable, without: Callable) -> Callable:
    """Return `function` for systems in which bodies may touch each other, and `without` for others."""

    def choose(system, *arguments):
        return (without if type(system.hulls) is NoHulls else function)(system, *arguments)

    def chosen(system, *arguments):
        hulls = system.types[system.fields.index("hulls")]
        implementation = without if hulls.instance_class is NoHulls else function
        return lambda system, *arguments: implementation(system, *arguments)

    return _overloaded(choose, chosen, function, without)


def _overloaded(choose: Any, chosen: Callable, *parts: Callable) -> Callable:
    """Let compiled code call what `chosen` returns; `parts` are what that may be."""
    options: Any = OPTIONS
    overload(choose, **options)(chosen)
    choose.parts = parts
    return choose
