"""A step of bodies in contact at several points: midpoint rows carry the impulse, end rows the constraint.

The step without the contacts is known (any method). With the impulses p of all k points,

    pi_1 = pi_free + G_0^T p,    v_1 = M(q_1)^-1 pi_1,    q_1 = Exp_q_free(h/2 P G_0^T p), then gap_i = 0,
    w = G_1 v_1,    0 <= p_n _|_ w_n >= 0,    p_t in -mu p_n d|w_t|,

with G_0 at the middle of the step, G_1 at its end, and momenta pi about each centre in world axes. For a point
that slips during the whole step, the direction of friction is that of the velocity at the middle of the step;
if slip has stopped, Coulomb's law holds with the velocity at the end. Each iteration uses the symmetric W = G_0
P G_0^T to solve for

    w = w(p_old) + W (p - p_old),

so the fixed point is exact. Order 2. (Mathematics page, §3.1.)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.closed_points import gather_active, place_closed
from carom.contact.groups import members
from carom.dynamics.acceleration import SLIP
from carom.dynamics.elements import driven_power
from carom.dynamics.explicit import copy_state
from carom.dynamics.forces import difference_of_loads
from carom.dynamics.kick import add_momentum
from carom.dynamics.project import carry_velocity, shift
from carom.dynamics.rotors import add_rates, note_rates
from carom.dynamics.several_points import (
    any_turns,
    inverse_masses,
    of_one_body,
    spread_all,
    velocities,
)
from carom.dynamics.solve import solve
from carom.friction.layout import BUDGET, CONE, ENOUGH, NEAR
from carom.friction.residual import measure
from carom.friction.solve import solve_cones
from carom.geometry.rotation import rotate, rotate_back
from carom.impact.workspace import BACK, OLD, C, P, U
from carom.kinematics.contact_point import contact_velocity
from carom.model.allowance import affordable
from carom.model.method import RUNGE_KUTTA
from carom.persistent.error_bound import (
    is_better_bounded,
    note_bounds,
    turns_too_far,
)
from carom.persistent.finish import finish, forces_at_end, gained
from carom.persistent.middle_state import halfway, mean_velocity, power_of_path, spin_momentum
from carom.persistent.return_to_surfaces import onto_surfaces
from carom.persistent.rolling_friction import bound_turning, first_torque
from carom.persistent.slide import GOES_ON, NOT, forget_stops, slide_step
from carom.persistent.smooth_group import can_be_smooth, smooth_group_step
from carom.persistent.smooth_step import note_error, smooth_step
from carom.persistent.step_control import (
    charge_iterations,
    iterations_left,
    plain_step,
    unnamed,
)

ROUNDS = 50
CONVERGED = 1e-14  # relative change of velocities by a round that is the last
# while rounds change them by more than FAR they need no forces better than ROUGH, but W anew; then W stays: the
# fixed point does not depend on it
FAR, ROUGH = 1e-4, 1e-8
# of a body alone, whose motion is unique though forces are not: how well the first round solves for these, and
# the others as a part of what the last has changed
FIRST, PART = 1e-5, 1e-4
ROUND = 1.0  # of a round of joined bodies, by a step without contacts


@unit
def contact_step(model, data, method, h):
    """Correct the step from `start` to `end` of all bodies that are in contact at several points.

    The forces at the end are written to the active points; the work of friction and of loads, and a status, to
    `work.result`.
    """
    active, work = data.active, data.work
    result = work.result[0]
    result.applied, result.friction, result.code = 0.0, 0.0, 0
    result.residual, result.unnamed = 0.0, 0.0
    for i in range(active.count[0]):
        active_point = active.points[i]
        label = work.body[active_point.body].label
        if active_point.several == 0 or active_point.rest == 1 or seen(active, i, label, work):
            continue
        step_group(model, data, method, label, h)
        if result.code != 0:
            return


@kernel
def step_group(model, data, method, label, h):
    """Correct the step of one group; for a single body with constant modes by the method of the run."""
    system, controls, active = model.system, model.controls, data.active
    start, end, group, work = data.state, data.work.trial, data.group, data.work
    result = work.result[0]
    k = gather_active(system, active, label, start, group, work)
    count = members(work, label, group.member)
    loaded = False
    for m in range(count):
        b = group.member[m]
        copy_state(end[b], group.flight[b])
        loaded = loaded or system.bodies[b].ballistic == 0
    alone = of_one_body(system, k, group.points[0]) and not loaded
    alone = alone and method.kind == RUNGE_KUTTA
    friction, over = result.friction, result.unnamed
    slid = slide_step(model, data, method, k, h) if alone else NOT
    smooth = slid != NOT or (alone and smooth_step(model, data, method, k, h))
    joined = loaded and can_be_smooth(system, active, method, k, count, group)
    if joined:
        smooth = smooth_group_step(model, data, method, k, count, h)
    if smooth and alone:
        forces_at_end(model, data, k, True, end)
        if slid == GOES_ON:
            forget_stops(active, k, group)
        if slid != NOT or controls.order == 0:
            return
        note_error(model, data, method, k, h, result.friction - friction)
        if not is_better_bounded(model, data, k, h):
            return
        smooth = False
    if not smooth:
        result.friction, result.unnamed = friction, over
        for m in range(count):
            copy_state(group.flight[group.member[m]], end[group.member[m]])
        free = controls.order > 0 and work.search[0].active == 0  # to choose the length of the step
        if free and turns_too_far(model, data, count, h):
            return
        if alone or joined:
            place_closed(system, k, start, group, group.points[0], work)
        step_once(model, data, k, count, loaded, h)
        if controls.order > 0:
            note_bounds(model, data, k, count, h)
    forces_at_end(model, data, k, False, end)


@kernel
def seen(active, i, label, work):
    """Return whether an earlier active point belongs to the same group."""
    for j in range(i):
        if work.body[active.points[j].body].label == label:
            return True
    return False


@kernel
def step_once(model, data, k, count, loaded, h):
    """Correct the step of one group of k points and `count` bodies to order 2."""
    system, controls, clock = model.system, model.controls, data.clocks[0]
    start, end, group, work = data.state, data.work.trial, data.group, data.work
    begin(model, data, k, h, count, loaded)
    loads, rubbing = power_of_path(system, h, start, end, work) if loaded else (0.0, 0.0)
    before, single = math.inf, of_one_body(system, k, group.points[0])
    single = single and not any_turns(k, group.points[0])
    clock.contact_steps += 1
    for turn in range(ROUNDS):
        # where impulses are not unique: those of least norm, then those near them
        group.cone.count[NEAR] = min(turn, 1)
        for m in range(count):
            halfway(start[group.member[m]], end[group.member[m]], work.stage[group.member[m]])
        place_closed(system, k, work.stage, group, group.points[0], work)
        far = before > FAR
        if turn < 2 or far:
            inverse_masses(system, k, group.points[0], work.stage, work, group.m[0])
        impose(model, data, k, h, count, loaded)
        for m in range(count):
            mean_velocity(start[group.member[m]], end[group.member[m]], work.stage[group.member[m]])
        pose(k, start, group, work)
        bound_turning(system, k, group)
        enough = ROUGH if turn > 0 and far else 0.0
        if single:
            enough = FIRST if turn == 0 else PART * before
        change = find_impulses(model, data, k, enough)
        if enough > 0.0 and change <= CONVERGED:  # good enough as they were: or the solution?
            change = find_impulses(model, data, k, 0.0)
        if change <= CONVERGED or (change <= 1e-7 and change >= 0.3 * before):
            break
        if controls.retry == 1 and clock.effort > affordable(controls, clock):
            break  # to be given up, where there is another way
        before = change
        clock.rounds += 1
        clock.effort += ROUND * plain_step(system) if loaded else 0.0
    group.cone.count[NEAR], group.cone.mismatch[ENOUGH] = 0, 0.0
    driven = impose(model, data, k, h, count, loaded)
    check(model, data, k, count)
    friction = finish(model, data, k, h, count)
    work.result[0].friction += friction
    if loaded:
        taken, rubbed = power_of_path(system, h, start, end, work)
        work.result[0].applied += driven + h / 6.0 * (taken - loads)
        work.result[0].friction += h / 6.0 * (rubbed - rubbing)
    else:
        over = unnamed(system, controls, start, end, friction, count, group.member)
        work.result[0].unnamed = max(work.result[0].unnamed, over)


@kernel
def find_impulses(model, data, k, enough):
    """Solve for the impulses of an iteration, to `enough` (0: to round-off); return their relative change."""
    controls = model.controls
    group, clock = data.group, data.clocks[0]
    group.cone.mismatch[ENOUGH] = enough
    group.cone.count[BUDGET] = iterations_left(controls, clock, k)
    _, _, iterations = solve_cones(
        k, group.m[0], group.v[C], group.mu, group.kind, group.heading, group.v[P],
        group.cone,
    )  # fmt: skip
    charge_iterations(clock, k, iterations)
    clock.since += 5.0 * k
    return moved(3 * k, group)


@kernel
def check(model, data, k, count):
    """Compute the residual of the contact law for the impulses and velocities, independent of the solver.

    The velocities are those of the bodies: w(p) = W p + c with the c of one more iteration.
    """
    system = model.system
    start, end, group, work = data.state, data.work.trial, data.group, data.work
    for m in range(count):
        b = group.member[m]
        mean_velocity(start[b], end[b], work.stage[b])
    pose(k, start, group, work)
    bound_turning(system, k, group)
    found = measure(k, group.m[0], group.v[C], group.mu, group.kind, group.heading, group.v[P])
    if not found[0] <= work.result[0].residual:
        work.result[0].residual = found[0]


@kernel
def moved(n, group):
    """Return the effect of the last change of p on the velocities, relative to the effect of p.

    The forces themselves may continue to change if they are not unique.
    """
    change, largest = 0.0, 0.0
    for i in range(n):
        s, t = 0.0, 0.0
        for j in range(n):
            s += group.m[0][i, j] * (group.v[P][j] - group.v[OLD][j])
            t += abs(group.m[0][i, j] * group.v[P][j])
        change, largest = max(change, abs(s)), max(largest, t)
    return change / largest if largest > 0.0 else 0.0


@kernel
def begin(model, data, k, h, count, loaded):
    """Store the directions of slip, and the last forces as a first guess."""
    system, controls = model.system, model.controls
    active, start, end, group, work = (
        data.active,
        data.state,
        data.work.trial,
        data.group,
        data.work,
    )
    if loaded:  # springs may lead to any body
        for b in range(start.shape[0]):
            halfway(start[b], end[b], work.stage[b])
            halfway(start[b], end[b], work.middle[b])
    still = controls.rest * gained(start, count, group) * controls.step / h
    for i in range(3 * k):
        group.v[BACK][i] = 0.0
    for i in range(k):
        closed_point = group.closed[i]
        active_point = active.points[closed_point.active]
        _, u1, u2 = contact_velocity(group.points[0][i], start)
        speed = math.sqrt(u1 * u1 + u2 * u2)
        if closed_point.turns == 0:
            group.mu[i] = system.contacts[active_point.contact].friction_held
            for r in range(3):
                group.v[P][3 * i + r] = h * active_point.first_force[r]
            slips, active_point.speed = active_point.mode == SLIP and speed > 0.0, speed
        else:
            group.mu[i] = 1.0
            first_torque(system, active_point, i, h, group)
            slips = speed > still
        stop = active_point.first_stop[closed_point.turns]
        group.heading[i, 0] = u1 / speed if slips else 0.0
        group.heading[i, 1] = u2 / speed if slips else 0.0
        group.kind[i] = CONE
        closed_point.stopped = 0 if slips and stop > h * (1.0 + 1e-9) else 1


@kernel
def any_joined(system, count, member):
    """Return whether a body of the group has a joint."""
    for m in range(count):
        if system.bodies[member[m]].isolated == 0:
            return True
    return False


@kernel
def impose(model, data, k, h, count, loaded):
    """Move `end` by the impulses p of the rows at the middle of the step; write u = G_1 v_1.

    Return the work of drivers: in response to p, and in the return to the joints.
    """
    system = model.system
    active, end, group, work = data.active, data.work.trial, data.group, data.work
    member, flight, result, driven = group.member, group.flight, work.result[0], 0.0
    spread_all(system, k, group.points[0], group.v[P], count, member, work.stage, work)
    joined = system.joints.shape[0] > 0 and any_joined(system, count, member)
    if joined:
        result.time = result.start + 0.5 * h
        note_rates(system, flight)
        add_rates(system, work.stage, work)
        driven += driven_power(system, work.stage, work)  # of an impulse: its work
        result.time = result.start + h
    for m in range(count):
        b = member[m]
        motion, push = work.body[b].motion, work.body[b].push
        for i in range(6):
            push[i] = 0.0
        add_momentum(system.bodies[b], work.stage[b].Q, 1.0, work.body[b])
        for i in range(6):
            motion[i] *= 0.5 * h
        copy_state(flight[b], end[b])
        shift(motion, end[b])
    if loaded:
        add_difference(system, h, count, joined, group, work)
    onto_surfaces(system, active, k, count, end, group, work)
    for m in range(count):
        b = member[m]
        body, push, J = system.bodies[b], work.body[b].push, system.bodies[b].inertia
        v, w, q = end[b].v, end[b].w, end[b].Q
        l = spin_momentum(body, flight[b].Q, flight[b].w[0], flight[b].w[1], flight[b].w[2])
        for i in range(3):
            v[i] = flight[b].v[i] + push[i] / body.mass
        a = rotate_back(q[0], q[1], q[2], q[3], l[0] + push[3], l[1] + push[4], l[2] + push[5])
        w[0], w[1], w[2] = rotate(q[0], q[1], q[2], q[3], a[0] / J[0], a[1] / J[1], a[2] / J[2])
    if joined:
        carry_velocity(system, end, work)
        driven += driven_power(system, end, work)
    place_closed(system, k, end, group, group.points[1], work)
    velocities(k, group.points[1], end, group.v[U])
    return driven


@kernel
def add_difference(system, h, count, joined, group, work):
    """Add to the push the effect of applied forces on the actual path minus that on the path without contacts.

    It is computed with the joints, because the effect of a torque on a single light body would lose all its
    digits in the projection.
    """
    difference_of_loads(system, h, work.stage, work.middle, work)
    if joined:
        solve(system, work.stage, False, work)
        add_rates(system, work.stage, work)
    for m in range(count):
        b = group.member[m]
        if joined:
            add_momentum(system.bodies[b], work.stage[b].Q, 1.0, work.body[b])
            continue
        for i in range(6):
            work.body[b].push[i] += work.body[b].wrench[i]


@kernel
def pose(k, start, group, work):
    """Write c = w(p_old) - W p_old of the contact problem, with the slip for the friction of each point.

    If a point continues to slip, this slip is twice the velocity at the middle of the step, G_0 (v_0 + v_1);
    otherwise it is that at the end. (With friction along the slip of the last iteration, the iteration would
    not converge at speeds below mu N h W_tt.)
    """
    for i in range(k):
        w, point, q = group.v[U], group.points[0][i], 3 * i
        c = (w[q], w[q + 1], w[q + 2])
        if group.closed[i].stopped == 0:
            _, m1, m2 = contact_velocity(point, work.stage)
            d1, d2 = group.heading[i, 0], group.heading[i, 1]
            if m1 * d1 + m2 * d2 > 0.0 and w[q + 1] * d1 + w[q + 2] * d2 > 0.0:
                c = (w[q], 2.0 * m1, 2.0 * m2)
            else:
                group.closed[i].stopped = 1
        for r in range(3):
            s = c[r]
            for j in range(3 * k):
                s -= group.m[0][q + r, j] * group.v[P][j]
            group.v[C][q + r] = s
    for i in range(3 * k):
        group.v[OLD][i] = group.v[P][i]
