"""The error of the constraints after a displacement from q_0 to q_1, as a bias of the solve in q_0.

For holonomic rows it is phi(q_1, t_1). Most directions rotate with the parent, so errors are rotated back with
it. Rows without phi, a(q, t) v = b, must hold for the displacement xi from q_0 to q_1, in the mean of both
ends:

    1/2 (a(q_0) + a(q_1)) xi = h/2 (b_0 + b_1),

xi = (x_1 - x_0, rotation vector of Q_1 Q_0^-1). The reverse step has -xi, so the step is symmetric.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.elements import velocity_error
from carom.dynamics.explicit import copy_state
from carom.dynamics.project import largest_position_error
from carom.geometry.rotation import conjugate, log, multiply, rotate, rotate_back
from carom.kinematics.joints import axis
from carom.model.arrays import KNIFE_EDGE, OWN_ROWS, ROLLING, SLIDING, USER_ROWS
from carom.model.parts_of_system import has_joints


@unit(where=has_joints, otherwise=0.0)
def error_of_move(system, start, h, end, work) -> float:
    """Write minus the errors at the end, in axes of the start, as biases of elements; return the largest.

    The time of the start is `result.time`.
    """
    t, ready = work.result[0].time, False
    work.result[0].time = t + h
    error = largest_position_error(system, end, work)
    work.result[0].time = t
    for j in range(system.joints.shape[0]):
        joint, bias = system.joints[j], work.joint[j].bias
        if joint.kind < OWN_ROWS and joint.kind != KNIFE_EDGE and joint.parent >= 0:
            p, q = start[joint.parent].Q, end[joint.parent].Q
            turn_on(p, q, bias[:3])
            if joint.kind in SLIDING or joint.kind in ROLLING:
                turn_on(p, q, bias[3:])
        if without_position(system, joint):
            if not ready:
                mean_velocities(system, start, h, end, work.mean)
                ready = True
            e = mean_error(system, j, start, h, end, work)
            error = max(error, e / system.bodies[joint.child].extent)
    return error


@kernel
def turn_on(p, q, a):
    """Rotate the vector a with the body from attitude q to attitude p."""
    a[0], a[1], a[2] = rotate(p, rotate_back(q, a))


@kernel
def without_position(system, joint):
    """Return whether an element has rows that restrict velocities only."""
    if joint.kind == USER_ROWS:
        return system.relations.user[joint.number].position_address == 0
    return joint.kind == KNIFE_EDGE or joint.kind in ROLLING


@kernel
def mean_velocities(system, start, h, end, first):
    """Give both ends (`first` is a copy of the start) the velocities xi/h."""
    for b in range(start.shape[0]):
        if system.bodies[b].ballistic == 1:
            continue
        p, q = start[b].Q, end[b].Q
        a = log(multiply(q, conjugate(p)))
        copy_state(start[b], first[b])
        for k in range(3):
            end[b].v[k], end[b].w[k] = (end[b].x[k] - start[b].x[k]) / h, a[k] / h
            first[b].v[k], first[b].w[k] = end[b].v[k], end[b].w[k]


@kernel
def mean_error(system, j, start, h, end, work):
    """Add to the bias of an element minus the mean error of its velocity, times h; return its size.

    For rolling it is the part along the plane, in axes of the parent; for a blade, that along its lateral
    direction.
    """
    joint, record = system.joints[j], work.joint[j]
    bias, target, t = record.bias, record.target, work.result[0].time
    for k in range(6):
        target[k] = bias[k]
    most = 0.0
    for side in range(2):
        state = end if side == 1 else work.mean
        work.result[0].time = t + h if side == 1 else t
        velocity_error(system, j, state, work)
        if joint.kind < OWN_ROWS:
            along_rows(joint, start, state, bias)
        for k in range(6):
            target[k] -= 0.5 * h * bias[k]
    work.result[0].time = t
    for k in range(6):
        bias[k] = target[k]
        most = max(most, abs(bias[k]))
    return most


@kernel
def along_rows(joint, start, state, bias):
    """Keep the part of a relative velocity that rows without position restrict, in axes of the start."""
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
