"""Functions that are chosen by a type, once, when the caller is compiled.

A run contains only the back end and the method that it needs; uncompiled, the same choice is made at each call.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from numba.extending import overload

from carom.jit import OPTIONS
from carom.system.arrays import FreeSolver, LoopSolver, TreeSolver


def by_method(table: Mapping[type, Callable]) -> Callable:
    """Return a function whose first argument is a method; `table` has an implementation for each class."""

    def choose(method, *arguments):
        return table[type(method)](method, *arguments)

    def chosen(method, *arguments):
        implementation = table[method.instance_class]
        return lambda method, *arguments: implementation(method, *arguments)

    return _overloaded(choose, chosen)


def by_solver(table: Mapping[type, Callable]) -> Callable:
    """Return a function whose first argument is a system; `table` is keyed by the class of its solver."""

    def choose(system, *arguments):
        return table[type(system.solver)](system, *arguments)

    def chosen(system, *arguments):
        solver = system.types[system.fields.index("solver")]
        implementation = table[solver.instance_class]
        return lambda system, *arguments: implementation(system, *arguments)

    return _overloaded(choose, chosen)


def only_with_joints(function: Callable, without: Callable) -> Callable:
    """Return `function` for systems with joints and `without` for those without.

    So that a scene of free bodies does not wait for the compiler to go through its joints.
    """
    return by_solver({FreeSolver: without, TreeSolver: function, LoopSolver: function})


def _overloaded(choose: Callable, chosen: Callable) -> Callable:
    options: Any = OPTIONS
    overload(choose, **options)(chosen)
    return choose
