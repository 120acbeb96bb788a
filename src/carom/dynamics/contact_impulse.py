"""A contact point: its velocity, its Delassus operator W = G P G^T, and the effect of an impulse.

G maps the velocities of all bodies to u = (u_n, u_t1, u_t2), the velocity of body a relative to body b at
the point; P is the inverse mass with the joints active. (Paper, change of coordinates at contact.)
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.dynamics.solve import free_body, solve
from carom.kinematics.flexible import push_modes
from carom.kinematics.row_of_coordinate import push_in_row
from carom.kinematics.wrench import add_force
from carom.model.workspace import (
    MOTION_PIVOT,
    MOTION_POINT,
    MOTION_ROLL,
    MOTION_STOP,
    MOTION_THREE,
)


@kernel
def alone(system, point):
    """Return whether an impulse at the point moves its own bodies only."""
    b = point.b
    return system.bodies[point.a].isolated == 1 and (b < 0 or system.bodies[b].isolated == 1)


@kernel
def spread(system, point, state, p, work):
    """Write motion = P G^T p of all bodies, or of those at the point if they have no joints."""
    if not alone(system, point):
        clear_wrenches(work)
        add_impulse(system, point, state, p, work)
        solve(system, state, False, work)
        return
    clear_wrench(work.body[point.a])
    if point.b >= 0:
        clear_wrench(work.body[point.b])
    add_impulse(system, point, state, p, work)
    respond_alone(system, point, state, work)


@kernel
def respond_alone(system, point, state, work):
    """Write the motions of the bodies of a point by their wrenches: they have no joints."""
    free_body(system.bodies[point.a], state[point.a].Q, work.body[point.a])
    if point.b >= 0:
        free_body(system.bodies[point.b], state[point.b].Q, work.body[point.b])


@kernel
def acts(motion, r):
    """Return whether an impulse along row r of a point has an effect: see `add_impulse`."""
    if motion in (MOTION_POINT, MOTION_ROLL):
        return r >= (0 if motion == MOTION_POINT else 1)
    return motion == MOTION_THREE or r == (0 if motion == MOTION_STOP else 1)


@kernel
def add_impulse(system, point, state, p, work):
    """Add G^T p of an impulse p = (p_n, p_t1, p_t2) to the wrenches."""
    E, ln, l1, l2 = point.axes, p[0], p[1], p[2]
    if point.motion > MOTION_PIVOT:
        push_in_row(system, point, state, (ln, l1, l2), work)
        return
    if point.motion != MOTION_POINT:
        i, j = (1, 2) if point.motion == MOTION_ROLL else (0, 2)
        f1, f2 = point.length * l1, point.length * l2 if point.motion == MOTION_ROLL else 0.0
        for k in range(3):
            torque = f1 * E[i, k] + f2 * E[j, k]
            work.body[point.a].wrench[3 + k] += torque
            if point.b >= 0:
                work.body[point.b].wrench[3 + k] -= torque
        return
    fx = E[0, 0] * ln + E[1, 0] * l1 + E[2, 0] * l2
    fy = E[0, 1] * ln + E[1, 1] * l1 + E[2, 1] * l2
    fz = E[0, 2] * ln + E[1, 2] * l1 + E[2, 2] * l2
    add_force(work, point.a, point.arm_a, (fx, fy, fz))
    add_force(work, point.b, point.arm_b, (-fx, -fy, -fz))
    if point.bends == 1:
        push_modes(system, point, state, (fx, fy, fz), work)


@kernel
def clear_wrench(memory):
    """Zero the wrench of one body."""
    for k in range(6):
        memory.wrench[k] = 0.0


@kernel
def clear_wrenches(work):
    """Zero the wrench of each body."""
    for b in range(work.body.shape[0]):
        clear_wrench(work.body[b])


@kernel
def add_velocity(system, point, work, state):
    """Add the motion that `spread` wrote to the velocities."""
    if alone(system, point):
        gain(work.body[point.a].motion, state[point.a])
        if point.b >= 0:
            gain(work.body[point.b].motion, state[point.b])
    else:
        for b in range(state.shape[0]):
            gain(work.body[b].motion, state[b])


@kernel
def gain(motion, body):
    """Add a motion to the velocity of a body."""
    for k in range(3):
        body.v[k] += motion[k]
        body.w[k] += motion[3 + k]
