"""Inertia along coordinates of joints: I q'^2/2 in the kinetic energy, for a motor's rotor behind a gear.

The inertia causes the force -I q'' along its coordinate. In a forest this is a term on the diagonal of the
elimination, D = S.U + I (`carom.dynamics.tree`); with closed loops it is a row J of the coordinate with a
compliance,

    J a + lam/I = -d,      d = J' v its drift, so that lam = -I q''.

All responses to impulses and all projections contain it in this form. The exception is the computation of
velocities of bodies from their own momenta, M v: there the rotors keep the rate r that they had, and
-I (q' - r) acts as an impulse in the projection that follows.
"""

from __future__ import annotations

from carom._compiled.units import unit
from carom.kinematics.coordinate import motion_along, push, rate
from carom.model.parts_of_system import has_relations


@unit(where=has_relations, otherwise=0.0)
def rotor_energy(system, state) -> float:
    """Return the kinetic energy along coordinates [J]."""
    total = 0.0
    for i in range(system.relations.rotors.shape[0]):
        rotor = system.relations.rotors[i]
        speed = rate(system, system.relations.coordinates[rotor.coordinate], state)
        total += 0.5 * rotor.inertia * speed * speed
    return total


@unit(where=has_relations)
def note_rates(system, state):
    """Store the rates of `state`."""
    for i in range(system.relations.rotors.shape[0]):
        rotor = system.relations.rotors[i]
        c = system.relations.coordinates[rotor.coordinate]
        system.relations.memory.rates[i] = rate(system, c, state)


@unit(where=has_relations)
def add_rates(system, state, work):
    """Add the change by the motions of the last solve to the stored rates."""
    for i in range(system.relations.rotors.shape[0]):
        rotor = system.relations.rotors[i]
        c = system.relations.coordinates[rotor.coordinate]
        system.relations.memory.rates[i] += motion_along(system, c, state, work)


@unit(where=has_relations)
def keep_rates(system, state, work):
    """Add the impulses of rotors that keep their stored rates to the wrenches."""
    for i in range(system.relations.rotors.shape[0]):
        rotor = system.relations.rotors[i]
        c = system.relations.coordinates[rotor.coordinate]
        change = rate(system, c, state) - system.relations.memory.rates[i]
        push(system, c, state, -rotor.inertia * change, work)


@unit(where=has_relations, otherwise=(0.0, 0.0))
def energy_of_change(system, before, after) -> tuple[float, float]:
    """Return a, b of the additional kinetic energy a s^2 + b s of the rates q' + s (q' - q'_before)."""
    a, b = 0.0, 0.0
    for i in range(system.relations.rotors.shape[0]):
        rotor = system.relations.rotors[i]
        c = system.relations.coordinates[rotor.coordinate]
        speed = rate(system, c, after)
        change = speed - rate(system, c, before)
        a += 0.5 * rotor.inertia * change * change
        b += rotor.inertia * speed * change
    return a, b


@unit(where=has_relations, otherwise=0.0)
def work_of_change(system, state, work) -> float:
    """Return the sum of I q'_0 (q' - q'_0); the velocities of q'_0 are in the motions of the bodies."""
    total = 0.0
    for i in range(system.relations.rotors.shape[0]):
        rotor = system.relations.rotors[i]
        c = system.relations.coordinates[rotor.coordinate]
        speed = motion_along(system, c, state, work)
        total += rotor.inertia * speed * (rate(system, c, state) - speed)
    return total
