"""All that constrains: joints, then relations of their coordinates and rows of the user's own.

Of each element three errors and their rows are asked. A joint speaks of the relative motion of its two sides,
six numbers (`carom.kinematics.joints`); the others write one number a row.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
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
from carom.kinematics.rows import inverse_inertias, joint_rows, joint_target
from carom.model.arrays import RELATION, STIFF, USER_ROWS
from carom.model.choice import only_with_relations


@kernel
def _joint_position(system, j, state, work):
    """Write the error of position of a joint to its bias."""
    joints.position_error(system.joints[j], state, work.joint[j].bias)


@kernel
def _position(system, j, state, work):
    """Write the error of position of an element to its bias."""
    joint, bias, t = system.joints[j], work.joint[j].bias, work.result[0].time
    if joint.kind < RELATION:
        joints.position_error(joint, state, bias)
    elif joint.kind == USER_ROWS:
        user_error(system, j, state, t, bias)
    else:
        for k in range(6):
            bias[k] = 0.0
        if joint.kind == STIFF:
            return
        bias[0] = relation_error(system, system.relations.relations[joint.number], state, t)


@kernel
def _joint_velocity(system, j, state, work):
    """Write the relative velocity of a joint to its bias."""
    joints.velocity_error(system.joints[j], state, work.joint[j].bias)


@kernel
def _velocity(system, j, state, work):
    """Write the error of velocity of an element to its bias."""
    joint, bias, t = system.joints[j], work.joint[j].bias, work.result[0].time
    if joint.kind < RELATION:
        joints.velocity_error(joint, state, bias)
        return
    for k in range(6):
        bias[k] = 0.0
    if joint.kind == USER_ROWS:
        write_speeds(system, j, state, t, 0.0, bias)
    elif joint.kind == RELATION:
        bias[0] = relation_speed(system, system.relations.relations[joint.number], state, t)


@kernel
def _joint_acceleration(system, j, state, work):
    """Write the bias of the relative acceleration of a joint."""
    joints.acceleration_bias(system.joints[j], state, work.joint[j].bias)


@kernel
def _acceleration(system, j, state, work):
    """Write what the rows of an element ask of the accelerations."""
    joint, record, t = system.joints[j], work.joint[j], work.result[0].time
    if joint.kind < RELATION:
        joints.acceleration_bias(joint, state, record.bias)
    elif joint.kind == USER_ROWS:
        user_bias(system, j, state, t, record.bias, record.target)
    elif joint.kind == STIFF:
        record.bias[0] = 0.0
    else:
        relation = system.relations.relations[joint.number]
        record.bias[0] = relation_bias(system, relation, state, t, record.target)


@kernel
def _joint_target(system, j, state, relative, out):
    """Write what each row of a joint says of a relative motion."""
    joint_target(system.joints[j], state, relative, out)


@kernel
def _target(system, j, state, relative, out):
    """Write what each row of an element says of its errors."""
    if system.joints[j].kind < RELATION:
        joint_target(system.joints[j], state, relative, out)
        return
    for r in range(system.joints[j].rows):
        out[r] = relative[r]


@kernel
def _build_joints(system, state, work):
    """Write A and A M^-1 of all joints into the solver's arrays."""
    inverse_inertias(system, state, work)
    for j in range(system.joints.shape[0]):
        joint_rows(system, j, state, work)


@kernel
def _build_all(system, state, work):
    """Write A and A M^-1 of all elements into the solver's arrays."""
    inverse_inertias(system, state, work)
    for j in range(system.joints.shape[0]):
        kind = system.joints[j].kind
        if kind < RELATION:
            joint_rows(system, j, state, work)
        elif kind == USER_ROWS:
            user_rows(system, j, state, work.result[0].time, work)
        elif kind == STIFF:
            stiff_rows(system, j, state, work)
        else:
            relation_rows(system, j, state, work)


@kernel
def _prescribed_speeds(system, j, state, work, out):
    """Write b of the rows a v = b of an element."""
    joint, t = system.joints[j], work.result[0].time
    for k in range(6):
        out[k] = 0.0
    if joint.kind == USER_ROWS:
        user_speeds(system, j, state, t, out)
    elif joint.kind == RELATION:
        out[0] = prescribed(system.relations, system.relations.relations[joint.number], t)[1]


@kernel
def _no_speeds(system, j, state, work, out):
    """Joints prescribe none."""
    for k in range(6):
        out[k] = 0.0


@kernel
def _driven_power(system, state, work):
    """Return the power of what is prescribed, multiplier times b, of the last solve of accelerations."""
    power = 0.0
    for j in range(system.joints.shape[0]):
        if system.joints[j].kind >= RELATION:
            record = work.joint[j]
            _prescribed_speeds(system, j, state, work, record.target)
            for r in range(system.joints[j].rows):
                power += record.reaction[r] * record.target[r]
    return power


@kernel
def _none_driven(system, state, work):
    """Joints take no energy and give none."""
    return 0.0


@kernel
def _push_other(system, j, state, multiplier, work):
    """Add A^T multiplier of an element that is no joint to the wrenches."""
    joint, t = system.joints[j], work.result[0].time
    if joint.kind == USER_ROWS:
        push_user_rows(system, j, state, t, multiplier, work)
    elif joint.kind == RELATION:
        relation = system.relations.relations[joint.number]
        push_relation(system, relation, state, multiplier[0], work)


@kernel
def _push_none(system, j, state, multiplier, work):
    """There are joints only."""


position_error = only_with_relations(_position, _joint_position)
velocity_error = only_with_relations(_velocity, _joint_velocity)
acceleration_bias = only_with_relations(_acceleration, _joint_acceleration)
row_target = only_with_relations(_target, _joint_target)
build_rows = only_with_relations(_build_all, _build_joints)
driven_power = only_with_relations(_driven_power, _none_driven)
prescribed_speeds = only_with_relations(_prescribed_speeds, _no_speeds)
push_other = only_with_relations(_push_other, _push_none)
