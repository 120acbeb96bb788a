"""Dry friction along coordinates of joints: |F| <= bound, opposite to the motion.

Within a step each coordinate is in one mode. In slip in the direction d the force is -bound d. In stick the
force keeps q'' = 0; the forces of all sticking coordinates are found together,

    (J P J^T) F = -q''_free.

If a motor moves the coordinate, friction cannot stop it: J P J^T is round-off of J M^-1 J^T. Stick then ends as
soon as the coordinate moves or starts to move; for this, the force is set beyond its bound.

A mode ends when d q' or bound - |F| crosses zero; the loop locates this instant as for an impact
(`carom.persistent.joint_events`).
"""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.dynamics.contact_impulse import clear_wrenches, gain
from carom.dynamics.forces import applied_wrenches
from carom.dynamics.several_points import factor, substitute
from carom.dynamics.solve import free_body, solve
from carom.kinematics.coordinate import drift, motion_along, push, rate, speeds_of

DEPENDENT = 1e-10  # of a diagonal: a coordinate that sticks already by others takes no force
ROUND_OFF = 1e-13  # of J M^-1 J^T: below, joints and motors leave the coordinate no freedom
STILL = 1e-12  # of the speeds of both sides: a smaller rate is zero
BEYOND = 2.0  # times its bound: the force on a coordinate that cannot stick


@kernel
def any_sticks(relations):
    """Return whether any coordinate sticks."""
    for i in range(relations.frictions.shape[0]):
        if relations.frictions[i].mode == 0:
            return True
    return False


@kernel
def push_all(system, state, work):
    """Add the wrenches of all friction forces; return their power."""
    relations, power = system.relations, 0.0
    for i in range(relations.frictions.shape[0]):
        one = relations.frictions[i]
        c = relations.coordinates[one.coordinate]
        push(c, state, one.force, work)
        power += one.force * rate(c, state)
    return power


@kernel
def stick(system, state, x, work):
    """Solve (J P J^T) F = x for the sticking coordinates: x becomes F, and 0 for the others.

    Dependent coordinates are left out; those that joints and motors determine are marked as `driven`.
    """
    relations = system.relations
    count, W = relations.frictions.shape[0], relations.friction_matrix
    for j in range(count):
        sticks, own = relations.frictions[j].mode == 0, 0.0
        if sticks:
            c = relations.coordinates[relations.frictions[j].coordinate]
            clear_wrenches(work)
            push(c, state, 1.0, work)
            for b in range(state.shape[0]):
                free_body(system.bodies[b], state[b].Q, work.body[b])
            own = motion_along(c, state, work)
            solve(system, state, False, work)
        else:
            x[j] = 0.0
        for i in range(count):
            W[i, j] = 1.0 if i == j else 0.0
            if sticks and relations.frictions[i].mode == 0:
                c = relations.coordinates[relations.frictions[i].coordinate]
                W[i, j] = motion_along(c, state, work)
        relations.frictions[j].driven = 1 if sticks and not W[j, j] > ROUND_OFF * own else 0
        if relations.frictions[j].driven == 1:
            W[j, j] = 0.0
    factor(count, DEPENDENT, W)
    substitute(count, W, x)


@kernel
def drive(system, one, state):
    """Set the force of a driven coordinate beyond its bound, if the coordinate moves or starts to move."""
    c = system.relations.coordinates[one.coordinate]
    speed = rate(c, state)
    still = abs(speed) <= STILL * speeds_of(system, c, state)
    towards = one.change if still else speed
    one.force = 0.0
    if towards != 0.0:
        one.force = -BEYOND * one.bound if towards > 0.0 else BEYOND * one.bound


@unit
def _joint_friction(system, state, work) -> float:
    """Add the wrenches of friction in joints; return their power.

    The wrenches of all other forces, and the bias of the joints, must be written before.
    """
    relations = system.relations
    if relations.frictions.shape[0] == 0:
        return 0.0
    for i in range(relations.frictions.shape[0]):
        one = relations.frictions[i]
        one.force = -one.bound * one.mode
    if any_sticks(relations):
        push_all(system, state, work)
        solve(system, state, True, work)
        x = relations.friction_vector
        for i in range(relations.frictions.shape[0]):
            c = relations.coordinates[relations.frictions[i].coordinate]
            x[i] = -motion_along(c, state, work) - drift(c, state, relations.write)
            relations.frictions[i].change = -x[i]
        stick(system, state, x, work)
        for i in range(relations.frictions.shape[0]):
            if relations.frictions[i].mode == 0:
                relations.frictions[i].force = x[i]
            if relations.frictions[i].driven == 1:
                drive(system, relations.frictions[i], state)
        applied_wrenches(system, state, True, work)
    return push_all(system, state, work)


@unit
def _stay_stuck(system, state, work):
    """Remove the rates of sticking coordinates from a state, in the kinetic metric."""
    relations = system.relations
    if not any_sticks(relations):
        return
    x = relations.friction_vector
    for i in range(relations.frictions.shape[0]):
        x[i] = -rate(relations.coordinates[relations.frictions[i].coordinate], state)
    stick(system, state, x, work)
    clear_wrenches(work)
    for i in range(relations.frictions.shape[0]):
        push(relations.coordinates[relations.frictions[i].coordinate], state, x[i], work)
    solve(system, state, False, work)
    for b in range(state.shape[0]):
        gain(work.body[b].motion, state[b])


@unit
def _slip_power(system, state) -> float:
    """Return the power of friction in those joints that slip."""
    relations, power = system.relations, 0.0
    for i in range(relations.frictions.shape[0]):
        one = relations.frictions[i]
        power -= one.bound * one.mode * rate(relations.coordinates[one.coordinate], state)
    return power


@inlined
def slip_power(system, state):
    """Return the power of friction in those joints that slip."""
    if system.relations.there == 1:
        return _slip_power(system, state)
    return 0.0


@inlined
def joint_friction(system, state, work):
    """Add the wrenches of friction in joints; return their power."""
    if system.relations.there == 1:
        return _joint_friction(system, state, work)
    return 0.0


@inlined
def stay_stuck(system, state, work):
    """Remove the rates of sticking coordinates from a state, in the kinetic metric."""
    if system.relations.there == 1:
        _stay_stuck(system, state, work)
