"""Which parts a system has: the conditions of units that only some scenes need (`carom._compiled.units`)."""

from __future__ import annotations

from carom._compiled.decorators import inlined
from carom.model.arrays import LOOPS, METRIC


@inlined
def has_solids(system):
    """Return whether bodies with shapes may touch each other."""
    return system.solids.shape[0] > 0


@inlined
def has_joints(system):
    """Return whether there are joints, or other rows of constraints."""
    return system.joints.shape[0] > 0


@inlined
def has_loops(system):
    """Return whether the constraints are solved as rows, which closed loops need."""
    return system.solver.kind == LOOPS


@inlined
def has_metric(system):
    """Return whether the bodies stand for coordinates of the user's own."""
    return system.solver.kind == METRIC


@inlined
def has_modes(system):
    """Return whether a body is flexible."""
    return system.flexible.bodies.shape[0] > 0


@inlined
def are_joined(system):
    """Return whether an impulse on a body may move others."""
    return system.joints.shape[0] > 0 or has_metric(system)


@inlined
def has_turns(system):
    """Return whether there are coordinates of joints, whose whole turns a run counts."""
    return system.relations.coordinates.shape[0] > 0


@inlined
def has_relations(system):
    """Return whether there are coordinates of joints with a motor, spring, rotor, stop or the like."""
    return system.relations.there == 1


@inlined
def has_relation_rows(system):
    """Return whether there are such coordinates, and the constraints are solved as rows."""
    return system.relations.there == 1 and system.solver.kind == LOOPS
