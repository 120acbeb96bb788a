"""Reactions and errors of joints at a given state, for reports: not part of the step loop."""

from __future__ import annotations

import numpy as np

from carom._compiled.decorators import entry, kernel
from carom._compiled.units import unit
from carom.dynamics import thresholds as limits
from carom.dynamics.contact_impulse import clear_wrenches
from carom.dynamics.element_operations import (
    acceleration_bias,
    build_rows,
    position_error,
    prescribed_speeds,
    report_wrench,
    row_target,
    velocity_error,
    write_reaction,
)
from carom.dynamics.elements.relation import prescribed
from carom.dynamics.elements.stiff import add_stiff
from carom.dynamics.forces import applied_wrenches
from carom.dynamics.light_bodies import factor_geometry, geometric_motion
from carom.dynamics.loops import (
    add_reactions,
    dropped_rows,
    factor,
    free_motion,
    substitute,
    subtract_rows,
)
from carom.dynamics.solve import solve
from carom.dynamics.tree import joint_wrenches
from carom.kinematics.combination import is_combination
from carom.kinematics.coordinate import rate, value
from carom.kinematics.coordinates.turns import turn_of
from carom.kinematics.curve import is_on_curve, seek_feet, seek_foot
from carom.model.arrays import FOREST, LOOPS, RELATION
from carom.model.parts_of_system import has_turns

LEAST_NORM_PASSES = 100  # at most


@kernel
def least_norm(system, augment, state, work):
    """Write the reactions of least norm, by passes from zero, with S = A M^-1 A^T of the rows.

    S lam = r, r = target - A M^-1 wrench. Each pass adds P S P times the residual, P = (S + eps)^-1, which
    leaves 1 - (s/(s + eps))^2 of an error along an eigenvector of S with the eigenvalue s. The sum stays in the
    range of P S and so converges to the solution of least norm, with rows weighted by eps; what round-off has
    put into a residual that no multipliers can take away is not seen. Heavy bodies on long arms have small
    eigenvalues, and eps is less. If masses differ much, the same is done with A D^-1 A^T
    (`carom.dynamics.light_bodies`) for A^T lam = A^T mu, with the multipliers mu that were found.
    """
    augment = min(augment, limits.LEAST_NORM_WEIGHT)
    if system.solver.scaled.shape[0] > 0:
        push_multipliers(system, work)
        factor_geometry(system, state, augment, work)
    else:
        factor(system, state, augment, work)
    for j in range(system.joints.shape[0]):
        for k in range(6):
            work.joint[j].multiplier[k] = 0.0
    for _ in range(LEAST_NORM_PASSES):
        write_residual(system, state, work)
        substitute(system)
        respond(system, work)
        substitute(system)
        changes, total = 0.0, 0.0
        for j in range(system.joints.shape[0]):
            multiplier, rhs = work.joint[j].multiplier, system.solver.rows[j].rhs
            for r in range(system.joints[j].rows):
                multiplier[r] -= rhs[r]
                changes += system.solver.rows[j].weight[r] * rhs[r] * rhs[r]
                total += system.solver.rows[j].weight[r] * multiplier[r] * multiplier[r]
        if not changes > limits.REACTION_ERROR * limits.REACTION_ERROR * total:
            break
    for j in range(system.joints.shape[0]):
        record = work.joint[j]
        write_reaction(system.joints[j], state, record.multiplier, record.reaction)


@kernel
def write_residual(system, state, work):
    """Write target - A M^-1 (wrench + A^T multipliers) into the right-hand sides; compliances yield."""
    spread = system.solver.scaled.shape[0] > 0
    if spread:
        geometric_motion(system, work)
    else:
        free_motion(system, work)
    for j in range(system.joints.shape[0]):
        for k in range(6):
            system.solver.rows[j].rhs[k] = work.joint[j].multiplier[k]
    add_reactions(system, work)
    for j in range(system.joints.shape[0]):
        record, rhs = work.joint[j], system.solver.rows[j].rhs
        for k in range(6):
            rhs[k] = 0.0
        if not spread:
            row_target(system, j, state, record.bias, rhs)
            for r in range(system.joints[j].rows):
                rhs[r] -= system.solver.rows[j].compliance[r] * record.multiplier[r]
    subtract_rows(system, work)


@kernel
def respond(system, work):
    """Turn the right-hand sides x into -S x."""
    spread = system.solver.scaled.shape[0] > 0
    for b in range(system.bodies.shape[0]):
        for k in range(6):
            work.body[b].motion[k] = 0.0
    add_reactions(system, work)
    for j in range(system.joints.shape[0]):
        rhs = system.solver.rows[j].rhs
        for r in range(system.joints[j].rows):
            rhs[r] *= 0.0 if spread else -system.solver.rows[j].compliance[r]
    subtract_rows(system, work)


@kernel
def push_multipliers(system, work):
    """Write minus the wrench of the multipliers of the last solve on each body into its wrench."""
    clear_wrenches(work)
    for i in range(system.solver.sides.shape[0]):
        side = system.solver.sides[i]
        A, wrench = side.A, work.body[side.body].wrench
        multiplier = system.solver.rows[side.element].rhs
        for r in range(system.joints[side.element].rows):
            for k in range(6):
                wrench[k] -= A[r, k] * multiplier[r]


@kernel
def share(system, augment, state, work):
    """Write the wrenches of all joints; if they are not unique, those of least norm.

    Wrenches and biases must be written before, and the motion solved for: without dependent rows its wrenches
    are the only ones.
    """
    if system.solver.kind == FOREST:
        joint_wrenches(system, work)
    elif system.solver.kind == LOOPS and dropped_rows(system, limits.RANK) > 0:
        least_norm(system, augment, state, work)


