"""All constraints: joints, then relations between their coordinates and user-defined rows.

Each element has errors of position and velocity, a bias of the acceleration, and rows. A joint writes them for
the relative motion of its two sides, six numbers (`carom.kinematics.joints`); other elements, and joints on
curves, write one number for each row.
"""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.dynamics.relations import (
    prescribed,
    push_relation,
    relation_bias,
    relation_error,
    relation_rows,
    relation_speed,
)
from carom.dynamics.stiff import stiff_rows
from carom.dynamics.user_rows import (
    push_user_rows,
    user_bias,
    user_error,
    user_rows,
    user_speeds,
    write_speeds,
)
from carom.kinematics import joints
from carom.kinematics.curve import (
    curve_bias,
    curve_error,
    curve_rows,
    curve_speed,
    find_foot,
    force_across,
    push_across,
)
from carom.kinematics.rows import inverse_inertias, joint_rows, joint_target, mass_row
from carom.model.arrays import LOOPS, ON_CURVE, OWN_ROWS, RELATION, STIFF, USER_ROWS
from carom.model.parts_of_system import has_relation_rows


@kernel
def foot(system, joint, state):
    """Return the curve of a joint, with the foot of its point in this state."""
    c = system.relations.coordinates[joint.number]
    find_foot(system, c, state)
    return system.relations.curves[c.number]


@kernel
def rows_on_curve(system, j, state, work):
    """Write A and A M^-1 of a joint on a curve."""
    solver, joint = system.solver, system.joints[j]
    one, first, last = foot(system, joint, state), solver.rows[j].first, solver.rows[j].last
    for s in range(first, last):
        curve_rows(joint, one, state, solver.sides[s])
        for r in range(joint.rows):
            mass_row(system, solver.sides[s], r, work)


@kernel
def force_on_curve(system, joint, state, reaction):
    """Turn the multipliers of a joint on a curve into the wrench on its child at the point."""
    f = force_across(foot(system, joint, state), reaction)
    for k in range(3):
        reaction[k], reaction[3 + k] = f[k], 0.0


@unit
def _position(system, j, state, work):
    """Write the error of position of an element to its bias."""
    joint, bias, t = system.joints[j], work.joint[j].bias, work.result[0].time
    if joint.kind < OWN_ROWS:
        joints.position_error(joint, state, bias)
    elif joint.kind in ON_CURVE:
        curve_error(joint, foot(system, joint, state), bias)
    elif joint.kind == USER_ROWS:
        user_error(system, j, state, t, bias)
    else:
        for k in range(6):
            bias[k] = 0.0
        if joint.kind != RELATION:
            return
        bias[0] = relation_error(system, system.relations.relations[joint.number], state, t)


@unit
def _velocity(system, j, state, work):
    """Write the error of velocity of an element to its bias."""
    joint, bias, t = system.joints[j], work.joint[j].bias, work.result[0].time
    if joint.kind < OWN_ROWS:
        joints.velocity_error(joint, state, bias)
        return
    if joint.kind in ON_CURVE:
        curve_speed(joint, foot(system, joint, state), state, bias)
        return
    for k in range(6):
        bias[k] = 0.0
    if joint.kind == USER_ROWS:
        write_speeds(system, j, state, t, 0.0, bias)
    elif joint.kind == RELATION:
        bias[0] = relation_speed(system, system.relations.relations[joint.number], state, t)


@unit
def _acceleration(system, j, state, work):
    """Write the accelerations that an element requires, as its bias."""
    joint, record, t = system.joints[j], work.joint[j], work.result[0].time
    if joint.kind < OWN_ROWS:
        joints.acceleration_bias(joint, state, record.bias)
    elif joint.kind in ON_CURVE:
        curve_bias(joint, foot(system, joint, state), state, record.bias)
    elif joint.kind == USER_ROWS:
        user_bias(system, j, state, t, record.bias, record.target)
    elif joint.kind == STIFF:
        record.bias[0] = 0.0
    else:  # also an inertia: J a + lam/I = -d, without a prescribed part
        relation = system.relations.relations[joint.number]
        record.bias[0] = relation_bias(system, relation, state, t, record.target)


