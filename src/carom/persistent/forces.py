"""Forces in one state: the contact problem at the level of accelerations, with the normal forces of springs.

    a = W f + c,    0 <= f_n _|_ a_n >= 0,    Coulomb's law for f_t:

with friction against slip if the point slips, and otherwise against the acceleration of slip, within the cone.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.gap import slow
from carom.dynamics.explicit import copy_state
from carom.friction.layout import CONE, SLIDING
from carom.impact.workspace import ACCELERATIONS, C, P, U
from carom.persistent.coulomb_stage import solve_stage
from carom.persistent.joint_rows import JOINT, mode_of_joint
from carom.persistent.rolling_friction import take_torque
from carom.persistent.rows import accelerate_freely, bodies_of, write_motion
from carom.persistent.settle import greatest
from carom.persistent.springs import note_accelerations


@kernel
def pose_forces(model, data, k, label):
    """Write u, c = du/dt without contact forces, and the direction of slip, of the k points of the group."""
    system, controls, state = model.system, model.controls, data.state
    group, work, last = data.group, data.work, data.work.stages.shape[0] - 1
    for b in range(state.shape[0]):
        copy_state(state[b], work.stage[b])
    count, loaded = bodies_of(model, data, label)
    accelerate_freely(model, data, loaded, count, last)
    write_motion(system, k, state, work.stages[last], group, work)
    push = greatest(3 * k, group.v[C])
    for i in range(k):
        if group.closed[i].turns == JOINT:
            u, still = group.v[U][3 * i + 1], controls.rest * push * controls.step
            way = mode_of_joint(system, group.closed[i].active, u, still, state)
            group.kind[i] = CONE if way == 0 else SLIDING
            group.heading[i, 0], group.heading[i, 1] = float(way), 0.0
            continue
        contact = system.contacts[group.closed[i].contact]
        still = max(10.0 * slow(contact, state), controls.rest * push * controls.step)
        set_heading(group, i, group.v[U][3 * i + 1], group.v[U][3 * i + 2], still)


@kernel
def set_heading(group, i, u1, u2, still):
    """Let point i slide along (u1, u2); if this is below `still`, its direction is unknown."""
    speed = math.sqrt(u1 * u1 + u2 * u2)
    if speed > still:
        group.kind[i] = SLIDING
        group.heading[i, 0], group.heading[i, 1] = u1 / speed, u2 / speed
    else:
        group.kind[i] = CONE
        group.heading[i, 0], group.heading[i, 1] = 0.0, 0.0


@kernel
def solve_forces(k, group):
    """Write the forces of the points that stay closed, and the accelerations of all k points.

    Slip goes on along the headings that are known. Return whether there is a solution.
    """
    for i in range(k):
        if group.kind[i] == SLIDING and group.heading[i, 0] == 0.0 and group.heading[i, 1] == 0.0:
            group.kind[i] = CONE
    found = solve_stage(k, 0.0, group)
    note_accelerations(k, group)
    return found


@kernel
def time_to_stop(i, group):
    """Return the time until slip of point i stops at its present deceleration."""
    d1, d2 = group.heading[i, 0], group.heading[i, 1]
    speed = group.v[U][3 * i + 1] * d1 + group.v[U][3 * i + 2] * d2
    rate = group.v[ACCELERATIONS][3 * i + 1] * d1 + group.v[ACCELERATIONS][3 * i + 2] * d2
    return speed / -rate if group.kind[i] == SLIDING and rate < 0.0 else math.inf


@kernel
def take_forces(active_point, i, group):
    """Write force and W of the closed point i to its active point, and when slip stops; or its torque."""
    turns = group.closed[i].turns
    if turns > 0:
        active_point.turn_stop[turns - 1] = time_to_stop(i, group)
        take_torque(active_point, i, group)
        return
    active_point.stop = time_to_stop(i, group)
    for r in range(3):
        active_point.force[r] = group.v[P][3 * i + r]
        for j in range(3):
            active_point.W[r, j] = group.W[3 * i + r, 3 * i + j]
