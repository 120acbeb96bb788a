"""Forces that only scenes with coordinates or functions of the user's have; whole turns of coordinates."""

from __future__ import annotations

from carom._compiled.units import unit
from carom.dynamics.applied import OF_RELATIONS, added, energies
from carom.kinematics.combination import is_combination
from carom.kinematics.coordinate import counts_turns, rate, turn_within, value
from carom.kinematics.coordinates.turns import turn_of
from carom.kinematics.curve import is_beyond, is_on_curve
from carom.kinematics.thresholds import TURN_OF_STEP
from carom.model.parts_of_system import has_relations, has_turns

of_relations, energies_of_relations = added(OF_RELATIONS), energies(OF_RELATIONS)


@unit(where=has_relations, otherwise=0.0)
def add_more_forces(system, state, work) -> float:
    """Add the wrenches of these forces; return the power of those without potential."""
    return of_relations(system, state, 0.0, work)


@unit(where=has_relations, otherwise=0.0)
def more_energy(system, state, t) -> float:
    """Return the potential energy of these forces [J]."""
    return energies_of_relations(system, state, t, 0.0)


@unit(where=has_turns, otherwise=False)
def note_turns(system, state, h) -> bool:
    """Store the whole turns of all angles, after a trial step of length h has been accepted.

    Return whether a point has left its curve.
    """
    left = False
    for i in range(system.relations.coordinates.shape[0]):
        c = system.relations.coordinates[i]
        if is_combination(c):  # the turns are those of its terms
            continue
        if counts_turns(c):  # what nothing depends on may turn far in a step
            turn_of(system, c).reference += h * rate(system, c, state)
        turn_of(system, c).reference = value(system, c, state)
        if is_on_curve(c):
            left = left or is_beyond(
                system.relations.curves[c.number], turn_of(system, c).reference
            )
    return left


@unit(where=has_relations, otherwise=False)
def turns_round(system, start, end, h) -> bool:
    """Return whether an angle may turn so far in a step that its whole turns are not known, or a foot."""
    for i in range(system.relations.coordinates.shape[0]):
        c = system.relations.coordinates[i]
        if is_combination(c):
            continue
        if not turn_within(system, c, start, end, h) <= TURN_OF_STEP:
            return True
    return False
