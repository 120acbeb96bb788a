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
from carom.dynamics.element_operations import (
    keep_rows_without_position,
    restricts_velocities_only,
    turn_back,
    velocity_error,
)
from carom.dynamics.explicit import copy_state
from carom.dynamics.project import largest_position_error
from carom.geometry.rotation import conjugate, log, multiply
from carom.model.parts_of_system import has_joints


@unit(where=has_joints, otherwise=0.0)
def error_of_move(system, start, h, end, work) -> float:
    """Write minus the errors at the end, in axes of the start, as biases of elements; return the largest.

    The time of the start is `result.time`.
    """
    t, ready = work.moment[0].time, False
    work.moment[0].time = t + h
    error = largest_position_error(system, end, work)
    work.moment[0].time = t
    for j in range(system.joints.shape[0]):
        joint = system.joints[j]
        turn_back(system, j, start, end, work)
        if restricts_velocities_only(system, joint):
            if not ready:
                mean_velocities(system, start, h, end, work.mean)
                ready = True
            e = mean_error(system, j, start, h, end, work)
            error = max(error, e / system.bodies[joint.child].extent)
    return error


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
    record = work.joint[j]
    bias, target, t = record.bias, record.target, work.moment[0].time
    for k in range(6):
        target[k] = bias[k]
    most = 0.0
    for side in range(2):
        state = end if side == 1 else work.mean
        work.moment[0].time = t + h if side == 1 else t
        velocity_error(system, j, state, work)
        keep_rows_without_position(system, j, start, state, work)
        for k in range(6):
            target[k] -= 0.5 * h * bias[k]
    work.moment[0].time = t
    for k in range(6):
        bias[k] = target[k]
        most = max(most, abs(bias[k]))
    return most
