"""The three members of the contact step: explicit, implicit, and implicit of one stage.

All step the bodies of a group along one right-hand side (`carom.persistent.rows`) from `data.state` to
`work.trial`. Stage 0, at the start, is known (`carom.persistent.contact_step`).

explicit    the method of the run, with given modes (`carom.persistent.springs`)
implicit    L-stable, of order 4: Coulomb's law at the velocity of each stage (`carom.persistent.coulomb_stage`)
closing     implicit Euler, a stiff method of one stage; with impulses, like Moreau.s, where it has none

Each returns the number of points at the end, 0 if it has not made the step, and the work of loads and of
friction.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.delassus import inverse_masses, velocities
from carom.dynamics.explicit import (
    add_stages,
    combine_body,
    copy_state,
    node,
    note_velocity,
    stages_within,
)
from carom.friction.layout import (
    BUDGET,
    CONE,
    DISC,
    ENOUGH,
    ITERATIONS,
    SLIDING,
)
from carom.friction.solve import solve_cones
from carom.friction.strategy import budget
from carom.geometry.rotation import multiply, normalize
from carom.geometry.thresholds import ROUND_OFF
from carom.law.piecewise import any_depends_on_speed
from carom.model.workspace import CONSTANT, MOTION_POINT
from carom.persistent.adhesion import pull_rows
from carom.persistent.by_bodies import knows_arms
from carom.persistent.coulomb_stage import solve_stage
from carom.persistent.joint_load import has_loads, hold, renew_loads
from carom.persistent.joint_rows import is_by_load
from carom.persistent.memory import is_torque, slip_at_start
from carom.persistent.rolling_friction import bound_turning
from carom.persistent.rows import (
    PASSED,
    SAME,
    accelerate_freely,
    bodies_of,
    push_bodies,
    set_modes,
    write_rows,
)
from carom.persistent.slip_law import renew_modes
from carom.persistent.springs import bound_per_force, moves_freely, solve_springs
from carom.persistent.start import first_modes
from carom.persistent.stops import locates, pass_stops
from carom.persistent.thresholds import EQUATION_ERROR, LAST_CHANGE, POSE_SHARE, STAGE_CHANGE

FIXED_POINT = 25  # iterations of the pose of a stage


@kernel
def falls_as_one(k, count, data):
    """Return whether free bodies with k points fall as one, so that no stage has a force.

    They touch each other alone, have one velocity, do not turn, and no point accelerates at the start.
    """
    state, group = data.state, data.group
    first = state[group.bodies.member[0]].v
    for m in range(count):
        v, w = state[group.bodies.member[m]].v, state[group.bodies.member[m]].w
        for r in range(3):
            if v[r] != first[r] or w[r] != 0.0:
                return False
    for i in range(k):
        if group.points[0][i].b < 0:
            return False
    return moves_freely(k, group)


@kernel
def explicit_member(model, data, method, label, h, first):
    """Make the stages of the method of the run; return the number of points at its last one, 0 if modes end.

    `first` has the number of points in stage 0, and the powers of loads and of friction. Return their work too.
    """
    start, end, group, work = data.state, data.work.trial, data.group, data.work
    (count, loaded), moment, (k, powers) = bodies_of(model, data, label), work.moment[0], first
    applied, friction = h * method.b[0] * powers[0], h * method.b[0] * powers[1]
    least = PASSED if locates(model, data) else SAME
    falls = not loaded and falls_as_one(k, count, data)
    for s in range(1, stages_within(method)):
        for m in range(count):
            b = group.bodies.member[m]
            combine_body(method.A[s, :s], h, start[b], work.stages, b, work.stage[b])
            note_velocity(work.stage[b], work.stages[s, b])
        moment.time = moment.start + h * node(method.A[s, :s])
        power = accelerate_freely(model, data, loaded, count, s)
        if falls:
            continue
        k = write_rows(model, data, label, s)
        if set_modes(model.system, data.active, k, group) < least or not solve_springs(k, group):
            return 0, 0.0, 0.0
        driven, rubbed = push_bodies(model, data, loaded, k, count, s)
        applied += h * method.b[s] * (power + driven)
        friction += h * method.b[s] * rubbed
    weights = method.b[: stages_within(method)]
    for m in range(count):
        b = group.bodies.member[m]
        combine_body(weights, h, start[b], work.stages, b, end[b])
    moment.time = moment.start + h
    return k, applied, friction


@kernel
def implicit_member(model, data, method, label, h, powers):
    """Make the stages of a stiff method; return the number of points at the end, 0 if one is not solved.

    `method` is its matrix, and whether it closes: then it has impulses where its stage has no solution.
    `powers` are those of loads and of friction in stage 0. Return their work too.
    """
    start, end, group, work = data.state, data.work.trial, data.group, data.work
    (A, closes), moment, k = method, work.moment[0], 0
    stages = A.shape[0]
    first = h * A[stages - 1, 0]
    applied, friction = first * powers[0], first * powers[1]
    count, _ = bodies_of(model, data, label)
    for s in range(1, stages):
        for m in range(count):
            b = group.bodies.member[m]
            add_stages(A[s, :s], h, start[b], work.stages, b, group.bodies.base[b])
            for r in range(6):
                work.stages[s, b].rate[r] = work.stages[s - 1, b].rate[r]
        moment.time = moment.start + h * node(A[s, : s + 1])
        k, power, rubbed = implicit_stage(model, data, label, s, h * A[s, s], closes)
        if k < 0:
            return 0, 0.0, 0.0
        applied += h * A[stages - 1, s] * power
        friction += h * A[stages - 1, s] * rubbed
    for m in range(count):
        b = group.bodies.member[m]
        copy_state(work.stage[b], end[b])
    return k, applied, friction


@kernel
def implicit_stage(model, data, label, s, hg, closes):
    """Solve for stage s in `work.stage`, from `group.bodies.base` without it.

    Return the number of points, -1 if there is no solution, and the powers of loads and of friction.
    """
    group, work, (count, loaded) = data.group, data.work, bodies_of(model, data, label)
    k, change, rough, power, rubbed = -1, 0.0, 0.0, 0.0, 0.0
    iterations = group.equations.iterations
    iterations[0], laws, turned = 0, any_depends_on_speed(model.system.laws), False
    if laws:
        first_modes(model.system, data, label)
    for m in range(count):
        copy_state(group.bodies.base[group.bodies.member[m]], work.stage[group.bodies.member[m]])
    for turn in range(FIXED_POINT):
        last, change, size = change, 0.0, 0.0
        for m in range(count):
            b = group.bodies.member[m]
            length, stage = model.system.bodies[b].extent, work.stages[s, b]
            own = move_stage(group.bodies.base[b], hg, length, stage, work.stage[b])
            change, size = max(change, own[0]), max(size, own[1])
        if change > 0.0:  # a body that stops has errors of the others
            change = change / size if size > 0.0 else math.inf
        # what the next iteration would change, if it changes by the same part of that of this one
        left = change * change / last if turn > 1 and change < last < math.inf else change
        settled = left <= LAST_CHANGE or (change <= ROUND_OFF and change >= 0.5 * last)
        settled = settled and rough <= EQUATION_ERROR
        rough = POSE_SHARE * change if turn > 0 and change < math.inf else 0.0
        if turn > 0 and settled and not turned:  # it is round-off, which grows with the forces
            break
        applied = accelerate_freely(model, data, loaded, count, s)
        before = k
        k = write_rows(model, data, label, s)
        for m in range(count):
            b = group.bodies.member[m]
            copy_state(
                work.stage[b], group.bodies.free[b]
            )  # its place: a surface may turn beneath it
            add_velocity(group.bodies.base[b], hg, work.stages[s, b], group.bodies.free[b])
        velocities(model.system, k, group.points[0], group.bodies.free, group.u)
        pull_rows(k, hg, group, group.u)
        if k != before:
            for row in range(3 * k):
                group.p[row] = 0.0
        lost, struck = iterations[0], False
        for i in range(k):
            group.closed[i].passes = 0
        known = k == before, rough
        if (closes and lost >= budget(k)) or not solve_beyond(model, data, k, known, hg, closes):
            if not closes or k > group.idle.shape[1]:  # impulses have full matrices
                return -1, 0.0, 0.0
            solve_impulses(model, data, k, hg)
            struck = True
        else:
            iterations[0] = lost
        if laws:
            turned = renew_modes(model, data.active, k, hg, turn, group)
        for i in range(k):  # the work of friction of all points: what sticks has no velocity
            group.problem.kind[i] = SLIDING
        velocities(model.system, k, group.points[0], work.stage, group.u)
        driven, rubbed = push_bodies(model, data, loaded, k, count, s)
        rubbed += power_of_locks(model.system, data.active, k, group) if struck else 0.0
        power = applied + driven
    if model.controls.order > 0 and not closes and not change <= STAGE_CHANGE:
        return -1, 0.0, 0.0
    return k, power, rubbed


@kernel
def solve_beyond(model, data, k, known, hg, closes):
    """Solve a stage, beyond stops that are to be located as if slip went on; return whether this is done.

    What is `known` of its forces is as in `solve_stage`.
    """
    if not solve_stage(k, hg, known, data.group):
        return False
    if not closes and locates(model, data):
        while pass_stops(model, data, k, hg):
            if not solve_stage(k, hg, (True, known[1]), data.group):
                return False
    return True


@kernel
def add_velocity(base, hg, stage, out):
    """Write the velocities base + h g a."""
    for r in range(3):
        out.v[r] = base.v[r] + hg * stage.rate[r]
        out.w[r] = base.w[r] + hg * stage.rate[3 + r]


@kernel
def move_stage(base, hg, length, stage, out):
    """Write the state base + h g times its own derivative; return change and size of its velocities.

    `length` is the size of the body, at which rotation counts. The attitude has the equation of the stage in
    R^4, Q = Q_base + h g/2 (0, w) Q, exactly: with a = h g/2 (0, w), Q = (1 + a) Q_base/(1 + |a|^2). An
    iterate, or a base of length 1, would leave an error of order h^3 that no estimate sees.
    """
    size, change = 0.0, 0.0
    for r in range(3):
        v, w = base.v[r] + hg * stage.rate[r], base.w[r] + hg * stage.rate[3 + r]
        change = max(change, max(abs(v - out.v[r]), length * abs(w - out.w[r])))
        size = max(size, max(abs(v), length * abs(w)))
        size = max(size, max(abs(base.v[r]), length * abs(base.w[r])))
        out.v[r], out.w[r] = v, w
        out.x[r] = base.x[r] + hg * v
    w, Q, B = out.w, out.Q, base.Q
    a0, a1, a2 = 0.5 * hg * w[0], 0.5 * hg * w[1], 0.5 * hg * w[2]
    q0, q1, q2, q3 = multiply((1.0, a0, a1, a2), (B[0], B[1], B[2], B[3]))
    f = 1.0 / (1.0 + a0 * a0 + a1 * a1 + a2 * a2)
    Q[0], Q[1], Q[2], Q[3] = f * q0, f * q1, f * q2, f * q3
    note_velocity(out, stage)
    Q[0], Q[1], Q[2], Q[3] = normalize((Q[0], Q[1], Q[2], Q[3]))
    return change, size


@kernel
def power_of_locks(system, active, k, group):
    """Return what friction by load takes beside its power at the end, where impulses end its slip.

    The work of an impulse is that at the mean of the velocities before and after it.
    """
    power = 0.0
    for i in range(k if has_loads(group) else 0):
        if is_by_load(i, group):
            _, d, _, speed = slip_at_start(system, active, group.closed[i])
            power += 0.5 * group.p[3 * i + 1] * (d * speed - group.u[3 * i + 1])
    return power


@kernel
def bound_joints(k, h, group):
    """Write the greatest impulses in a time h of dry friction in joints."""
    for i in range(k):
        if group.closed[i].parent == CONSTANT:
            group.problem.heading[i, 0] = h * group.problem.mu[i]


@kernel
def solve_impulses(model, data, k, h):
    """Write forces `p` under which Coulomb's law holds with the velocities h W p + u."""
    group, p = data.group, data.group.p
    count = group.cone.count
    if knows_arms(group.equations):
        points, work = group.points[0], data.work
        inverse_masses(model.system, k, points, work.stage, work, group.problem.W)
    for i in range(3 * k):
        p[i] = 0.0
        group.problem.c[i] = group.u[i]
    turning = False
    for i in range(k):
        group.problem.kind[i] = CONE
        if group.closed[i].parent == CONSTANT:
            group.problem.kind[i] = DISC
        elif group.closed[i].motion != MOTION_POINT:
            group.problem.mu[i], turning = 1.0, True
    group.cone.mismatch[ENOUGH], count[BUDGET] = 0.0, budget(k)
    hold(k, h, group)
    bound_joints(k, h, group)
    for turn in range(50 if turning or has_loads(group) else 1):
        change = bound_turning(model.system, k, group)
        solve_cones(k, group.problem, p, group.cone)
        group.equations.iterations[0] += count[ITERATIONS]
        renewed = renew_loads(k, 1.0 / h, False, turn, group)
        bound_joints(k, h, group)
        if not (turning and change > LAST_CHANGE) and not renewed:
            break
    for i in range(k):
        if is_torque(group.closed[i]):
            group.problem.mu[i] = bound_per_force(model.system, group.points[0][i], group.closed[i])
    for i in range(3 * k):
        p[i] /= h
