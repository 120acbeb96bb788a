"""Return of a group of bodies to the surfaces of its active points, and of sticking vertices to their points.

    xi = -P G^T lam,   W lam = phi,    phi: the gap of each loaded point, and for a vertex that sticks also the
                                       tangential displacement from its anchor,

repeated until phi is round-off. Velocities return to the tangents with the same rows. Rows that depend on
others share what removes it, each by its own size (`carom.persistent.settle`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.closed_points import place_closed
from carom.contact.gap import round_off
from carom.contact.groups import members
from carom.contact.operations import rounding
from carom.contact.passed_edges import has_passed
from carom.dynamics.contact_impulse import gain
from carom.dynamics.delassus import spread_all, velocities
from carom.dynamics.project import project_position, shift
from carom.dynamics.thresholds import JOINT_ERROR
from carom.friction import lu
from carom.friction.layout import SLIDING
from carom.geometry.thresholds import REMAINDER, ROUND_OFF, SUM_ERROR
from carom.kinematics.contact_point import in_axes, power_of_surface
from carom.model.actions import MODE_STICK
from carom.model.workspace import CONSTANT, MOTION_POINT
from carom.persistent.by_bodies import factor_by_bodies, knows_arms, rate_of_row, set_alone
from carom.persistent.joint_rows import is_driven
from carom.persistent.settle import add_product, greatest, settle
from carom.persistent.springs import (
    last_torque,
    list_given,
    own,
    place_forces,
    response,
    write_push,
)
from carom.persistent.thresholds import EQUATION_ERROR, PROXIMAL_SPRING


@kernel
def mark_rows(system, active, k, anchored, group):
    """Write how many `rows` each point gives: 0, 1 (its gap), 3 (gap and position); return whether any.

    A point without load gives its gap if that is negative. Positions count if points are `anchored`.
    """
    some = False
    for i in range(k):
        group.closed[i].rows = 0
        if group.closed[i].motion != MOTION_POINT:
            continue
        active_point, p, q = active.points[group.closed[i].active], group.p, 3 * i
        if group.points[0][i].gap < -ROUND_OFF * system.contacts[active_point.contact].extent:
            some = True
            group.closed[i].rows = 1
        if p[q] > 0.0 and not has_passed(active, i, group):
            some = True
            friction = math.sqrt(p[q + 1] * p[q + 1] + p[q + 2] * p[q + 2])
            contact = system.contacts[active_point.contact]
            core = contact.radius == 0.0 and active_point.fixed == 1
            inside = friction < (1.0 - REMAINDER) * group.problem.mu[i] * p[q]
            sticks = active_point.mode == MODE_STICK and inside
            # where it sticks to a surface that moves, its velocity alone is returned
            moves = group.points[0][i].moves == 1
            group.closed[i].rows = 3 if anchored and core and sticks and not moves else 1
    return some


@kernel
def factor_given(k, rubs, group):
    """List the given rows, write W for them, and its factor with compliances; return their number.

    If it `rubs`, an impulse along the normal of a point that slips has its friction.
    """
    n, equations, W = list_given(k, group), group.equations, group.problem.W
    last = last_torque(k, group)
    rows, A, L = equations.rows, equations.A, equations.factor
    if knows_arms(equations):
        for i in range(n):
            compliance = PROXIMAL_SPRING * own(group, rows[i])
            if rubs:
                write_push(last, rows[i], compliance, group)
            else:
                set_alone(equations, rows[i], compliance)
        factor_by_bodies(n, rows, equations)
        return n
    for i in range(n):
        for j in range(n):
            along = response(last, group, rows[i], rows[j]) if rubs else W[rows[i], rows[j]]
            A[i, j] = L[i, j] = along
        L[i, i] += PROXIMAL_SPRING * W[rows[i], rows[i]]
    lu.factor(L, n, equations.pivot, 0.0)
    return n


@kernel
def solve_rows(k, n, tiny, group, x):
    """Replace x, in the n rows, by the impulses that remove it; zero the others; return the error left.

    What is below `tiny` is round-off, which rows that depend on others do not share.
    """
    equations = group.equations
    rows, r = equations.rows, equations.r
    for i in range(n):
        r[i] = -x[rows[i]]
    left = settle(n, 0.0, max(tiny, EQUATION_ERROR * greatest(n, r)), 0.0, 0.0, equations)
    for i in range(3 * k):
        x[i] = 0.0
    for i in range(n):
        x[rows[i]] = equations.x[i]
    return left


@kernel
def onto_surfaces(system, data, k, count, anchored, state):
    """Move the bodies of the group back to the surfaces at the loaded points, which are placed in `state`."""
    group, work, points = data.group, data.work, data.group.points[0]
    if not mark_rows(system, data.active, k, anchored, group):
        return
    n, x = -1, group.back
    for _ in range(11):
        if errors(system, data, k, state):
            break
        n = factor_given(k, False, group) if n < 0 else n
        solve_rows(k, n, round_off(system.contacts[group.closed[0].contact], state), group, x)
        spread_all(system, group.points[0, :k], x, group.bodies.member[:count], state, work)
        for m in range(count):
            shift(work.body[group.bodies.member[m]].motion, 1.0, state[group.bodies.member[m]])
        if system.joints.shape[0] > 0:
            project_position(system, state, False, JOINT_ERROR, work)
        place_closed(system, k, state, group, points, work)


@kernel
def mark_tangents(active, k, group):
    """Write how many rows keep each point on its surface, and at its place if it sticks."""
    for i in range(k):
        closed_point, sticks = group.closed[i], group.problem.kind[i] != SLIDING
        closed_point.rows = 0
        if closed_point.parent == CONSTANT:
            closed_point.rows = 1 if sticks and not is_driven(group, i) else 0
        elif closed_point.motion == MOTION_POINT and group.p[3 * i] > 0.0:
            closed_point.rows = 0 if has_passed(active, i, group) else 3 if sticks else 1


@kernel
def onto_tangents(system, data, k, count):
    """Remove the velocities of the bodies of the group that leave surfaces, or places that stick.

    Return the work of the drives of surfaces by these impulses.
    """
    state, group, work = data.work.trial, data.group, data.work
    mark_tangents(data.active, k, group)
    n, x = factor_given(k, False, group), group.back
    tiny, driven = SUM_ERROR * greatest_speed(system, state, count, group.bodies.member), 0.0
    for _ in range(2):  # W is that of the last stage
        velocities(system, k, group.points[0], state, x)
        solve_rows(k, n, tiny, group, x)
        give(system, k, count, state, group, work)
        for i in range(k):
            driven += power_of_surface(group.points[0][i], state, x[3 * i : 3 * i + 3])
    return driven


@kernel
def note_undetermined(system, data, k, label):
    """Write to stage 3 what forces have changed in a closing step that rows at its end do not determine.

    Stages 0 and 1 have the accelerations at its start and those that made the step. Where rows at the end bind
    all motion (a box whose slip stops on a floor), they give its velocity whatever friction has done in
    between. They do not where the last support opens, and at a dead centre: a corner of a face that falls flat
    on one wall stops on another, and what slides on has other forces from then on. The velocities in
    `work.stage` are lost.
    """
    state, group, work = data.work.stage, data.group, data.work
    count = members(work, label, group.bodies.member)
    for m in range(count):
        b = group.bodies.member[m]
        first, second = work.stages[0, b].rate, work.stages[1, b].rate
        for r in range(3):
            state[b].v[r] = second[r] - first[r]
            state[b].w[r] = second[3 + r] - first[3 + r]
    tiny = SUM_ERROR * greatest_speed(system, state, count, group.bodies.member)
    velocities(system, k, group.points[0], state, group.back)
    for m in range(count):
        b = group.bodies.member[m]
        for r in range(3):
            state[b].v[r], state[b].w[r] = 0.0, 0.0
    velocities(system, k, group.points[0], state, group.u)  # those of surfaces that move
    for i in range(3 * k):
        group.back[i] -= group.u[i]
    mark_tangents(data.active, k, group)
    n = factor_given(k, False, group)
    solve_rows(k, n, tiny, group, group.back)
    spread_all(system, group.points[0, :k], group.back, group.bodies.member[:count], state, work)
    for m in range(count):
        b = group.bodies.member[m]
        left, first, second = work.stages[3, b], work.stages[0, b].rate, work.stages[1, b].rate
        left.speed[:], left.turn[:] = 0.0, 0.0
        for r in range(6):
            left.rate[r] = second[r] - first[r] + work.body[b].motion[r]


@kernel
def onto_sticking(system, data, k, count, after):
    """Remove the slip of points that have begun to stick; return the works of drives and of friction.

    The slip ends `after` this time, or before if it is negative, in which bodies have the forces of slip, in
    RETURN, and not those of stick, in `p`: their difference is an impulse, also at points that slip on or open.
    """
    state, group, work, rubbed = data.work.trial, data.group, data.work, 0.0
    x, u = group.back, group.u
    velocities(system, k, group.points[0], state, u)
    for i in range(k):
        for row in range(3 * i, 3 * i + 3):
            x[row] = after * (x[row] - group.p[row])
    place_forces(k, x, group)
    for i in range(k):  # an impulse does its work at the mean of the velocities before and after it
        for row in range(3 * i + 1, 3 * i + 3):
            if x[row] != 0.0:
                left = velocity_after(k, row, x, group)
                rubbed += 0.5 * x[row] * (u[row] + left)
    give(system, k, count, state, group, work)
    driven = 0.0
    for i in range(k):
        driven += power_of_surface(group.points[0][i], state, x[3 * i : 3 * i + 3])
    return driven + onto_tangents(system, data, k, count), rubbed


@kernel
def velocity_after(k, row, x, group):
    """Return the velocity in a row after the impulses x, whose motion the bodies have (`place_forces`)."""
    if knows_arms(group.equations):
        return group.u[row] + rate_of_row(group.equations.arms[row], group.equations)
    return add_product(group.u[row], 3 * k, group.problem.W[row], x)


@kernel
def greatest_speed(system, state, count, member):
    """Return the greatest speed of the bodies, including that of their rotation at their size."""
    speed = 0.0
    for m in range(count):
        b = member[m]
        for r in range(3):
            turning = system.bodies[b].extent * abs(state[b].w[r])
            speed = max(speed, max(abs(state[b].v[r]), turning))
    return speed


@kernel
def give(system, k, count, state, group, work):
    """Change velocities of a group by the impulses in RETURN; return whether joints pass them on."""
    p, member = group.back, group.bodies.member
    joined = spread_all(system, group.points[0, :k], p, member[:count], state, work)
    for m in range(count):
        gain(work.body[member[m]].motion, state[member[m]])
    return joined


@kernel
def errors(system, data, k, state):
    """Write the errors of all rows (0 for rows not given); return whether all are round-off."""
    group, x, small = data.group, data.group.back, True
    for i in range(k):
        closed_point, point = group.closed[i], group.points[0][i]
        x[3 * i], x[3 * i + 1], x[3 * i + 2] = 0.0, 0.0, 0.0
        if closed_point.rows == 0:
            continue
        active_point = data.active.points[closed_point.active]
        contact = system.contacts[closed_point.contact]
        tiny = rounding(contact, state)
        x[3 * i] = point.gap
        small = small and abs(point.gap) <= tiny
        if group.closed[i].rows == 3:
            c, a, r = state[active_point.body].x, active_point.anchor, point.arm_a
            _, t1, t2 = in_axes(point, c[0] + r[0] - a[0], c[1] + r[1] - a[1], c[2] + r[2] - a[2])
            x[3 * i + 1], x[3 * i + 2] = t1, t2
            small = small and max(abs(t1), abs(t2)) <= tiny
    return small
