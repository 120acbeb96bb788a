"""A step of joined bodies on several points by the Runge-Kutta method of the run, while modes do not change.

As for one body (`carom.persistent.smooth_step`), with the accelerations and the inverse masses of the system:

    du/dt = W lam + c,    (du/dt)_n = 0 for loaded points, all three rows for those that stick,
                          lam_t = -mu lam_n u_t/|u_t| for those that slip,

one linear system in W at each stage. At its end the bodies return to the joints and to the surfaces. Rolling
and pivoting friction, friction in joints, closed loops and bodies that touch each other have steps of order 2
(`carom.persistent.contact_step`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.closed_points import place_closed
from carom.contact.place import drift_of
from carom.dynamics.acceleration import accelerate, accelerations
from carom.dynamics.adapt import note_miss
from carom.dynamics.explicit import (
    bound_accelerations_of,
    combine_body,
    node,
    note_velocity,
)
from carom.dynamics.project import LOST, project_position, project_velocity
from carom.dynamics.several_points import (
    accelerations as accelerations_of_points,
)
from carom.dynamics.several_points import (
    inverse_masses,
    spread_all,
    velocities,
    yields,
)
from carom.friction import lu
from carom.friction.layout import SLIDING
from carom.impact.workspace import BACK, OLD, C, P, U
from carom.model.arrays import LOOPS, STOP
from carom.model.method import RUNGE_KUTTA
from carom.persistent.finish import finish
from carom.persistent.known_modes import CORRECTIONS, EPS, FITS, PULL
from carom.persistent.return_to_surfaces import onto_surfaces, onto_tangents
from carom.persistent.smooth_step import STIFF, begin, place_at, set_direction


@kernel
def can_be_smooth(system, active, method, k, count, group):
    """Return whether all loaded bodies are in the group, in trees, on the ground or at stops of joints.

    No other body may be in contact at one point: its forces and their work belong to the step before.
    """
    if method.kind != RUNGE_KUTTA or system.solver.kind == LOOPS:
        return False
    if system.relations.frictions.shape[0] > 0:
        return False
    for i in range(k):
        between = (
            group.points[0][i].b >= 0 and system.contacts[group.closed[i].contact].touches != STOP
        )
        if between or group.closed[i].turns > 0:
            return False
    for i in range(active.count[0]):
        if active.points[i].several == 0 and active.points[i].rest == 0:
            return False
    inside = 0
    for m in range(count):
        inside += 1 if system.bodies[group.member[m]].ballistic == 0 else 0
    for b in range(system.bodies.shape[0]):
        inside -= 1 if system.bodies[b].ballistic == 0 else 0
    return inside == 0


@unit
def smooth_group_step(model, data, method, k, count, h) -> bool:
    """Write the end of a step of the bodies of a group, and their errors; return whether modes stay in it."""
    system, active, group, work = model.system, data.active, data.group, data.work
    start, end, result, search = (
        data.state,
        data.work.trial,
        data.work.result[0],
        data.work.search[0],
    )
    u, p, stages, clock = group.v[U], group.v[P], method.b.size, data.clocks[0]
    if not begin(model, data, k):
        return False
    applied, friction = 0.0, 0.0
    for s in range(stages):
        for m in range(count):
            b = group.member[m]
            combine_body(method.A[s], s, h, start[b], work.stages, b, work.stage[b])
            note_velocity(work.stage[b], work.stages[s, b])
        result.time = result.start + h * node(method.A[s], s)
        accelerations(system, work.stage, active, work, work.stages[s])
        applied += h * method.b[s] * result.power
        friction += h * method.b[s] * result.drag
        if not add_forces(model, data, k, count, s):
            return False
        for i in range(k):
            power = p[3 * i + 1] * u[3 * i + 1] + p[3 * i + 2] * u[3 * i + 2]
            friction += h * method.b[s] * power if group.kind[i] == SLIDING else 0.0
    clock.contact_steps, clock.rounds = clock.contact_steps + 1, clock.rounds + stages
    clock.since += 5.0 * k * stages
    for m in range(count):
        b = group.member[m]
        combine_body(method.b, stages, h, start[b], work.stages, b, end[b])
    result.time = result.start + h
    if not finish_smoothly(model, data, k, count, h):
        return False
    if method.E.shape[0] > 0:
        for m in range(count):
            b = group.member[m]
            work.body[b].bound[:3], work.body[b].miss[:3] = 0.0, 0.0
            bound_accelerations_of(work, b, stages)
            note_miss(system, method.E, h, math.inf, b, work)
    # the work on the path without contacts was added before
    result.applied += applied - search.applied
    result.friction += friction - search.friction
    return True


@kernel
def add_forces(model, data, k, count, s):
    """Add the accelerations by the forces of the points in stage s; return whether modes stay."""
    system, active, group, work = model.system, data.active, data.group, data.work
    points, state = group.points[0], work.stage
    place_closed(system, k, state, group, points, work)
    inverse_masses(system, k, points, state, work, group.m[0])
    velocities(k, points, state, group.v[U])
    accelerations_of_points(k, points, state, work.stages[s], group.v[C])
    for i in range(k):
        closed_point = group.closed[i]
        contact = system.contacts[closed_point.contact]
        if contact.touches != 0:
            d = drift_of(
                system, contact, closed_point.feature, closed_point.point, points[i], state, work
            )
            for r in range(3):
                group.v[C][3 * i + r] += d[r]
        if not set_direction(active.points[closed_point.active], i, group):
            return False
    if not solve_given(k, group):
        return False
    spread_all(system, k, points, group.v[P], count, group.member, state, work)
    for m in range(count):
        b = group.member[m]
        accelerate(work.body[b].motion, work.stages[s, b].rate)
    return True


@kernel
def response(group, a, row):
    """Return the effect in row a of a unit force along a given row, with its friction."""
    W, i = group.m[0], row // 3
    if row % 3 > 0 or group.kind[i] != SLIDING:
        return W[a, row]
    d = group.heading[i]
    return W[a, row] - group.mu[i] * (d[0] * W[a, row + 1] + d[1] * W[a, row + 2])


@kernel
def solve_given(k, group):
    """Write the forces that satisfy the given rows to P; return whether they obey Coulomb's law.

    Rows along which no force can move a point (across a hinge) are left out.
    """
    A, L, rows, x = group.m[1], group.cone.matrix, group.cone.active, group.v[OLD]
    p, c, W = group.v[P], group.v[C], group.m[0]
    n, push = 0, 0.0
    for row in range(3 * k):
        p[row], push = 0.0, max(push, abs(c[row]))
        if row % 3 < group.closed[row // 3].rows and yields(W, row):
            rows[n], n = row, n + 1
    for i in range(n):
        for j in range(n):
            A[i, j] = L[i, j] = response(group, rows[i], rows[j])
        q = rows[i] - rows[i] % 3
        L[i, i] += EPS * (W[q, q] + W[q + 1, q + 1] + W[q + 2, q + 2]) / 3.0
    lu.factor(L, n, group.cone.pivot, 0.0)
    for _ in range(CORRECTIONS):
        wrong = 0.0
        for i in range(n):
            x[i] = -c[rows[i]]
            for j in range(3 * k):
                x[i] -= W[rows[i], j] * p[j]
            wrong = max(wrong, abs(x[i]))
        if wrong <= FITS * push:
            return obeys(k, push, group)
        lu.substitute(L, n, group.cone.pivot, x)
        for i in range(n):
            row = rows[i]
            p[row] += x[i]
            if row % 3 == 0 and group.kind[row // 3] == SLIDING:
                for r in range(2):
                    p[row + 1 + r] -= group.mu[row // 3] * group.heading[row // 3, r] * x[i]
    return False


@kernel
def obeys(k, push, group):
    """Return whether no force pulls or leaves its cone, and no point without force approaches."""
    p, a, c, W, most = group.v[P], group.v[OLD], group.v[C], group.m[0], 0.0
    for row in range(3 * k):
        a[row] = c[row]
        for j in range(3 * k):
            a[row] += W[row, j] * p[j]
    for i in range(k):
        most = max(most, p[3 * i])
    for i in range(k):
        q, rows = 3 * i, group.closed[i].rows
        if p[q] < -PULL * most or (rows == 0 and a[q] < -PULL * push):
            return False
        if rows == 3:
            if max(abs(a[q + 1]), abs(a[q + 2])) > PULL * push:
                return False
            if math.hypot(p[q + 1], p[q + 2]) > group.mu[i] * p[q] + PULL * most:
                return False
    return True


@kernel
def finish_smoothly(model, data, k, count, h):
    """Return the bodies to joints and surfaces; write modes and forces; return whether modes have stayed."""
    system, active, group, work = model.system, data.active, data.group, data.work
    end, points = work.trial, group.points[0]
    if not (project_position(system, end, True, 1e-14, work) <= LOST):
        return False
    for row in range(3 * k):
        group.v[BACK][row] = 0.0
    place_at(system, k, count, end, group, work)
    onto_surfaces(system, active, k, count, end, group, work)
    project_velocity(system, end, work)
    place_at(system, k, count, end, group, work)
    for i in range(k):
        if group.closed[i].rows > 0 and group.kind[i] != SLIDING:
            group.closed[i].rows = 3
    onto_tangents(system, k, count, end, group, work)
    velocities(k, points, end, group.v[U])
    for row in range(3 * k):
        group.v[P][row] *= h
    finish(model, data, k, h, count)
    worst, W = 0.0, group.m[0]
    for i in range(k):
        q, active_point, rows = 3 * i, active.points[group.closed[i].active], group.closed[i].rows
        if active_point.next != active_point.mode or active_point.comes_to_rest == 1:
            return False
        if not set_direction(active_point, i, group):
            return False
        u1, u2 = group.v[U][q + 1], group.v[U][q + 2]
        slower = min(active_point.speed, math.hypot(u1, u2))
        braked = group.mu[i] * group.v[P][q] * (W[q + 1, q + 1] + W[q + 2, q + 2])
        if group.kind[i] == SLIDING and braked > STIFF * slower:
            return False
        for r in range(rows):
            if yields(W, q + r):
                worst = max(worst, abs(group.v[U][q + r]))
    work.result[0].residual = max(work.result[0].residual, worst)
    return True
