"""Several closed points of one group: the points that become persistent, and the points that open."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.gap import slow
from carom.contact.groups import members
from carom.dynamics.contact_impulse import alone
from carom.dynamics.elements import driven_power
from carom.dynamics.energy import energies
from carom.dynamics.several_points import inverse_masses
from carom.friction.layout import CONE, SLIDING
from carom.geometry.thresholds import REMAINDER, RESOLUTION, SUM_ERROR
from carom.impact.thresholds import VELOCITY_LEFT
from carom.impact.workspace import ACCELERATIONS, RETURN, C, P, U
from carom.kinematics.contact_point import contact_velocity
from carom.model.actions import MODE_SLIP, MODE_STICK
from carom.model.event_rows import begin_event, end_event
from carom.model.records import OPENS, PERSISTS, SLIPS, STICKS
from carom.persistent.active_set import activate, any_turning, deactivate, set_anchor
from carom.persistent.bounces import bounces_end, horizon_of, name_work, spare, time_of_bounces
from carom.persistent.finish import add_forces_of_corners
from carom.persistent.forces import pose_forces, solve_forces, take_forces, time_to_stop
from carom.persistent.jam import jams_among, note_jam
from carom.persistent.joint_rows import JOINT, add_frictions
from carom.persistent.points import weigh
from carom.persistent.return_to_surfaces import (
    factor_given,
    give,
    greatest_speed,
    onto_surfaces,
    solve_rows,
)
from carom.persistent.rows import bodies_of
from carom.persistent.settle import add_product, greatest
from carom.persistent.springs import given
from carom.persistent.start import first_stage
from carom.persistent.thresholds import REST_SHARE


@kernel
def activate_several(model, data, k, label, horizon):
    """Judge all k closed points of a group; activate the new ones, deactivate those that open."""
    system = model.system
    active, state, group, work = data.active, data.state, data.group, data.work
    clock, records = data.clocks[0], data.records
    rows = add_frictions(system, label, state, k, group, work)
    inverse_masses(system, rows, group.points[0], state, work, group.W)
    pose_forces(model, data, rows, label)
    for row in range(3 * rows):  # a first guess: those of another group, or of other points
        group.v[P][row] = 0.0
    judge(model, data, k, rows, horizon)
    if leave_unreachable(system, state, k, group):
        solve_among(system, k, rows, group)
    new, stay = -1, False
    for i in range(k):
        closed_point = group.closed[i]
        stay = stay or closed_point.stays == 1
        if new < 0 and closed_point.stays == 1 and closed_point.active < 0:
            new = i
        if closed_point.stays == 0 and group.v[U][3 * i] <= slow(
            system.contacts[closed_point.contact], state
        ):
            active.contact_states[closed_point.contact].leaving = 1  # lifts off without speed
    if new >= 0:
        closed_point = group.closed[new]
        begin_event(system, closed_point.contact, closed_point.feature, state, clock, records)
    if stay:
        end_bounces(model, data, k, label, horizon)
        set_modes(model, data, k)
    deactivate_open(model, data, k, label)
    mark_approaching(system, active, k, state, group)
    if stay:
        first_forces(model, data, label)


@kernel
def judge(model, data, k, rows, horizon):
    """Mark the points that become or stay active; `rows` counts friction in joints too.

    First the points that do not leave and have a normal force; then the points whose bounces end within
    `horizon` under the acceleration with the first ones active; then those for which this holds with the new
    ones active, and so on. So a body on a falling body comes to rest only together with it.
    """
    system, state, group = model.system, data.state, data.group
    for i in range(k):
        contact, u = system.contacts[group.closed[i].contact], group.v[U][3 * i]
        group.closed[i].stays, group.closed[i].bounces = (
            1 if abs(u) <= slow(contact, state) else 0,
            0.0,
        )
    push = greatest(3 * k, group.v[C])
    for turn in range(k + 1):
        solve_among(system, k, rows, group)
        more = False
        for i in range(k):
            contact, u = system.contacts[group.closed[i].contact], group.v[U][3 * i]
            a = group.v[ACCELERATIONS][3 * i]
            if group.closed[i].stays == 0:
                end = horizon_of(contact, model.controls, -a, horizon)
                if bounces_end(system, contact, u, -a, slow(contact, state), end):
                    group.closed[i].stays, more = 1, True
                    group.closed[i].bounces = time_without_torque(system, contact, u, -a, state)
            elif turn == 0 and a > max(1e-10 * push, group.v[P][3 * i] * group.W[3 * i, 3 * i]):
                group.closed[i].stays = 0  # it has no force
        if not more:
            break


@kernel
def solve_among(system, k, rows, group):
    """Write the forces of those of k points that stay closed, and the accelerations of all."""
    weigh(system, rows, group)
    for i in range(k):
        if group.closed[i].stays == 0:
            group.closed[i].weight = 0.0
    solve_forces(rows, group)


@kernel
def leave_unreachable(system, state, k, group):
    """Let points bounce on whose velocities cannot all be removed; return whether forces were written over.

    Where a driver moves a body the rows of two points may depend on each other while their velocities do not:
    two flanks of a tooth on a gear that can only turn. The fastest are left until the others agree.
    """
    written = False
    for _ in range(k):
        fastest, joined, left = -1, False, 0.0
        for i in range(k):
            if group.closed[i].stays == 1:
                joined = joined or not alone(system, group.points[0][i])
                if fastest < 0 or group.v[U][3 * i] > group.v[U][3 * fastest]:
                    fastest = i
        if not joined:
            return written
        most = group.v[U][3 * fastest]
        if not most > slow(system.contacts[group.closed[fastest].contact], state):
            return written
        find_pull(k, 0, 0.0, group)
        written = True
        for i in range(k):
            if group.closed[i].stays == 1:
                left = max(left, abs(velocity_after(3 * i, k, group)))
        if not left > VELOCITY_LEFT * most:
            return written
        group.closed[fastest].stays = 0
    return written


@kernel
def velocity_after(q, k, group):
    """Return the velocity of row q after the impulses in RETURN."""
    return add_product(group.v[U][q], 3 * k, group.W[q], group.v[RETURN])


@kernel
def time_without_torque(system, contact, rate, g, state):
    """Return the time of bounces that are left out, in which rolling and pivoting friction do not act."""
    bounces = any_turning(contact) and rate > slow(contact, state)
    return time_of_bounces(system, contact, rate, g) if bounces else 0.0


@kernel
def end_bounces(model, data, k, label, horizon):
    """Remove the normal velocities of the points that stay, in the kinetic metric.

    The slip of a point without slip is removed too; otherwise the point would stick with the slip that the
    impulse gives it. If slip lasts, friction acts with the impulse. Velocities of round-off
    size, a small fraction of the speed before, become 0, however large the forces are (the point of a rim that
    is nearly flat moves along the rim with 1e13 m/s^2).
    """
    system, controls = model.system, model.controls
    state, group, work, clock = data.state, data.group, data.work, data.clocks[0]
    count = members(work, label, group.member)
    speed = greatest_speed(system, state, count, group.member)
    still = 1e-12 * speed
    for i in range(3 * k):
        still = max(still, controls.rest * controls.step * abs(group.v[C][i]))
    still = min(still, REST_SHARE * speed)
    for i in range(k):
        contact = system.contacts[group.closed[i].contact]
        end = horizon_of(contact, controls, -group.v[C][3 * i], horizon)
        if not time_to_stop(i, group) > end:  # friction ends with the slip
            group.heading[i, 0], group.heading[i, 1] = 0.0, 0.0
    find_pull(k, 1, SUM_ERROR * speed, group)
    normal, tangential = work_of_pull(k, group)
    if normal > 0.0 or not normal + tangential <= spare(
        clock, work.step[0]
    ):  # neighbours push each other out
        find_pull(k, 0, SUM_ERROR * speed, group)
        normal, tangential = work_of_pull(k, group)
    name_work(normal, tangential, clock, work.step[0])
    if give(system, k, count, state, group, work):
        clock.loads += driven_power(system, state, work)  # of an impulse: its work
    if greatest_speed(system, state, count, group.member) <= still:
        for m in range(count):
            b = group.member[m]
            for r in range(3):
                state[b].v[r], state[b].w[r] = 0.0, 0.0


@kernel
def work_of_pull(k, group):
    """Return the work of the impulses in RETURN: half of each times its velocities before and after."""
    x, u = group.v[RETURN], group.v[U]
    normal, tangential = 0.0, 0.0
    for i in range(3 * k):
        if x[i] == 0.0:
            continue
        if given(group, i):
            normal += 0.5 * x[i] * u[i]
        else:
            tangential += 0.5 * x[i] * (u[i] + velocity_after(i, k, group))
    return normal, tangential


@kernel
def find_pull(k, friction, tiny, group):
    """Write the impulses that remove the velocities to RETURN: with friction (1) if they exist."""
    x = group.v[RETURN]
    for i in range(k):  # the normal of a point that stays is removed, and its tangents if it sticks
        closed_point = group.closed[i]
        closed_point.rows = 0 if closed_point.stays == 0 else 3 if group.kind[i] == CONE else 1
    for with_friction in range(friction, -1, -1):
        n = factor_given(k, with_friction == 1, group)
        for i in range(3 * k):
            x[i] = group.v[U][i]
        left = solve_rows(k, n, tiny, group, x)
        for i in range(k if with_friction == 1 else 0):
            if group.closed[i].rows == 1 and group.kind[i] == SLIDING:
                for r in range(2):
                    x[3 * i + 1 + r] = -group.mu[i] * group.heading[i, r] * x[3 * i]
        if left <= max(tiny, REMAINDER * greatest(3 * k, group.v[U])):
            return


@kernel
def mode_of(system, i, state, group):
    """Return whether point i slips or sticks after its bounces were removed."""
    _, u1, u2 = contact_velocity(group.points[0][i], state)
    # as `pose_forces` has found with the velocities before
    still = 10.0 * slow(system.contacts[group.closed[i].contact], state)
    slips = math.sqrt(u1 * u1 + u2 * u2) > still and group.kind[i] == SLIDING
    return MODE_SLIP if slips else MODE_STICK


@kernel
def set_modes(model, data, k):
    """Activate the new points, with an event for each (the first is begun already); set modes of the others."""
    system = model.system
    active, state, group, work = data.active, data.state, data.group, data.work
    clock, records = data.clocks[0], data.records
    begun, before = True, active.count[0]
    for i in range(k):
        closed_point = group.closed[i]
        if closed_point.stays == 0 or closed_point.active >= 0:
            continue
        if not begun:
            begin_event(system, closed_point.contact, closed_point.feature, state, clock, records)
        begun = False
        mode = mode_of(system, i, state, group)
        closed_point.active = activate(system, active, closed_point, mode, state, work)
        clock.holds += 1
        records.event[clock.event].mode = mode
        end_event(system, closed_point.contact, PERSISTS, state, clock, records)
    for i in range(k):
        closed_point = group.closed[i]
        if closed_point.stays == 0:
            continue
        if closed_point.bounces > model.controls.rest * model.controls.step:
            active.points[closed_point.active].bounces = closed_point.bounces
        if closed_point.active >= before:
            continue
        active_point, mode = active.points[closed_point.active], mode_of(system, i, state, group)
        if mode == MODE_STICK:  # from where it has slid to, before the impact
            set_anchor(system, active_point, state, work)
        if active_point.mode != mode:
            active_point.mode = mode
            begin_event(system, closed_point.contact, closed_point.feature, state, clock, records)
            kind = SLIPS if mode == MODE_SLIP else STICKS
            end_event(system, closed_point.contact, kind, state, clock, records)


@kernel
def first_forces(model, data, label):
    """Store the forces of all active points of the group, and the modes that they ask for."""
    system, active, state = model.system, data.active, data.state
    group, work, clock, records = data.group, data.work, data.clocks[0], data.records
    count, loaded = bodies_of(model, data, label)
    work.result[0].start = clock.now
    k, _, _, _, found = first_stage(model, data, label, loaded, count)
    for i in range(k):
        closed_point = group.closed[i]
        if closed_point.own == 0 or closed_point.turns == JOINT:
            continue
        active_point = active.points[closed_point.active]
        take_forces(active_point, i, group)
        if jams_among(i, found, group) == 1:
            note_jam(active, active_point)
        if closed_point.turns == 0 and active_point.next != active_point.mode:
            active_point.mode = active_point.next
            if not correct_mode(system, closed_point, active_point.mode, clock, records):
                begin_event(
                    system, closed_point.contact, closed_point.feature, state, clock, records
                )
                end_event(system, closed_point.contact, SLIPS, state, clock, records)
    add_forces_of_corners(active, k, group)
    lay_down(model, data, k, label)


@kernel
def correct_mode(system, closed_point, mode, clock, records):
    """Write the mode of a point that has just become active into its event; return whether there is one."""
    for i in range(clock.event - 1, -1, -1):
        event = records.event[i]
        if event.time < clock.now:
            break
        number = system.contacts[closed_point.contact].number
        same = event.contact == number and event.feature == closed_point.feature
        if same and event.kind == PERSISTS:
            event.mode = mode
            return True
    return False


@kernel
def lay_down(model, data, k, label):
    """Bring the points that press back to the surfaces if they are not on them; name the energy of that.

    A rim that is nearly flat strikes as a flat one (`carom.contact.rim`), with points above the surface.
    """
    system, active, state = model.system, data.active, data.state
    group, work, clock = data.group, data.work, data.clocks[0]
    off = False
    for i in range(k):
        if group.closed[i].turns == 0 and group.v[P][3 * i] > 0.0:
            size = system.contacts[group.closed[i].contact].extent
            off = off or abs(group.points[0][i].gap) > RESOLUTION * size
    if not off:
        return
    kinetic, potential, _ = energies(system, state, clock.now)
    count = members(work, label, group.member)
    onto_surfaces(system, active, k, count, state, group, work)
    after, at_end, _ = energies(system, state, clock.now)
    clock.bounces += after + at_end - kinetic - potential


@kernel
def mark_approaching(system, active, k, state, group):
    """Mark contacts for a check if a closed point still approaches; the others were just judged."""
    for i in range(k):
        active.contact_states[group.closed[i].contact].near = 0
    for i in range(k):
        closed_point = group.closed[i]
        contact = system.contacts[closed_point.contact]
        if contact_velocity(group.points[0][i], state)[0] < -slow(contact, state):
            if closed_point.stays == 0:
                active.contact_states[closed_point.contact].near = 1


@kernel
def deactivate_open(model, data, k, label):
    """Remove the active points of the group that do not stay."""
    system = model.system
    active, state, group, work = data.active, data.state, data.group, data.work
    clock, records = data.clocks[0], data.records
    for j in range(active.count[0] - 1, -1, -1):
        active_point = active.points[j]
        if work.body[active_point.body].label != label:
            continue
        for i in range(k):
            closed_point = group.closed[i]
            if (
                closed_point.contact == active_point.contact
                and closed_point.feature == active_point.feature
                and closed_point.stays == 0
            ):
                begin_event(
                    system, closed_point.contact, closed_point.feature, state, clock, records
                )
                deactivate(active, j)
                end_event(system, closed_point.contact, OPENS, state, clock, records)
                break
