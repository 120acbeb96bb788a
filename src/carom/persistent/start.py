"""The start of a step of a group: which points slip and where to, forces and accelerations, new modes.

New modes come from the contact problem of accelerations at that moment, and from nowhere else: after an impact,
at an opening, or where what stuck is outside its cone.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.passed_edges import note_normal
from carom.dynamics.explicit import copy_state, note_velocity
from carom.friction.layout import SLIDING
from carom.model.actions import MODE_SLIP, MODE_STICK
from carom.model.workspace import CONSTANT, MOTION_JOINT, MOTION_POINT
from carom.persistent.coulomb_stage import solve_forces
from carom.persistent.finish import copy_to_stage, gains, within_cones
from carom.persistent.joint_rows import greatest_load, radius_of, still_speed
from carom.persistent.memory import is_torque, memory_of, store_slip
from carom.persistent.points import note_range
from carom.persistent.rows import (
    accelerate_freely,
    bodies_of,
    push_bodies,
    set_modes,
    slip_of,
    write_rows,
)
from carom.persistent.slip_law import follow_laws, has_law, set_friction
from carom.persistent.springs import own, solve_springs


@kernel
def first_modes(system, data, label):
    """Take the modes of the start of the step for those of its end, until the end is known."""
    active, frictions = data.active, system.relations.memory.frictions
    for i in range(active.count[0]):
        if data.work.body[active.points[i].body].label == label:
            active.points[i].next, active.points[i].left = active.points[i].mode, 1.0
    for i in range(frictions.shape[0] if label == data.work.body.shape[0] else 0):
        frictions[i].next, frictions[i].left = frictions[i].mode, 1.0


@kernel
def accelerate_start(model, data, label):
    """Write the state at the start of a step to `work.stage`, and as stage 0 accelerations without rows.

    Return the number of bodies of the group, whether they are joined or loaded, and the power of loads.
    """
    start, group, work = data.state, data.group, data.work
    count, loaded = bodies_of(model, data, label)
    note_range(data.active, label, group, work)
    for b in range(start.shape[0] if loaded else 0):
        copy_state(start[b], work.stage[b])
    copy_to_stage(0 if loaded else count, start, group, work)
    for m in range(count):
        note_velocity(work.stage[group.bodies.member[m]], work.stages[0, group.bodies.member[m]])
    work.moment[0].time = work.moment[0].start
    return count, loaded, accelerate_freely(model, data, loaded, count, 0)


@kernel
def first_stage(model, data, label):
    """Write the accelerations of a group at the start of a step as stage 0, and the directions of slip.

    Return the number of points, the greatest rate at which friction turns a slip, the greatest acceleration by
    friction, the powers of loads and of friction, and whether the contact problem has a solution.
    """
    group, system, controls = data.group, model.system, model.controls
    count, loaded, power = accelerate_start(model, data, label)
    first_modes(system, data, label)
    k = write_rows(model, data, label, 0)
    push = greatest_load(k, group)
    known = True
    for i in range(k):
        known = find_slip(model, data, i, still_speed(i, push, controls, group)) and known
    set_modes(system, data.active, k, group)
    found, held = True, known and solve_springs(k, group)
    shared = held and within_cones(k, group)
    if not shared:
        found = solve_forces(k, group)
    none, broke = note_break_away(system, data, k, push)
    known = none and known
    for _ in range(k if broke else 0):  # friction that is a law is that of slip then
        follow_laws(system, data.active, k, group)
        found = solve_forces(k, group)
        if not note_break_away(system, data, k, push)[1]:
            break
    if held and known and not shared:  # nothing begins to slip: the springs share, as in the stages
        k = write_rows(model, data, label, 0)
        set_modes(system, data.active, k, group)
        solve_springs(k, group)
    driven, rubbed = push_bodies(model, data, loaded, k, count, 0)
    rate, friction = rates(k, group)
    return k, rate if known else math.inf, friction, (power + driven, rubbed), found


@kernel
def note_break_away(system, data, k, push):
    """Let points slip that stick but accelerate along their surfaces.

    Return whether there is none, and whether one begins whose friction is a law.
    """
    group, none, broke = data.group, True, False
    for i in range(k):
        closed_point = group.closed[i]
        smooth = group.problem.mu[i] == 0.0
        if (group.problem.kind[i] == SLIDING and not smooth) or closed_point.listed == 0:
            continue
        if not gains(i, push, group):
            continue
        none = none and smooth
        presses = closed_point.motion != MOTION_POINT or group.p[3 * i] > 0.0
        if is_torque(closed_point) or not presses:
            continue
        memory = memory_of(system, data.active, closed_point)
        broke = broke or (memory.next != MODE_SLIP and has_law(system, closed_point))
        memory.next = MODE_SLIP
        if closed_point.motion == MOTION_JOINT:  # its event is that of this step
            memory.mode = MODE_SLIP
    return none, broke


@kernel
def find_slip(model, data, i, still):
    """Store direction and speed of slip of a point at the start of a step; return whether they are known."""
    system, group, active = model.system, data.group, data.active
    closed_point = group.closed[i]
    d1, d2, speed = slip_of(system, data, i, still)
    if closed_point.motion == MOTION_JOINT:
        one = system.relations.memory.frictions[closed_point.active]
        store_slip(system, active, closed_point, d1, d2, speed if d1 != 0.0 else 0.0)
        one.next = MODE_SLIP if d1 != 0.0 else MODE_STICK
        if d1 != 0.0:
            one.mode = MODE_SLIP
        one.began = speed
        # without slip it has just broken away, or may turn back
        set_friction(system, i, one.mode == MODE_SLIP, group)
        return d1 != 0.0 or one.mode == MODE_STICK
    active_point, moves = active.points[closed_point.active], d1 != 0.0 or d2 != 0.0
    if closed_point.listed == 0:
        return moves or active_point.next != MODE_SLIP or group.problem.mu[i] == 0.0
    if closed_point.motion != MOTION_POINT:
        store_slip(system, active, closed_point, d1, d2, speed if moves else 0.0)
        return True
    if moves and active_point.mode != MODE_SLIP:
        active_point.next = MODE_SLIP  # a corner that has come since: the velocity decides
        set_friction(system, i, True, group)
    slips = active_point.next == MODE_SLIP
    if slips and not moves and group.problem.mu[i] > 0.0:  # it has stopped
        active_point.next = MODE_STICK
    active_point.began = speed
    note_normal(group.points[0][i], active_point)
    store_slip(system, active, closed_point, d1 if slips else 0.0, d2 if slips else 0.0, speed)
    return moves or not slips or group.problem.mu[i] == 0.0


@kernel
def rates(k, group):
    """Return the greatest rate at which friction turns a slip, and the greatest acceleration by friction.

    Of a joint it is at least that of its coordinate: it bounds the steps of order 1.
    """
    rate, most = 0.0, 0.0
    for i in range(k):
        q = 3 * i
        force = math.hypot(group.p[q + 1], group.p[q + 2])
        if group.problem.kind[i] != SLIDING:
            force = max(force, radius_of(group, i))
        braked = force * max(own(group, q + 1), own(group, q + 2))
        most = max(most, braked)
        if group.closed[i].parent == CONSTANT:  # where W vanishes it turns back by itself
            most = max(most, abs(group.problem.c[q + 1]))
        speed = math.hypot(group.u[q + 1], group.u[q + 2])
        if group.problem.kind[i] == SLIDING and group.problem.mu[i] > 0.0 and braked > 0.0:
            rate = max(rate, braked / speed if speed > 0.0 else math.inf)
    return rate, most