@unit
def _target(system, j, state, relative, out):
    """Write the component of the errors of an element along each of its rows."""
    if system.joints[j].kind < OWN_ROWS:
        joint_target(system.joints[j], state, relative, out)
        return
    first = 3 if system.joints[j].kind in ON_CURVE else 0  # lengths, and not angles
    for r in range(system.joints[j].rows):
        out[r] = relative[first + r]


@unit
def _build_all(system, state, work):
    """Write A and A M^-1 of all elements into the solver's arrays."""
    inverse_inertias(system, state, work)
    for j in range(system.joints.shape[0]):
        kind = system.joints[j].kind
        if kind < OWN_ROWS:
            joint_rows(system, j, state, work)
        elif kind in ON_CURVE:
            rows_on_curve(system, j, state, work)
        elif kind == USER_ROWS:
            user_rows(system, j, state, work.result[0].time, work)
        elif kind == STIFF:
            stiff_rows(system, j, state, work)
        else:
            relation_rows(system, j, state, work)


@unit
def _prescribed_speeds(system, j, state, work, out):
    """Write b of the rows a v = b of an element."""
    joint, t = system.joints[j], work.result[0].time
    for k in range(6):
        out[k] = 0.0
    if joint.kind == USER_ROWS:
        user_speeds(system, j, state, t, out)
    elif joint.kind == RELATION:
        out[0] = prescribed(system.relations, system.relations.relations[joint.number], t)[1]


@unit(where=has_relation_rows, otherwise=0.0)
def driven_power(system, state, work) -> float:
    """Return the power of prescribed motions, multiplier times b, in the last solve of accelerations."""
    power = 0.0
    for j in range(system.joints.shape[0]):
        if system.joints[j].kind >= OWN_ROWS:
            record = work.joint[j]
            _prescribed_speeds(system, j, state, work, record.target)
            for r in range(system.joints[j].rows):
                power += record.reaction[r] * record.target[r]
    return power


@unit
def _push_other(system, j, state, multiplier, work):
    """Add A^T multiplier of an element that is not a joint to the wrenches."""
    joint, t = system.joints[j], work.result[0].time
    if joint.kind in ON_CURVE:
        push_across(joint, foot(system, joint, state), state, multiplier, work)
    elif joint.kind == USER_ROWS:
        push_user_rows(system, j, state, t, multiplier, work)
    elif joint.kind == RELATION:
        relation = system.relations.relations[joint.number]
        push_relation(system, relation, state, multiplier[0], work)


@inlined
def position_error(system, j, state, work):
    """Write the error of position of an element to its bias."""
    if system.joints[j].kind >= OWN_ROWS:
        _position(system, j, state, work)
    else:
        joints.position_error(system.joints[j], state, work.joint[j].bias)


@inlined
def velocity_error(system, j, state, work):
    """Write the error of velocity of an element to its bias."""
    if system.joints[j].kind >= OWN_ROWS:
        _velocity(system, j, state, work)
    else:
        joints.velocity_error(system.joints[j], state, work.joint[j].bias)


@inlined
def acceleration_bias(system, j, state, work):
    """Write the accelerations that an element requires, as its bias."""
    if system.joints[j].kind >= OWN_ROWS:
        _acceleration(system, j, state, work)
    else:
        joints.acceleration_bias(system.joints[j], state, work.joint[j].bias)


@inlined
def row_target(system, j, state, relative, out):
    """Write the component of the errors of an element along each of its rows."""
    if system.joints[j].kind >= OWN_ROWS:
        _target(system, j, state, relative, out)
    else:
        joint_target(system.joints[j], state, relative, out)


@inlined
def build_rows(system, state, work):
    """Write A and A M^-1 of all elements into the solver's arrays."""
    if system.relations.there == 1 and system.solver.kind == LOOPS:
        _build_all(system, state, work)
    else:
        inverse_inertias(system, state, work)
        for j in range(system.joints.shape[0]):
            joint_rows(system, j, state, work)


@inlined
def prescribed_speeds(system, j, state, work, out):
    """Write b of the rows a v = b of an element."""
    if system.relations.there == 1 and system.solver.kind == LOOPS:
        _prescribed_speeds(system, j, state, work, out)
    else:
        for k in range(6):
            out[k] = 0.0


@inlined
def push_other(system, j, state, multiplier, work):
    """Add A^T multiplier of an element that is not a joint to the wrenches."""
    if system.joints[j].kind >= OWN_ROWS:
        _push_other(system, j, state, multiplier, work)
