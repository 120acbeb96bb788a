"""The end of a contact step: return to joints and surfaces, modes, forces, the end of slip, rest."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.closed_points import place_closed
from carom.contact.gap import slow
from carom.contact.passed_edges import has_passed, note_passed
from carom.dynamics.adapt import allowed_error
from carom.dynamics.delassus import on_drive, velocities
from carom.dynamics.explicit import copy_state, note_velocity
from carom.dynamics.project import project_position, project_velocity
from carom.dynamics.thresholds import ERROR_SHARE, JOINT_ERROR
from carom.friction.layout import CONE, SLIDING
from carom.geometry.thresholds import REMAINDER, RESOLUTION, SUM_ERROR
from carom.kinematics.moving_surfaces import set_surfaces
from carom.model.actions import MODE_OPEN, MODE_SLIP, MODE_STICK
from carom.model.workspace import CONSTANT, MOTION_JOINT, MOTION_POINT
from carom.persistent.active_set import clear
from carom.persistent.adhesion import pulled
from carom.persistent.coulomb_stage import solve_forces
from carom.persistent.jam import jams_among
from carom.persistent.joint_rows import (
    greatest_load,
    place_drives,
    push_in,
    radius_of,
    still_speed,
)
from carom.persistent.margins import (
    greatest_push,
    set_grip,
    set_margins,
    take_forces,
    time_to_stop,
)
from carom.persistent.memory import (
    first_stop,
    is_torque,
    memory_of,
    slip_at_start,
    store_slip,
)
from carom.persistent.return_to_surfaces import (
    greatest_speed,
    onto_sticking,
    onto_surfaces,
    onto_tangents,
)
from carom.persistent.rows import (
    PASSED,
    SAME,
    accelerate_freely,
    bodies_of,
    push_bodies,
    set_modes,
    write_rows,
)
from carom.persistent.slip_law import (
    breaks_away,
    grip_by_law,
    has_law,
    note_kink,
    set_friction,
)
from carom.persistent.springs import own, solve_springs
from carom.persistent.step_control import rest_speed
from carom.persistent.stops import locates, note_left
from carom.persistent.thresholds import (
    DISC_ERROR,
    EQUATION_ERROR,
    FAR_TURN,
    FEW_REST,
    FRICTION_LIMIT,
    NO_MARGIN,
    STAYING_SPEED,
    TURNED,
)

#: slip in a step: goes on as it is; turns; begins, ends or turns far
SLIP_STAYS, SLIP_TURNS, SLIP_CHANGES = range(3)


@unit
def write_end(model, data, label, k) -> tuple[bool, float]:
    """Bring bodies back to joints and surfaces, velocities to the tangents.

    Return whether the joints close, and the work of the drives of surfaces.
    """
    system, group, work, end = model.system, data.group, data.work, data.work.trial
    count, loaded = bodies_of(model, data, label)
    if loaded and not (project_position(system, end, True, JOINT_ERROR, work) <= RESOLUTION):
        return False, 0.0
    copy_to_stage(count, end, group, work)
    set_surfaces(system, work.moment[0].time)
    place_closed(system, k, end, group, group.points[0], work)
    place_drives(system, k, work.moment[0].time, group)
    note_passed(system, data.active, k, group, data.state, end)
    onto_surfaces(system, data, k, count, True, end)
    if loaded:
        project_velocity(system, end, False, work)
    copy_to_stage(count, end, group, work)
    driven = onto_tangents(system, data, k, count)
    copy_to_stage(count, end, group, work)
    return True, driven


@kernel
def copy_to_stage(count, state, group, work):
    """Copy the bodies of a group to `work.stage`."""
    for m in range(count):
        copy_state(state[group.bodies.member[m]], work.stage[group.bodies.member[m]])


@kernel
def note_modes(model, data, k, h):
    """Write the modes at the end of a step of length h whose stages have none: what its disc holds sticks.

    What is on its disc at rest sticks: whether it slips is seen at the start of the next step. A slip that no
    friction could have stopped in the step goes on, whatever round-off has left of its force in a short step.
    Return what slip does: SLIP_TURNS if its direction changes, SLIP_CHANGES if it begins or ends, or its
    direction changes by more than 60 degrees, else SLIP_STAYS.
    """
    active, group, controls, does = data.active, data.group, model.controls, SLIP_STAYS
    push = greatest_load(k, group)
    for i in range(k):
        closed_point, u, p = group.closed[i], group.u, group.p
        _, b1, b2, began = slip_at_start(model.system, active, closed_point)
        still = max(still_speed(i, push, controls, group), SUM_ERROR * began)
        slip = math.hypot(u[3 * i + 1], u[3 * i + 2])
        force = math.hypot(p[3 * i + 1], p[3 * i + 2])
        # of a point that does not press, round-off is no friction left
        bare = closed_point.motion == MOTION_POINT and closed_point.presses == 0
        free = bare or not force < FRICTION_LIMIT * radius_of(group, i)
        full = slip > still and (free or slip > 2.0 * braked(i, h, group))
        full = full or turns_back(i, h, group)
        group.problem.kind[i] = SLIDING if group.problem.mu[i] == 0.0 or full else CONE
        if closed_point.listed == 0:
            continue
        slides = group.problem.kind[i] == SLIDING and slip > 0.0
        d1, d2 = u[3 * i + 1] / slip if slides else 0.0, u[3 * i + 2] / slip if slides else 0.0
        if group.problem.mu[i] > 0.0:
            turn, same = math.hypot(d1 - b1, d2 - b2), slides == (b1 != 0.0 or b2 != 0.0)
            far = turn > FAR_TURN or not same
            does = max(does, SLIP_CHANGES if far else SLIP_TURNS if turn > TURNED else SLIP_STAYS)
        store_slip(model.system, active, closed_point, d1, d2, slip if slides else 0.0)
        if not is_torque(closed_point) and group.problem.mu[i] > 0.0:
            next_mode = MODE_SLIP if group.problem.kind[i] == SLIDING else MODE_STICK
            memory_of(model.system, active, closed_point).next = next_mode
    return does


@kernel
def braked(i, h, group):
    """Return the greatest change of the slip of a point, or of the rate of a joint, by friction in a time h."""
    q = 3 * i
    return h * radius_of(group, i) * max(own(group, q + 1), own(group, q + 2))


@kernel
def turns_back(i, h, group):
    """Return whether the rate of a joint ends without its friction, as at a dead centre of a loop.

    Friction cannot have braked it: where W vanishes, a rate of round-off would stop all bodies.
    """
    return group.closed[i].parent == CONSTANT and abs(group.u[3 * i + 1]) > braked(i, h, group)


@kernel
def any_friction(k, group):
    """Return whether any of k points has friction."""
    for i in range(k):
        if group.problem.mu[i] > 0.0 and group.closed[i].motion == MOTION_POINT:
            return True
    return False


@unit
def check_end(model, data, label, s, h, given) -> tuple[bool, float, float]:
    """Write forces, margins and modes at the end of a step, in `work.stage`.

    Return whether given modes lasted, and the works of the drives of surfaces and of the friction of slip that
    ends. The accelerations there are those of stage s. With `given` modes, slip must not have turned back, and
    what sticks must be within its cones, or slip begins at an event that is located.
    """
    system, active = model.system, data.active
    end, group, work = data.work.trial, data.group, data.work
    count, loaded = bodies_of(model, data, label)
    for m in range(count):
        note_velocity(work.stage[group.bodies.member[m]], work.stages[s, group.bodies.member[m]])
    accelerate_freely(model, data, loaded, count, s)
    k = write_rows(model, data, label, s)
    push = greatest_load(k, group)
    directions = set_modes(system, active, k, group)
    if given:
        if directions < (PASSED if locates(model, data) else SAME):
            return False, 0.0, 0.0
        note_left(model, data, k)
    tolerance = rest_of(model, data, k, h)
    lasts, found, driven, rubbed = solve_end(model, data, label, k, s, h)
    exact, eager = locates(model, data), work.search[0].eager == 1
    # what is shared by several points has a kink where one opens or slips, which ends a step with tolerances
    # (without friction its forces are continuous there)
    adapts = eager and given and model.controls.order > 0
    located = push if adapts and any_friction(k, group) else greatest_push(k, group)
    for i in range(active.count[0]):
        if work.body[active.points[i].body].label == label:
            clear(active.points[i])  # it has a force only if it is among the points found
    at_rest = not on_drive(k, group.points[0]) and come_to_rest(system, data, tolerance, count)
    at_rest = at_rest and not accelerates_unseen(k, h, push, model.controls, group)
    for i in range(k):
        closed_point = group.closed[i]
        if closed_point.listed == 0:
            continue
        law = has_law(system, closed_point)
        if law:
            note_kink(system, active, closed_point, slip_at_end(i, group))
        slips = (
            given and not lasts and (breaks_away(i, push, group) if law else gains(i, push, group))
        )
        if closed_point.motion == MOTION_JOINT:
            if not end_joint(model, data, i, push, (law, exact, slips)):
                return False, 0.0, 0.0
            continue
        active_point = active.points[closed_point.active]
        take_forces(active_point, i, group)
        if closed_point.motion != MOTION_POINT:
            continue
        if not lasts and group.problem.kind[i] == CONE and active_point.next == MODE_SLIP:
            active_point.next = MODE_STICK
        smooth = adapts and group.problem.mu[i] == 0.0
        if slips and active_point.next == MODE_STICK:
            waits = eager and not smooth and (located > 0.0 or law or exact)
            if not (waits or smooth) and work.search[0].active == 0:
                return False, 0.0, 0.0
            if not waits:
                active_point.next = MODE_SLIP
        rounding = 10.0 * slow(system.contacts[closed_point.contact], end)
        still = max(STAYING_SPEED * (h * push), rounding)
        end_mode(active_point, i, still, at_rest, group)
        set_margins(active_point, i, located, group)
        margins = law, exact and located == 0.0, smooth or not given
        end_grip(active_point, i, push, margins, group)
        active_point.jams = jams_among(i, found, group)
    add_forces_of_corners(active, k, group)
    note_residual(active, k, group, work)
    return True, driven, rubbed


@kernel
def end_grip(active_point, i, push, margins, group):
    """Write the margin of a point before slip that its law asks for, or that stops which are located ask for.

    `margins` says whether it has a law, whether stops are located, and whether slip is no event of this step.
    """
    law, exact, free = margins
    if active_point.mode == MODE_STICK and active_point.next != MODE_OPEN:
        if law:
            active_point.grip = grip_by_law(i, push, group)
        elif exact:
            set_grip(active_point, i, push, group)
    if free:
        active_point.grip = 1.0


@kernel
def end_joint(model, data, i, push, how):
    """Write force, margin and mode of entry i, friction in a joint; return whether its mode lasted.

    `how` says whether it has a law, whether stops are located, and whether it begins to slip.
    """
    group, (law, exact, slips) = data.group, how
    one = model.system.relations.memory.frictions[group.closed[i].active]
    one.force[1], one.stop, one.grip = group.p[3 * i + 1], time_to_stop(i, group), 1.0
    if law or exact:
        one.grip = grip_by_law(i, push, group) if one.mode == MODE_STICK else 1.0
    elif slips and one.next == MODE_STICK:
        if data.work.search[0].active == 0:
            return False
        one.next = MODE_SLIP
    return True


@kernel
def slip_at_end(i, group):
    """Return the speed of slip of a point, or of a joint."""
    return math.hypot(group.u[3 * i + 1], group.u[3 * i + 2])


@kernel
def solve_end(model, data, label, k, s, h):
    """Write the forces at the end of a step of length h.

    Return whether its modes last, whether there are any, and the works of the drives of surfaces and of
    friction. Stage s has the accelerations before modes change, those that the estimate of the error needs.
    """
    group, work, (count, loaded) = data.group, data.work, bodies_of(model, data, label)
    solved, driven, rubbed = solve_springs(k, group), 0.0, 0.0
    if solved:
        push_bodies(model, data, loaded, k, count, s)
        lasts = within_cones(k, group)
        for row in range(3 * k):
            group.back[row] = group.p[row]
        sticks, after = stick_where_slip_ends(model, data, k, h)
        if sticks:
            driven, rubbed = onto_sticking(model.system, data, k, count, after)
            velocities(model.system, k, group.points[0], work.trial, group.u)
            copy_to_stage(count, work.trial, group, work)
            lasts = True
        if lasts:
            return True, True, driven, rubbed
    found = solve_forces(k, group)
    if not solved:
        push_bodies(model, data, loaded, k, count, s)
    return False, found, driven, rubbed


@kernel
def rest_of(model, data, k, h):
    """Return the speed below which the bodies of k points are at rest at the end of a step of length h."""
    push = greatest_load(k, data.group)
    for i in range(k):
        push = push_in(i, push, data.group)
    return rest_speed(model.controls, h * push, data.work.search[0].residual, k, FEW_REST)


@kernel
def end_mode(active_point, i, still, at_rest, group):
    """Let a point open that has no force and leaves its surface, faster than `still`, or stick at rest."""
    leaves = group.p[3 * i] <= 0.0 and group.u[3 * i] > still
    if leaves or active_point.passes == 1:
        active_point.next = MODE_OPEN
    if at_rest:
        active_point.next = MODE_STICK
    active_point.comes_to_rest = 1 if at_rest else 0


@kernel
def add_forces_of_corners(active, k, group):
    """Add the forces of corners that are no active points to that which stands for their pair."""
    for i in range(k):
        closed_point = group.closed[i]
        if closed_point.listed == 0 and closed_point.motion == MOTION_POINT:
            active_point = active.points[closed_point.active]
            active_point.pull += closed_point.pull
            for r in range(3):
                active_point.force[r] += group.p[3 * i + r]


@kernel
def gains(i, push, group):
    """Return whether a point accelerates along its surface."""
    a = group.a
    return math.hypot(a[3 * i + 1], a[3 * i + 2]) > NO_MARGIN * (push + pulled(i, group))


@kernel
def accelerates_unseen(k, h, push, controls, group):
    """Return whether a point accelerates, but by less than is a speed of slip in a step of length h.

    What has no speed at both ends of a short step, as where a slip turns round, does not rest for that.
    """
    seen, p = 2.0 * controls.rest * push * controls.step / h, group.p
    for i in range(k):
        q, a, least = 3 * i, 0.0, NO_MARGIN * (push + pulled(i, group))
        if math.hypot(p[q + 1], p[q + 2]) >= FRICTION_LIMIT * radius_of(group, i):
            a = math.hypot(group.a[q + 1], group.a[q + 2])
        if group.closed[i].motion == MOTION_POINT and p[q] <= 0.0:
            a = max(a, group.a[q])
        if least < a <= seen:
            return True
    return False


@kernel
def within_cones(k, group):
    """Return whether the friction of all points that stick, and torques that keep from turning, is allowed."""
    p, most = group.p, 0.0
    for i in range(k):
        most = max(most, p[3 * i])
    for i in range(k):
        if group.problem.kind[i] == SLIDING:
            continue
        force = math.hypot(p[3 * i + 1], p[3 * i + 2])
        if force > radius_of(group, i) * (1.0 + DISC_ERROR) + EQUATION_ERROR * most:
            return False
    return True


@kernel
def stick_where_slip_ends(model, data, k, h):
    """Let points stick whose slip ends within a part of the tolerance.

    Return whether friction holds them, and the time in which the fastest of them stops. A step of length h has
    gone to the stop that was predicted at its start, or the slip is that of rest. Forces and accelerations are
    those of stick then.
    """
    controls, group, active, found = model.controls, data.group, data.active, False
    fastest, after = 0.0, 0.0
    still = rest_of(model, data, k, h) * controls.step / h
    for i in range(k):
        closed_point = group.closed[i]
        closed_point.stays = 0
        if (
            group.problem.kind[i] != SLIDING
            or group.problem.mu[i] == 0.0
            or closed_point.listed == 0
        ):
            continue
        if turns_back(i, h, group):
            continue
        size = model.system.bodies[group.points[0][i].a].extent
        allowed = ERROR_SHARE * allowed_error(controls.rtol, controls.atol, size, 0.0)
        speed = math.hypot(group.u[3 * i + 1], group.u[3 * i + 2])
        ends = controls.order > 0 and 0.5 * speed * abs(time_to_stop(i, group)) <= allowed
        ends = ends and h >= (1.0 - REMAINDER) * first_stop(model.system, active, closed_point)
        if ends or speed <= still:
            closed_point.stays, found = 1, True
            if ends and speed > fastest:
                fastest, after = speed, time_to_stop(i, group)
    if not found:
        return False, 0.0
    for sticks in range(1, -1, -1):
        for i in range(k):
            closed_point = group.closed[i]
            closed_point.presses = 1 if closed_point.weight > 0.0 else 0
            if closed_point.stays == 1:
                group.problem.kind[i] = CONE if sticks == 1 else SLIDING
                set_friction(model.system, i, sticks == 0, group)
        if solve_springs(k, group) and (sticks == 0 or within_cones(k, group)):
            break
    if sticks == 0:
        return False, 0.0
    for i in range(k):
        if group.closed[i].stays == 1:
            store_slip(model.system, active, group.closed[i], 0.0, 0.0, 0.0)
            if not is_torque(group.closed[i]):
                memory_of(model.system, active, group.closed[i]).next = MODE_STICK
    return True, after


@kernel
def note_residual(active, k, group, work):
    """Raise the residual of the step to the greatest forbidden velocity."""
    worst = 0.0
    for i in range(k):
        presses = group.closed[i].motion == MOTION_POINT and group.p[3 * i] > 0.0
        if not presses or has_passed(active, i, group):
            continue
        worst = max(worst, abs(group.u[3 * i]))
        if group.problem.kind[i] == CONE:
            worst = max(worst, math.hypot(group.u[3 * i + 1], group.u[3 * i + 2]))
    work.search[0].residual = max(work.search[0].residual, worst)


@kernel
def come_to_rest(system, data, tolerance, count):
    """Stop the bodies exactly if all their speeds at the end are below the tolerance.

    Return whether they were at rest at the start too; then they also have not moved.
    """
    start, end, member = data.state, data.work.trial, data.group.bodies.member
    if not greatest_speed(system, end, count, member) <= tolerance:
        return False
    rested = greatest_speed(system, start, count, member) == 0.0
    for m in range(count):
        b = member[m]
        if rested:
            copy_state(start[b], end[b])
        for r in range(3):
            end[b].v[r], end[b].w[r] = 0.0, 0.0
    return rested
