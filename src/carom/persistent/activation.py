"""Closed points of one group: which of them become persistent, and which open.

A contact becomes persistent if its bounces end within the step (`carom.persistent.bounces`): its velocity is
removed in the kinetic metric, and its energy is added to the ledger. There is no threshold of speed: with a
smaller step the contact becomes persistent later. If several points are closed, the acceleration of each is
that with all points closed that do not leave.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.closed_points import concerns, gather_closed
from carom.contact.gap import slow
from carom.contact.groups import members
from carom.contact.kinds.partner import smaller
from carom.contact.operations import apart, is_fixed, least_gap, located_within
from carom.dynamics.delassus import inverse_masses
from carom.dynamics.energy import energies
from carom.friction.layout import CONE, SLIDING
from carom.geometry.thresholds import REMAINDER, RESOLUTION
from carom.impact.thresholds import VELOCITY_LEFT
from carom.kinematics.contact_point import contact_velocity
from carom.model.actions import MODE_OPEN, MODE_STICK, PUSHED_IN
from carom.model.event_rows import begin_event, end_event
from carom.model.records import PERSISTS
from carom.model.workspace import MOTION_JOINT, MOTION_POINT
from carom.persistent.active_set import activate, regroup, set_anchor, switch, unite_loaded
from carom.persistent.adhesion import write_pulls
from carom.persistent.bounces import (
    after_pull,
    bounces_end,
    end_bounces,
    find_pull,
    horizon_of,
    time_without_torque,
)
from carom.persistent.by_bodies import FACTORED, knows_arms, note_arms
from carom.persistent.coulomb_stage import solve_forces
from carom.persistent.finish import add_forces_of_corners
from carom.persistent.jam import jams_among, note_jam
from carom.persistent.joint_load import has_loads, note_responses
from carom.persistent.joint_rows import add_frictions, greatest_load, still_speed
from carom.persistent.margins import take_forces
from carom.persistent.points import weigh
from carom.persistent.return_to_surfaces import onto_surfaces
from carom.persistent.rows import slip_of, write_motion
from carom.persistent.slip_law import set_friction
from carom.persistent.springs import count_factors, note_own
from carom.persistent.start import accelerate_start, first_stage
from carom.persistent.thresholds import LEAVING_PART
from carom.status import TOO_MANY_POINTS


@unit
def activate_contact(model, data, c, horizon):
    """Make closed points in the group of contact c persistent if they do not approach and satisfy the rule."""
    system, active, work = model.system, data.active, data.work
    contact, hit = system.contacts[c], work.hit[0]
    hit.code = 0
    k = gather_closed(model, data, c, False)
    unite_loaded(system, work)
    label = work.body[contact.body].label
    for i in range(active.count[0]):
        active_point = active.points[i]
        if work.body[active_point.body].label == label:
            active_point.rest = 0  # together with the new one
    if k < 0:
        hit.code = TOO_MANY_POINTS
    elif k > 0:
        data.group.equations.iterations[FACTORED] = 0
        if not activate_group(model, data, k, label, horizon):
            hit.code = TOO_MANY_POINTS
        count_factors(data.group, work.step[0])
    regroup(system, active, work)


@kernel
def activate_group(model, data, k, label, horizon):
    """Judge all k closed points of a group; activate the new ones, deactivate those that open.

    Return whether there is room for their equations: matrices have less than bodies.
    """
    system = model.system
    active, state, group, work = data.active, data.state, data.group, data.work
    clock, records = data.clocks[0], data.records
    work.moment[0].time = clock.now
    rows = add_frictions(system, label, state, k, group, work)
    note_arms(system, data, members(work, label, group.bodies.member), rows, state)
    if not knows_arms(group.equations):
        if rows > group.idle.shape[1]:
            return False
        inverse_masses(system, rows, group.points[0], state, work, group.problem.W)
        note_own(rows, group)
    if has_loads(group):
        note_responses(system, rows, state, work, group)
    weigh(system, rows, group)
    pose_forces(model, data, rows, label)
    for row in range(3 * rows):  # a first guess: those of another group, or of other points
        group.p[row] = 0.0
    decide_active(model, data, k, rows, horizon)
    written = stay_with_others(system, state, k, group)
    if leave_unreachable(system, state, k, group) or written:
        solve_among(system, k, rows, group)
    new, stay, first = -1, False, clock.event
    for i in range(k):
        closed_point = group.closed[i]
        stay = stay or closed_point.stays == 1
        if new < 0 and closed_point.stays == 1 and closed_point.active < 0:
            new = i
        if closed_point.stays == 0 and group.u[3 * i] <= slow(
            system.contacts[closed_point.contact], state
        ):
            active.contact_states[closed_point.contact].leaving = 1  # lifts off without speed
    if new >= 0:
        closed_point = group.closed[new]
        begin_event(system, closed_point.contact, closed_point.feature, state, clock, records)
    if stay:
        end_bounces(model, data, k, label, horizon)
        activate_new(model, data, k, new >= 0)
    deactivate_open(model, data, k, label)
    mark_approaching(system, active, k, state, group)
    if stay:
        first_forces(model, data, label, first)
    return True


@kernel
def pose_forces(model, data, k, label):
    """Write u, c = du/dt without contact forces, and the direction of slip, of the k points of the group."""
    system, controls, group, work = model.system, model.controls, data.group, data.work
    work.moment[0].start = data.clocks[0].now
    accelerate_start(model, data, label)
    write_pulls(system, data.active, k, data.state, group)
    write_motion(system, k, data.state, work.stages[0], group, work)
    push = greatest_load(k, group)
    for i in range(k):
        d1, d2, _ = slip_of(system, data, i, still_speed(i, push, controls, group))
        group.problem.kind[i] = SLIDING if d1 != 0.0 or d2 != 0.0 else CONE
        group.problem.heading[i, 0], group.problem.heading[i, 1] = d1, d2
        set_friction(system, i, group.problem.kind[i] == SLIDING, group)


@kernel
def decide_active(model, data, k, rows, horizon):
    """Mark the points that become or stay active; `rows` counts friction in joints too.

    First the points that do not leave and have a normal force; then the points whose bounces end within
    `horizon` under the acceleration with the first ones active; then those for which this holds with the new
    ones active, and so on. So a body on a falling body comes to rest only together with it.
    """
    system, state, group = model.system, data.state, data.group
    for i in range(k):
        closed_point = group.closed[i]
        leaves = abs(group.u[3 * i]) > slow(system.contacts[closed_point.contact], state)
        closed_point.stays, closed_point.bounces = 0 if leaves else 1, 0.0
    push = greatest_load(k, group)
    for turn in range(k + 1):
        solve_among(system, k, rows, group)
        more = False
        for i in range(k):
            contact, u = system.contacts[group.closed[i].contact], group.u[3 * i]
            a = group.a[3 * i]
            if group.closed[i].stays == 0:
                end = horizon_of(system, contact, model.controls, -a, horizon, state)
                if bounces_end(system, contact, u, -a, slow(contact, state), end):
                    group.closed[i].stays, more = 1, True
                    group.closed[i].bounces = time_without_torque(system, contact, u, -a, state)
            elif turn == 0 and a > max(LEAVING_PART * push, group.p[3 * i] * group.own[3 * i, 0]):
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
def stay_with_others(system, state, k, group):
    """Let points stay, too, that the others leave no velocity; return whether forces were written over.

    Where the bounces of three corners of a face are left out, the fourth cannot bounce alone: it carries, too.
    """
    leaves, bounces = False, False
    for i in range(k):
        moves = group.u[3 * i] > slow(system.contacts[group.closed[i].contact], state)
        stays = group.closed[i].stays == 1
        leaves, bounces = leaves or (moves and not stays), bounces or (moves and stays)
    if not (leaves and bounces):
        return False
    find_pull(k, 0, 0.0, group)
    for i in range(k):
        contact, u = system.contacts[group.closed[i].contact], group.u[3 * i]
        left = after_pull(3 * i, k, group)
        if u > 0.0 and abs(left) <= max(slow(contact, state), REMAINDER * u):
            group.closed[i].stays = 1
    return True


@kernel
def leave_unreachable(system, state, k, group):
    """Let points bounce on whose velocities cannot all be removed; return whether forces were written over.

    Where a driver moves a body the rows of two points may depend on each other while their velocities do not:
    two flanks of a tooth on a gear that can only turn. And where a corner comes to an edge next to a point that
    carries, both can stay only without rotation. The fastest are left until the others agree.
    """
    written = False
    for _ in range(k):
        fastest, left = -1, 0.0
        for i in range(k):
            if group.closed[i].stays == 1:
                if fastest < 0 or group.u[3 * i] > group.u[3 * fastest]:
                    fastest = i
        if fastest < 0:
            return written
        most = group.u[3 * fastest]
        if not most > slow(system.contacts[group.closed[fastest].contact], state):
            return written
        find_pull(k, 0, 0.0, group)
        written = True
        for i in range(k):
            if group.closed[i].stays == 1:
                left = max(left, abs(after_pull(3 * i, k, group)))
        if not left > VELOCITY_LEFT * most:
            return written
        group.closed[fastest].stays = 0
    return written


@kernel
def activate_new(model, data, k, begun):
    """Activate the points that stay and are not active, with an event for each; the first may have `begun`."""
    system, state, group = model.system, data.state, data.group
    clock, records = data.clocks[0], data.records
    for i in range(k):
        closed_point = group.closed[i]
        if closed_point.stays == 0:
            continue
        if closed_point.active < 0:
            if not begun:
                begin_event(
                    system, closed_point.contact, closed_point.feature, state, clock, records
                )
            begun = False
            closed_point.active = activate(system, data, closed_point)
            clock.holds += 1
            records.event[clock.event].mode = MODE_STICK
            end_event(system, closed_point.contact, PERSISTS, state, clock, records)
        if closed_point.bounces > model.controls.rest * model.controls.step:
            data.active.points[closed_point.active].bounces = closed_point.bounces


@kernel
def first_forces(model, data, label, first):
    """Store the forces of all active points of the group, and the modes that they ask for.

    A point that has just become active, by an event from `first` on, begins in its mode.
    """
    system, active, group = model.system, data.active, data.group
    k, _, _, _, found = first_stage(model, data, label)
    for i in range(k):
        closed_point = group.closed[i]
        if closed_point.listed == 0 or closed_point.motion == MOTION_JOINT:
            continue
        active_point = active.points[closed_point.active]
        take_forces(active_point, i, group)
        if jams_among(i, found, group) == 1:
            note_jam(active, active_point)
        if closed_point.motion != MOTION_POINT:
            continue
        mode, before = active_point.next, active_point.mode
        active_point.mode = mode
        if mode != before and not correct_mode(system, data, closed_point, mode, first):
            switch(system, data, closed_point.active, mode)
        elif mode == MODE_STICK:  # from where it has slid to, before the impact
            set_anchor(system, active_point, data.state, data.work)
    add_forces_of_corners(active, k, group)
    lay_down(model, data, k, label)


@kernel
def correct_mode(system, data, closed_point, mode, first):
    """Write the mode of a point into its event from `first` on, if it became active by one; return whether."""
    for i in range(first, data.clocks[0].event):
        event = data.records.event[i]
        number = system.contacts[closed_point.contact].number
        same = event.contact == number and event.feature == closed_point.feature
        if same and event.kind == PERSISTS:
            event.mode = mode
            return True
    return False


@kernel
def lay_down(model, data, k, label):
    """Bring the points that press back to the surfaces if they are not on them; name the energy of that.

    A rim that is nearly flat strikes as a flat one (`contact.kinds.rim`), with points above the surface, and so
    may be points of a crowd. A contact that this pushes inside is judged next, whether it approaches or not. A
    vertex that sticks to two planes cannot return later to one and stay where it was on the other.
    """
    system, state, group, clock, off = model.system, data.state, data.group, data.clocks[0], False
    for i in range(k):
        if group.closed[i].motion == MOTION_POINT and group.p[3 * i] > 0.0:
            contact = system.contacts[group.closed[i].contact]
            most = RESOLUTION * contact.extent
            if is_fixed(contact):
                most = min(most, 2.0 * located_within(model.controls, contact, state))
            off = off or abs(group.points[0][i].gap) > most
    if not off:
        return
    kinetic, potential, _ = energies(system, state, clock.now)
    active, work = data.active, data.work
    count = members(work, label, group.bodies.member)
    for c in range(system.contacts.shape[0]):
        outside = concerns(system.contacts[c], label, work) and not inside(system, c, state, work)
        active.contact_states[c].visited = 1 if outside else 0
    onto_surfaces(system, data, k, count, False, state)
    for c in range(system.contacts.shape[0]):
        if active.contact_states[c].visited == 1 and inside(system, c, state, work):
            active.contact_states[c].near = PUSHED_IN
    for i in range(active.count[0]):
        one = active.points[i]
        if one.mode == MODE_STICK and work.body[one.body].label == label:
            set_anchor(system, one, state, work)
    after, at_end, _ = energies(system, state, clock.now)
    clock.bounces += after + at_end - kinetic - potential


@kernel
def inside(system, c, state, work):
    """Return whether the bodies of a contact penetrate each other, or a stop is passed."""
    contact = system.contacts[c]
    if apart(system, contact, state, 0.0):
        return False
    return least_gap(system, contact, state, work) < -RESOLUTION * smaller(contact)


@kernel
def mark_approaching(system, active, k, state, group):
    """Mark contacts for a check if a closed point still approaches; the others were just judged."""
    for i in range(k):
        active.contact_states[group.closed[i].contact].near = 0
    for i in range(k):
        closed_point = group.closed[i]
        contact = system.contacts[closed_point.contact]
        if contact_velocity(system, group.points[0][i], state)[0] < -slow(contact, state):
            if closed_point.stays == 0:
                active.contact_states[closed_point.contact].near = 1


@kernel
def deactivate_open(model, data, k, label):
    """Remove the active points of the group that do not stay."""
    active, group = data.active, data.group
    for j in range(active.count[0] - 1, -1, -1):
        one = active.points[j]
        if data.work.body[one.body].label != label:
            continue
        for i in range(k):
            closed_point = group.closed[i]
            same = closed_point.contact == one.contact and closed_point.feature == one.feature
            if same and closed_point.stays == 0:
                switch(model.system, data, j, MODE_OPEN)
                break
