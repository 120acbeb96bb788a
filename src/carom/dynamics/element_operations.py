"""The operations of an element of the constraints, whatever its kind: joints, relations, rows of the user's.

Each element has errors of position and velocity, a bias of the acceleration, and rows. They are stated here in
the form of a plain joint, which writes them for the relative motion of its two sides, six numbers
(`carom.kinematics.joints`); a kind with rows of its own has its forms in its file of `carom.dynamics.elements`,
by the same names.
"""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.dynamics.elements import by_element
from carom.dynamics.elements.own_rows import clear
from carom.geometry.rotation import rotate, rotate_back
from carom.kinematics import joints
from carom.kinematics.joints import axis, child_arm, parent_arm
from carom.kinematics.rows import direction, inverse_inertias, joint_rows, joint_target
from carom.kinematics.wrench import add_force
from carom.model.arrays import KNIFE_EDGE, OWN_ROWS, ROLLING, SLIDING
from carom.model.parts_of_system import has_relation_rows


@inlined
def has_own_rows(system, j):
    """Return whether the multipliers of an element are those of its rows, and not a wrench."""
    return system.joints[j].kind >= OWN_ROWS


@by_element
def position_error(system, j, state, work):
    """Write the error of position to the bias of an element."""
    joints.position_error(system.joints[j], state, work.joint[j].bias)


@by_element
def velocity_error(system, j, state, work):
    """Write the error of velocity to the bias of an element."""
    joints.velocity_error(system.joints[j], state, work.joint[j].bias)


@by_element
def acceleration_bias(system, j, state, work):
    """Write the accelerations that an element requires, as its bias."""
    joints.acceleration_bias(system.joints[j], state, work.joint[j].bias)


@by_element
def row_target(system, j, state, relative, out):
    """Write the component of the errors of an element along each of its rows."""
    joint_target(system.joints[j], state, relative, out)


@by_element
def write_rows(system, j, state, work):
    """Write A and A M^-1 of an element into the solver's arrays; inverse inertias are known."""
    joint_rows(system, j, state, work)


@unit
def _write_all(system, state, work):
    """Write the rows of all elements."""
    for j in range(system.joints.shape[0]):
        write_rows(system, j, state, work)


@inlined
def build_rows(system, state, work):
    """Write A and A M^-1 of all elements into the solver's arrays."""
    inverse_inertias(system, state, work)
    if has_relation_rows(system):
        _write_all(system, state, work)
    else:
        for j in range(system.joints.shape[0]):
            joint_rows(system, j, state, work)


@by_element
def prescribed_speeds(system, j, state, work, out):
    """Write b of the rows a v = b of an element (6,)."""
    clear(out)


@unit(where=has_relation_rows, otherwise=0.0)
def driven_power(system, state, work) -> float:
    """Return the power of prescribed motions, multiplier times b, in the last solve of accelerations."""
    power = 0.0
    for j in range(system.joints.shape[0]):
        if has_own_rows(system, j):
            record = work.joint[j]
            prescribed_speeds(system, j, state, work, record.target)
            for r in range(system.joints[j].rows):
                power += record.reaction[r] * record.target[r]
    return power


@by_element
def add_wrenches(system, j, state, multiplier, work):
    """Add A^T multiplier of an element to the wrenches, rows taken at `state`."""
    joint = system.joints[j]
    c, p = joint.child, joint.parent
    cx, cy, cz = child_arm(joint, state)
    px, py, pz = parent_arm(joint, state)
    for r in range(joint.rows):
        d = direction(joint, r, state)
        s = multiplier[r]
        fx, fy, fz = s * d[3], s * d[4], s * d[5]
        add_force(work, c, (cx, cy, cz), (fx, fy, fz))
        add_force(work, p, (px, py, pz), (-fx, -fy, -fz))
        for k in range(3):
            work.body[c].wrench[3 + k] += s * d[k]
            if p >= 0:
                work.body[p].wrench[3 + k] -= s * d[k]


@kernel
def write_reaction(joint, state, multiplier, reaction):
    """Write the wrench on the child at its anchor: sum of multiplier times direction.

    For an element that is not a joint, write the multipliers themselves.
    """
    for k in range(6):
        reaction[k] = multiplier[k] if joint.kind >= OWN_ROWS and k < joint.rows else 0.0
    if joint.kind >= OWN_ROWS:
        return
    for r in range(joint.rows):
        d = direction(joint, r, state)
        for k in range(3):
            reaction[k] += multiplier[r] * d[3 + k]
            reaction[3 + k] += multiplier[r] * d[k]


@by_element
def report_wrench(system, j, state, reaction):
    """Turn the multipliers of an element into what a user reads: those of a joint are a wrench already."""


@by_element
def restricts_velocities_only(system, joint):
    """Return whether some rows restrict velocities alone."""
    return joint.kind == KNIFE_EDGE or joint.kind in ROLLING


@kernel
def turn_on(p, q, a):
    """Rotate the vector a with the body from attitude q to attitude p."""
    a[0], a[1], a[2] = rotate(p, rotate_back(q, a))


@by_element
def turn_back(system, j, start, end, work):
    """Turn the error of position of an element, at the end of a step, back to axes of the start."""
    joint, bias = system.joints[j], work.joint[j].bias
    if joint.kind != KNIFE_EDGE and joint.parent >= 0:
        p, q = start[joint.parent].Q, end[joint.parent].Q
        turn_on(p, q, bias[:3])
        if joint.kind in SLIDING or joint.kind in ROLLING:
            turn_on(p, q, bias[3:])


@by_element
def keep_rows_without_position(system, j, start, state, work):
    """Keep the part of a relative velocity that rows without position restrict, in axes of the start."""
    joint, bias = system.joints[j], work.joint[j].bias
    bias[0], bias[1], bias[2] = 0.0, 0.0, 0.0
    if joint.kind == KNIFE_EDGE:
        ex, ey, ez = axis(state, joint.child, joint.child_frame, 1)
        f = ex * bias[3] + ey * bias[4] + ez * bias[5]
        ex, ey, ez = axis(start, joint.child, joint.child_frame, 1)
        bias[3], bias[4], bias[5] = f * ex, f * ey, f * ez
        return
    nx, ny, nz = axis(state, joint.parent, joint.parent_frame, 0)
    f = nx * bias[3] + ny * bias[4] + nz * bias[5]
    bias[3], bias[4], bias[5] = bias[3] - f * nx, bias[4] - f * ny, bias[5] - f * nz
    if joint.parent >= 0:
        turn_on(start[joint.parent].Q, state[joint.parent].Q, bias[3:])
