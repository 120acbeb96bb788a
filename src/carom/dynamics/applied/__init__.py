"""The kinds of forces on bodies, one file for each, of the name of its table (`carom.scene.forces`).

A kind defines

- `count(system)`, how many there are: the rows of its table in `system.forces`;
- `add(system, i, state, power, work)`: it adds its wrenches, and returns `power` with the power of its part
  without potential, then its value along a coordinate or a line, the length of the line and its rate, NaN for
  what it does not have;
- `acts_at(system, i, state)`: the arm, from the centre of its first body, to the point where it acts;
- `energy(system, i, state, t)`, if it has a potential;
- `unit_force(system, i, n, state, work)`, if it has a stiffness: it adds the wrenches of its unit force n, and
  returns the coordinate and its rate where it acts along one.

Each step adds all of them; reports (`carom.dynamics.reports`) add one at a time.
"""

from __future__ import annotations

import math
from importlib import import_module

from carom._compiled.by_number import by_number
from carom._compiled.decorators import inlined
from carom.scene.forces import TABLES

_FILES = [import_module(f"{__name__}.{kind.name}") for kind in TABLES]
#: kinds of every scene, and those that are a unit of their own, which only scenes with relations load
BETWEEN_BODIES, OF_RELATIONS = (
    tuple(file for file, kind in zip(_FILES, TABLES) if kind.apart == apart)
    for apart in (False, True)
)


def added(kinds):
    """Return the kernel that adds all forces of some kinds, and their power to that which is given."""
    if not kinds:

        @inlined
        def none(system, state, power, work):
            return power

        return none
    count, add, others = kinds[-1].count, kinds[-1].add, added(kinds[:-1])

    @inlined
    def these(system, state, power, work):
        power = others(system, state, power, work)
        for i in range(count(system)):
            power, _, _, _ = add(system, i, state, power, work)
        return power

    return these


def energies(kinds):
    """Return the kernel that adds the energies of all forces of some kinds to that which is given."""
    kinds = [kind for kind in kinds if hasattr(kind, "energy")]
    if not kinds:

        @inlined
        def none(system, state, t, total):
            return total

        return none
    count, energy, others = kinds[-1].count, kinds[-1].energy, energies(kinds[:-1])

    @inlined
    def these(system, state, t, total):
        total = others(system, state, t, total)
        for i in range(count(system)):
            total += energy(system, i, state, t)
        return total

    return these


def _by_kind(common):
    """Return the kernel that calls the function of this name of a force, by the number of its kind."""
    own = [getattr(file, common.__name__, None) for file in _FILES]
    return by_number("kind", common, own)


@_by_kind
def add(kind, system, i, state, power, work):
    """Add the wrenches of force i of a kind; return as the kinds do."""
    return power, math.nan, math.nan, math.nan


@_by_kind
def acts_at(kind, system, i, state):
    """Return the arm to where force i of a kind acts."""
    return 0.0, 0.0, 0.0


@_by_kind
def unit_force(kind, system, i, n, state, work):
    """Add unit force n of force i of a kind; return the coordinate and its rate, if it is along one."""
    return 0.0, 0.0
