"""The kinds of forces on bodies, one file for each.

A kind defines

- `KIND`, its number (`carom.model.arrays`), and `count(system)`, how many there are;
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

from carom._compiled.decorators import inlined, kernel
from carom.dynamics.applied import bushing, load, push, spring, user_force

#: kinds of every scene, and those that only scenes with relations have, which are a unit of their own
BETWEEN_BODIES, OF_RELATIONS = (spring, load, bushing), (push, user_force)
KINDS = BETWEEN_BODIES + OF_RELATIONS


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


def by_number(name: str, kinds):
    """Return the kernel that calls the function of this name of one of some kinds, by its number."""
    number, own = kinds[-1].KIND, getattr(kinds[-1], name)
    others = by_number(name, kinds[:-1]) if len(kinds) > 1 else None
    if others is None:

        @kernel
        def first(kind, system, i, *more):
            return own(system, i, *more)

        return first

    @kernel
    def these(kind, system, i, *more):
        if kind == number:
            return own(system, i, *more)
        return others(kind, system, i, *more)

    return these


add, acts_at = by_number("add", KINDS), by_number("acts_at", KINDS)
unit_force = by_number("unit_force", [kind for kind in KINDS if hasattr(kind, "unit_force")])
