"""A step of one body on several points by the Runge-Kutta method of the run, while their modes do not change.

While the same points are loaded, slip and stick, the motion is smooth:

    M dv/dt = f + G^T lam,    (G dv/dt)_n = 0 for loaded points, all three rows for those that stick,
                              lam_t = -mu lam_n u_t/|u_t| for those that slip.

Each stage is one linear system (`carom.persistent.known_modes`). If its forces do not obey Coulomb's law, the
stage is solved as a contact problem (`carom.persistent.forces`). At the end the body returns to the surfaces.
(Mathematics page, §3.1.)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.closed_points import place_closed
from carom.contact.gap import slow
from carom.contact.place import drift_of
from carom.contact.place_of_other import on_half_space
from carom.dynamics.acceleration import OPEN, SLIP, accelerate
from carom.dynamics.adapt import note_miss
from carom.dynamics.explicit import (
    bound_accelerations_of,
    combine_body,
    copy_state,
    note_velocity,
    stages_within,
)
from carom.dynamics.several_points import (
    accelerations,
    inverse_masses,
    inverse_masses_of_one,
    spread_all,
    velocities,
)
from carom.friction.layout import CONE, SLIDING
from carom.geometry.rotation import norm
from carom.impact.workspace import BACK, C, P, U
from carom.kinematics.contact_point import contact_velocity
from carom.kinematics.flight import free_rates
from carom.persistent.finish import finish
from carom.persistent.forces import solve_forces
from carom.persistent.known_modes import note_given, rows_of, solve_as_known, solve_given
from carom.persistent.return_to_surfaces import onto_surfaces, onto_tangents
from carom.persistent.step_control import kinetic, unnamed

# least cosine between the directions of slip in a step; greatest change that friction may cause in slip,
# relative to its speed, where an explicit step is unstable from about 2.7 on
SAME_WAY, STIFF = 0.5, 2.0


@kernel
def smooth_step(model, data, method, k, h):
    """Write the end of a step of the only body of a group, and its error; return whether its modes stay."""
    system, controls = model.system, model.controls
    start, end, group, work = data.state, data.work.trial, data.group, data.work
    b, result, clock = group.member[0], data.work.result[0], data.clocks[0]
    u, p = group.v[U], group.v[P]
    if not begin(model, data, k):
        return False
    stages, friction = stages_within(method), 0.0
    for s in range(stages):
        combine_body(method.A[s], s, h, start[b], work.stages, b, work.stage[b])
        note_velocity(work.stage[b], work.stages[s, b])
        if not add_forces(model, data, k, s):
            return False
        for i in range(k):
            power = p[3 * i + 1] * u[3 * i + 1] + p[3 * i + 2] * u[3 * i + 2]
            friction += h * method.b[s] * power if group.kind[i] == SLIDING else 0.0
    clock.contact_steps, clock.rounds = clock.contact_steps + 1, clock.rounds + stages
    clock.since += 5.0 * k * stages
    combine_body(method.b, stages, h, start[b], work.stages, b, end[b])
    if not finish_smoothly(model, data, k, h):
        return False
    result.friction += friction
    over = unnamed(system, controls, start, end, friction, 1, group.member)
    result.unnamed = max(result.unnamed, over)
    return True


@kernel
def note_error(model, data, method, k, h, friction):
    """Write the error of the step by its stages; a last one at its end has the forces that were found there."""
    system, group, work = model.system, data.group, data.work
    b, end, stages = group.member[0], work.trial, method.b.size
    if stages_within(method) < stages:
        rates = work.stages[stages - 1, b]
        note_velocity(end[b], rates)
        free_rates(system.bodies[b], system.gravity, end[b], rates.rate)
        spread_all(system, k, group.points[0], group.v[P], 1, group.member, end, work)
        accelerate(work.body[b].motion, rates.rate)
    work.body[b].bound[:3] = 0.0
    bound_accelerations_of(work, b, stages)
    note_miss(system, method.E, h, lasting(model, data, k, h, friction), b, work)


@kernel
def begin(model, data, k):
    """Write which points are loaded, slip and stick; return whether these modes can last for the step."""
    system, controls, active = model.system, model.controls, data.active
    start, group = data.state, data.group
    b = group.member[0]
    push = norm(system.gravity) + system.bodies[b].extent * norm(start[b].w) ** 2
    for i in range(k):
        if group.closed[i].turns > 0:
            if not begin_turning(model, data, k, i, push):
                return False
            continue
        closed_point = group.closed[i]
        contact = system.contacts[closed_point.contact]
        active_point, mu = active.points[closed_point.active], contact.friction_held
        _, u1, u2 = contact_velocity(group.points[0][i], start)
        speed = math.sqrt(u1 * u1 + u2 * u2)
        still = max(10.0 * slow(contact, start), controls.rest * push * controls.step)
        slips = active_point.mode == SLIP
        if active_point.mode == OPEN or (slips and mu > 0.0 and not speed > still):
            return False
        slides = slips or mu == 0.0
        closed_point.stays, group.mu[i] = 1, mu
        group.kind[i] = SLIDING if slides else CONE
        closed_point.rows = rows_of(active_point.first_force[0], slides)
        heading, part = active_point.heading, 1.0 / speed if slips and speed > still else 0.0
        heading[0], heading[1], active_point.speed = part * u1, part * u2, speed
    return True


@kernel
def begin_turning(model, data, k, i, push):
    """Write whether a point of rolling or pivoting rotates; return whether it is on a half-space."""
    system, start, group = model.system, data.state, data.group
    contact, closed_point = system.contacts[group.closed[i].contact], group.closed[i]
    _, u1, u2 = contact_velocity(group.points[0][i], start)
    speed = math.sqrt(u1 * u1 + u2 * u2)
    still = max(10.0 * slow(contact, start), model.controls.rest * push * model.controls.step)
    turns = speed > still
    closed_point.stays, group.kind[i], group.mu[i] = 1, SLIDING if turns else CONE, 1.0
    closed_point.rows = turning_rows_given(k, i, group)
    group.heading[i, 0] = u1 / speed if turns else 0.0
    group.heading[i, 1] = u2 / speed if turns else 0.0
    return on_half_space(contact)


@kernel
def turning_rows_given(k, i, group):
    """Return how many rows of a point of rolling or pivoting are given: none where it turns.

    None either where the other points alone keep the body from it: three that press from rolling, two that
    stick from pivoting. Torques are not unique there, and none is one of the solutions.
    """
    if group.kind[i] == SLIDING or group.closed[group.closed[i].parent].rows == 0:
        return 0
    press, stick = 0, 0
    for j in range(k):
        if group.closed[j].turns == 0 and group.closed[j].rows > 0:
            press, stick = press + 1, stick + (1 if group.closed[j].rows == 3 else 0)
    if group.closed[i].turns == 1:
        return 0 if press > 2 else 2
    return 0 if stick > 1 else 1


@kernel
def lasting(model, data, k, h, friction):
    """Return how long an error of the velocity lasts: at most until friction stops the body."""
    system, start, end, group = model.system, data.state, data.work.trial, data.group
    b = group.member[0]
    L, body, before = system.bodies[b].extent, system.bodies[b], start[b]
    for i in range(k):
        if group.closed[i].rows == 3:
            return math.inf
    if kinetic(body, before) - kinetic(body, end[b]) > -1.1 * friction:
        return math.inf
    speed = norm(before.v) + L * norm(before.w)
    loss = speed - norm(end[b].v) - L * norm(end[b].w)
    return h * speed / loss if loss > 0.0 else math.inf


@kernel
def add_forces(model, data, k, s):
    """Write the accelerations of stage s, with the forces of the points; return whether modes stay."""
    system, active, group, work = model.system, data.active, data.group, data.work
    b, points = data.group.member[0], data.group.points[0]
    state, rates = work.stage, work.stages[s]
    place_closed(system, k, state, group, points, work)
    free_rates(system.bodies[b], system.gravity, state[b], rates[b].rate)
    velocities(k, points, state, group.v[U])
    accelerations(k, points, state, rates, group.v[C])
    for i in range(k):
        closed_point = group.closed[i]
        contact = system.contacts[closed_point.contact]
        if contact.touches != 0 and closed_point.turns == 0:
            d = drift_of(
                system, contact, closed_point.feature, closed_point.point, points[i], state, work
            )
            for r in range(3):
                group.v[C][3 * i + r] += d[r]
        if not set_direction(active.points[closed_point.active], i, group):
            return False
    if not forces_of_stage(system, active, k, s, group, work):
        if group.closed[k - 1].turns > 0 or (s > 0 and model.controls.order == 0):
            return False
        inverse_masses_of_one(system.bodies[b], k, points, state, group.m[0])
        solve_forces(model, data, k)
        if not note_given(k, group):
            return False
        spread_all(system, k, points, group.v[P], 1, group.member, state, work)
    accelerate(work.body[b].motion, rates[b].rate)
    return True


@kernel
def forces_of_stage(system, active, k, s, group, work):
    """Write the forces of stage s by the given rows; the first stage has those of the end of the last step."""
    if s > 0:
        return solve_given(system, k, work.stage, group, work)
    for i in range(k):
        active_point, q = active.points[group.closed[i].active], 3 * i
        for r in range(3):
            group.v[P][q + r] = active_point.first_force[r] if group.closed[i].turns == 0 else 0.0
    return solve_as_known(system, k, work.stage, group, work)


@kernel
def set_direction(active_point, i, group):
    """Write the direction in which point i slides; return whether it is about the direction before.

    The direction before is that of the start of the step; of rolling and pivoting, that of the last stage.
    """
    d1, d2 = active_point.heading[0], active_point.heading[1]
    if group.closed[i].turns > 0:
        d1, d2 = group.heading[i, 0], group.heading[i, 1]
    group.heading[i, 0], group.heading[i, 1] = 0.0, 0.0
    if group.kind[i] != SLIDING or group.mu[i] == 0.0:
        return True
    u1, u2 = group.v[U][3 * i + 1], group.v[U][3 * i + 2]
    speed = math.sqrt(u1 * u1 + u2 * u2)
    if not u1 * d1 + u2 * d2 > SAME_WAY * speed:
        return False
    group.heading[i, 0], group.heading[i, 1] = u1 / speed, u2 / speed
    return True


@kernel
def finish_smoothly(model, data, k, h):
    """Move the body to the surfaces; write modes, bounds and forces; return whether the modes have stayed."""
    system, active = model.system, data.active
    end, group, work = data.work.trial, data.group, data.work
    b = group.member[0]
    for row in range(3 * k):
        group.v[BACK][row] = 0.0
    place_at(system, k, 1, end, group, work)
    onto_surfaces(system, active, k, 1, end, group, work)
    place_at(system, k, 1, end, group, work)
    for i in range(k):  # points of rolling and pivoting come after all others
        if group.closed[i].turns > 0:
            group.closed[i].rows = turning_rows_given(k, i, group)
        elif group.closed[i].rows > 0 and group.kind[i] != SLIDING:
            group.closed[i].rows = 3
    onto_tangents(system, k, 1, end, group, work)
    velocities(k, group.points[0], end, group.v[U])
    for row in range(3 * k):
        group.v[P][row] *= h
    finish(model, data, k, h, 1)
    braked, worst = 0.0, 0.0
    for i in range(k):
        braked += group.v[P][3 * i] / system.bodies[b].mass
    for i in range(k):
        if group.closed[i].turns > 0:
            if not turns_on(active, i, group):
                return False
            continue
        active_point, rows = active.points[group.closed[i].active], group.closed[i].rows
        if active_point.next != active_point.mode or active_point.comes_to_rest == 1:
            return False
        if not set_direction(active_point, i, group):
            return False
        u1, u2 = group.v[U][3 * i + 1], group.v[U][3 * i + 2]
        slower = min(active_point.speed, math.sqrt(u1 * u1 + u2 * u2))
        if group.kind[i] == SLIDING and group.mu[i] * braked > STIFF * slower:
            return False
        for r in range(rows):
            worst = max(worst, abs(group.v[U][3 * i + r]))
    work.result[0].residual = max(work.result[0].residual, worst)
    return True


@kernel
def turns_on(active, i, group):
    """Return whether a point of rolling or pivoting still turns, far from its stop, or still does not."""
    u, p, W = group.v[U], group.v[P], group.m[0]
    q = 3 * i
    if group.kind[i] != SLIDING:
        return True
    if not set_direction(active.points[group.closed[i].active], i, group):
        return False
    torque, speed = math.hypot(p[q + 1], p[q + 2]), math.hypot(u[q + 1], u[q + 2])
    return not torque * max(W[q + 1, q + 1], W[q + 2, q + 2]) > STIFF * speed


@kernel
def place_at(system, k, count, state, group, work):
    """Write the points of the bodies of the group in a state, and their W."""
    for m in range(count):
        copy_state(state[group.member[m]], work.stage[group.member[m]])
    place_closed(system, k, state, group, group.points[0], work)
    inverse_masses(system, k, group.points[0], state, work, group.m[0])
