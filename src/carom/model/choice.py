"""Functions that are chosen by a type, once, when the caller is compiled.

A run contains only the back end and the method that it needs; uncompiled, the same choice is made at each call.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from carom._compiled.choice import _overloaded
from carom.collision.layout import NoHulls
from carom.model.arrays import FreeSolver, LoopSolver, Relations, TreeSolver


def by_solver(table: Mapping[type, Callable]) -> Callable:
    """Return a function whose first argument is a system; `table` is keyed by the class of its solver."""

    def choose(system, *arguments):
        return table[type(system.solver)](system, *arguments)

    def chosen(system, *arguments):
        solver = system.types[system.fields.index("solver")]
        implementation = table[solver.instance_class]
        return lambda system, *arguments: implementation(system, *arguments)

    return _overloaded(choose, chosen, *table.values())


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
