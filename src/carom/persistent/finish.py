"""The end of a step of bodies in contact at several points: rest, modes, forces, and the end of slip."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.closed_points import place_closed
from carom.contact.gap import slow
from carom.dynamics.acceleration import OPEN, SLIP, STICK
from carom.dynamics.explicit import copy_state
from carom.dynamics.several_points import inverse_masses
from carom.impact.workspace import P, U
from carom.kinematics.contact_point import contact_velocity
from carom.persistent.forces import pose_forces, solve_forces, take_forces
from carom.persistent.jam import jams_among
from carom.persistent.known_modes import as_known, note_accelerations, solve_given
from carom.persistent.margins import greatest_push, set_margins
from carom.persistent.step_control import POORLY, rest_speed

FULL = 1e-9  # of the greatest friction: what is less than it by so little is all of it


@kernel
def gained(start, count, group):
    """Return the greatest speed that the bodies gain without the contacts."""
    most = 0.0
    for m in range(count):
        b = group.member[m]
        for r in range(3):
            most = max(most, abs(group.flight[b].v[r] - start[b].v[r]))
    return most


@kernel
def finish(model, data, k, h, count):
    """Set the bodies to rest if nothing moves them; write modes and bounds; return the work of friction.

    The work is never positive: a gain, from directions that turn within the step, is an error of the step.
    """
    system, controls = model.system, model.controls
    active, start, end, group, work = (
        data.active,
        data.state,
        data.work.trial,
        data.group,
        data.work,
    )
    friction = 0.0
    gain = gained(start, count, group)
    tolerance = rest_speed(controls, gain, work.result[0].residual, k, POORLY)
    at_rest = come_to_rest(system, tolerance, start, end, count, group)
    stop, away = tolerance * controls.step / h, 1e-6 * gain
    for i in range(k):
        active_point, p, u = active.points[group.closed[i].active], group.v[P], group.v[U]
        contact = system.contacts[active_point.contact]
        s1, s2 = u[3 * i + 1], u[3 * i + 2]
        _, m1, m2 = contact_velocity(group.points[0][i], start)
        _, e1, e2 = contact_velocity(group.points[0][i], end)
        friction += 0.5 * (p[3 * i + 1] * (m1 + e1) + p[3 * i + 2] * (m2 + e2))
        if group.closed[i].turns > 0:
            continue
        still = max(stop, 10.0 * max(slow(contact, start), slow(contact, end)))
        if p[3 * i] <= 0.0 and u[3 * i] > max(still, away):
            active_point.next = OPEN
        else:
            speed = math.sqrt(s1 * s1 + s2 * s2)
            slips = speed > still
            if controls.order > 0:  # steps may be as short as the tolerance asks for
                slips = slips or begins(active_point, i, speed, group)
            active_point.next = SLIP if slips else STICK
        if at_rest:
            active_point.next = STICK
        active_point.comes_to_rest = 1 if at_rest else 0
    for m in range(count):
        b = group.member[m]
        linear, angular, spin = 0.0, 0.0, 0.0
        for r in range(3):
            linear += (end[b].v[r] - start[b].v[r]) ** 2
            angular += (end[b].w[r] - start[b].w[r]) ** 2
            spin += max(end[b].w[r] ** 2, start[b].w[r] ** 2)
        bound = work.body[b].bound
        bound[0], bound[1] = 2.0 * math.sqrt(linear) / h, 2.0 * math.sqrt(angular) / h
        bound[2] = math.sqrt(spin)
    return min(0.0, friction)


@kernel
def begins(active_point, i, speed, group):
    """Return whether slip has just begun: however slow it is, it grows against all the friction there is."""
    p, q = group.v[P], 3 * i
    most = group.mu[i] * p[q]
    return (
        active_point.mode == SLIP
        and most > 0.0
        and math.hypot(p[q + 1], p[q + 2]) >= (1.0 - FULL) * most
        and speed > active_point.speed
    )


@kernel
def come_to_rest(system, tolerance, start, end, count, group):
    """Stop the bodies exactly if all their speeds at the end are below the tolerance.

    Return whether they were at rest at the start too; then they also have not moved.
    """
    speed, before = 0.0, 0.0
    for m in range(count):
        b = group.member[m]
        size = system.bodies[b].extent
        for r in range(3):
            speed = max(speed, max(abs(end[b].v[r]), size * abs(end[b].w[r])))
            before = max(before, max(abs(start[b].v[r]), abs(start[b].w[r])))
    if not speed <= tolerance:
        return False
    for m in range(count):
        b = group.member[m]
        if before == 0.0:
            copy_state(start[b], end[b])
        for r in range(3):
            end[b].v[r], end[b].w[r] = 0.0, 0.0
    return before == 0.0


@kernel
def forces_at_end(model, data, k, known, end):
    """Write the forces at the end to the active points, by the `known` modes if these are still valid.

    If modes are known, the points are placed and W is written for the end.
    """
    system, active, group, work = model.system, data.active, data.group, data.work
    for i in range(k):
        closed_point = group.closed[i]
        active_point = active.points[closed_point.active]
        closed_point.stays = 1 if active_point.next != OPEN else 0
    if not known:
        place_closed(system, k, end, group, group.points[0], work)
        inverse_masses(system, k, group.points[0], end, work, group.m[0])
    pose_forces(system, model.controls, active, k, end, group, work)
    status = 0
    if known and as_known(k, group) and solve_given(system, k, end, group, work):
        note_accelerations(k, group, work)
    else:
        status = solve_forces(model, data, k)
    push = greatest_push(k, group)
    for i in range(k):
        active_point = active.points[group.closed[i].active]
        take_forces(active_point, i, group)
        if group.closed[i].turns == 0:
            set_margins(active_point, i, push, group)
            active_point.jams = jams_among(active_point, i, status, group)