@kernel
def add_touch(touch, work):
    """Add force and moment of a contact to its bodies, about their centres, in world axes."""
    wrench = work.body[touch.body].wrench
    for k in range(3):
        wrench[k] += touch.push[k]
        wrench[3 + k] += touch.moment[k]
    if touch.other >= 0:
        wrench = work.body[touch.other].wrench
        for k in range(3):
            wrench[k] -= touch.push[k]
            wrench[3 + k] += touch.other_moment[k]


@kernel
def load_bodies(system, state, work):
    """Write the wrenches of applied forces; those of contacts are to be added (`add_touch`)."""
    applied_wrenches(system, state, True, work)
    add_stiff(system, state, work)


@kernel
def solve_reactions(system, augment, state, work):
    """Write the wrench of each joint on its child into its record, under the wrenches on the bodies."""
    for j in range(system.joints.shape[0]):
        acceleration_bias(system, j, state, work)
    solve(system, state, True, work)
    share(system, augment, state, work)
    for j in range(system.joints.shape[0]):
        report_wrench(system, j, state, work.joint[j].reaction)


@kernel
def expect_turn(system, saved, k, i):
    """Write where coordinate i is expected at saved state k, before its value is known.

    What the run has not counted changes from the state before by the mean of the rates at both times.
    """
    c = system.relations.coordinates[i]
    if i < saved.turn.shape[1]:
        turn_of(system, c).reference = saved.turn[k, i].angle
    elif k == 0:
        turn_of(system, c).reference = c.begin
    else:
        mean = 0.5 * (rate(system, c, saved.state[k - 1]) + rate(system, c, saved.state[k]))
        turn_of(system, c).reference += mean * (saved.series[k].t - saved.series[k - 1].t)


@kernel
def settle_turn(system, saved, k, i):
    """Write the coordinate i at saved state k: the value nearest to where it is expected."""
    c = system.relations.coordinates[i]
    if is_on_curve(c):  # saved states may be far from each other
        seek_foot(system, c, saved.state[k])
    else:
        turn_of(system, c).reference = value(system, c, saved.state[k])


@unit(where=has_turns)
def follow_turns(system, saved, k):
    """Write the coordinates at saved state k, with the whole turns that the run has counted.

    In files of earlier versions, which do not have them, the angle of a motor is the prescribed one.
    """
    relations = system.relations
    for i in range(relations.coordinates.shape[0]):
        if not is_combination(relations.coordinates[i]):
            expect_turn(system, saved, k, i)
    for j in range(system.joints.shape[0] if saved.turn.shape[1] == 0 else 0):
        if system.joints[j].kind == RELATION:
            relation = relations.relations[system.joints[j].number]
            if relation.last - relation.first == 1:
                term = relations.terms[relation.first]
                angle = prescribed(relations, relation, saved.series[k].t)[0] / term.factor
                relations.memory.coordinates[term.coordinate].reference = angle
    for i in range(relations.coordinates.shape[0]):
        if not is_combination(relations.coordinates[i]):
            settle_turn(system, saved, k, i)


@entry
def reactions(system, augment, saved, rows, work, out):
    """Write the wrench (T, J, 6) of each joint on its child at the saved states `rows[0]` to `rows[1]`.

    Of the records `saved` these are series, state and touch. Earlier states must have been treated before,
    because whole turns of angles are counted; touches begin with the first of these states.
    """
    h, touch = 0, saved.touch
    for k in range(rows[0], rows[1]):
        state, work.moment[0].time = saved.state[k], saved.series[k].t
        follow_turns(system, saved, k)
        load_bodies(system, state, work)
        while h < touch.shape[0] and touch[h].saved == k:
            add_touch(touch[h], work)
            h += 1
        solve_reactions(system, augment, state, work)
        for j in range(system.joints.shape[0]):
            for i in range(6):
                out[k, j, i] = work.joint[j].reaction[i]


@entry
def row_errors(system, saved, work, position, velocity):
    """Write the errors of position and velocity of each row of each element at saved states, (T, J, 6) each."""
    for k in range(saved.state.shape[0]):
        work.moment[0].time = saved.series[k].t
        follow_turns(system, saved, k)
        errors_at(system, saved.state[k], work, position[k], velocity[k])


@entry
def saved_turns(system, saved, out):
    """Write the joint angles (T, C) at saved states that relations use, including whole turns."""
    for k in range(saved.state.shape[0]):
        follow_turns(system, saved, k)
        for i in range(system.relations.coordinates.shape[0]):
            out[k, i] = system.relations.memory.coordinates[i].reference


@kernel
def errors_at(system, state, work, position, velocity):
    """Write the errors of position and velocity of each row of each element, (J, 6) each."""
    seek_feet(system, state)
    for j in range(system.joints.shape[0]):
        position_error(system, j, state, work)
        row_target(system, j, state, work.joint[j].bias, position[j])
        velocity_error(system, j, state, work)
        row_target(system, j, state, work.joint[j].bias, velocity[j])


@entry
def start_errors(system, state, work, position, velocity):
    """Write the errors of an initial state as `errors_at` does, for Python."""
    errors_at(system, state, work, position, velocity)


@entry
def write_speeds(system, state, work, out):
    """Write the speeds that each element prescribes, (J, 6)."""
    for j in range(system.joints.shape[0]):
        prescribed_speeds(system, j, state, work, out[j])


def start_speeds(system, state, work) -> np.ndarray:
    """Return the speeds that the elements prescribe, (J, 6)."""
    out = np.zeros((len(system.joints), 6))
    write_speeds(system, state, work, out)
    return out


@entry
def write_rows(system, state, work):
    """Write the rows of all elements into the solver's sides."""
    build_rows(system, state, work)
