"""Dry friction along coordinates of joints: |F| <= bound, against the motion where there is any.

Within a step each is in one mode. Slipping in the direction d its force is -bound d; sticking it is what keeps
q'' = 0, found for all that stick at once,

    (J P J^T) F = -q''_free.

A mode ends where d q' or bound - |F| crosses zero; the loop locates that instant as it does an impact
(`carom.hold.joint_events`).
"""

from __future__ import annotations

from carom.dispatch import only_with_coordinates
from carom.jit import kernel
from carom.motion.contact_point import clear_wrenches, gain
from carom.motion.coordinate import drift, motion_along, push, rate
from carom.motion.forces import applied_wrenches
from carom.motion.several import factor, substitute
from carom.motion.solve import solve

DEPENDENT = 1e-10  # of a diagonal: what sticks already through others takes no force


@kernel
def any_sticks(relations):
    """Return whether one sticks."""
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
    """Solve (J P J^T) F = x over those that stick: x becomes F, 0 of the others.

    Dependent ones are left out.
    """
    relations = system.relations
    count, W = relations.frictions.shape[0], relations.friction_matrix
    for j in range(count):
        sticks = relations.frictions[j].mode == 0
        if sticks:
            clear_wrenches(work)
            push(relations.coordinates[relations.frictions[j].coordinate], state, 1.0, work)
            solve(system, state, False, work)
        else:
            x[j] = 0.0
        for i in range(count):
            W[i, j] = 1.0 if i == j else 0.0
            if sticks and relations.frictions[i].mode == 0:
                c = relations.coordinates[relations.frictions[i].coordinate]
                W[i, j] = motion_along(c, state, work)
    factor(count, DEPENDENT, W)
    substitute(count, W, x)


@kernel
def _joint_friction(system, state, work):
    """Add the wrenches of friction in joints; return their power.

    The wrenches of all other forces, and the bias of the joints, are in place.
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
        stick(system, state, x, work)
        for i in range(relations.frictions.shape[0]):
            if relations.frictions[i].mode == 0:
                relations.frictions[i].force = x[i]
        applied_wrenches(system, state, True, work)
    return push_all(system, state, work)


@kernel
def _no_friction(system, state, work):
    """There is none."""
    return 0.0


@kernel
def _stay_stuck(system, state, work):
    """Take the speeds of those that stick out of a state, in the kinetic metric."""
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


@kernel
def _none_stuck(system, state, work):
    """There is none."""


joint_friction = only_with_coordinates(_joint_friction, _no_friction)
stay_stuck = only_with_coordinates(_stay_stuck, _none_stuck)
