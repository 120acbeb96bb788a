"""A bound of the error of a step of order 2 of bodies on several points (`carom.persistent.contact_step`)."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.acceleration import SLIP
from carom.dynamics.adapt import allowed_error
from carom.geometry.rotation import norm
from carom.impact.workspace import P, U


@kernel
def bound_of_step(L, changes, start, h, end):
    """Return the error [m] of a step of order 2; `changes` says that modes change in it.

    The rotation gives L (h w)^3/12, friction with a turning direction h |dv| alpha/12, where alpha is the angle
    between the velocities (v, L w) at both ends, and a stop (the loss of more than half the speed) h |dv|/8.
    """
    turn = abs(h) * max(norm(start.w), norm(end.w))
    before, after = norm(start.v) + L * norm(start.w), norm(end.v) + L * norm(end.w)
    change, alpha = change_of_velocity(L, start, end)
    stop = 0.125 * abs(h) * (before - after) if changes and after < 0.5 * before else 0.0
    return max(max(L * turn * turn, abs(h) * change) * (turn + alpha) / 12.0, stop)


@kernel
def change_of_velocity(L, start, end):
    """Return |dv| of the velocities (v, L w) at both ends, and the sine of the angle between them."""
    change, along, first, last = 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        v, w, dv, dw = start.v[i], L * start.w[i], end.v[i], L * end.w[i]
        along, first, last = (
            along + v * dv + w * dw,
            first + v * v + w * w,
            last + dv * dv + dw * dw,
        )
        change += (dv - v) ** 2 + (dw - w) ** 2
    if not (first > 0.0 and last > 0.0):
        return math.sqrt(change), 0.0
    across = 0.0
    for i in range(3):
        across += (end.v[i] - along / first * start.v[i]) ** 2
        across += (L * (end.w[i] - along / first * start.w[i])) ** 2
    return math.sqrt(change), math.sqrt(across / last)


@kernel
def bound_of_slip(heading, slip, impulse, h, lasts):
    """Return the error, times the mass, of friction whose direction turns within a step.

    That is h p_t |d' - d|/12, and of the velocity p_t |d' - d|^2/8, which lasts for some time: a corner about
    which a body nearly turns changes its direction of slip at an unknown time in the step.
    """
    speed = math.hypot(slip[0], slip[1])
    if not (speed > 0.0 and heading[0] ** 2 + heading[1] ** 2 > 0.0):
        return 0.0
    turn = math.hypot(slip[0] / speed - heading[0], slip[1] / speed - heading[1])
    return impulse * (abs(h) * turn / 12.0 + lasts * turn * turn / 8.0)


@kernel
def time_of_error(L, start, h, end):
    """Return how long an error of the velocity lasts: while a body moves by its size, or until it stops."""
    speed, change = norm(end.v) + L * norm(end.w), change_of_velocity(L, start, end)[0]
    if not speed > 0.0:
        return 0.0
    return min(L / speed, abs(h) * speed / change if change > 0.0 else math.inf)


@kernel
def note_bounds(model, data, k, count, h):
    """Store the errors of bodies of a group in a step of order 2, as their only estimate, and their sizes."""
    system, start, end = model.system, data.state, data.work.trial
    group, work, changes = data.group, data.work, modes_change(data.active, k, data.group)
    for m in range(count):
        b = group.member[m]
        L, miss = system.bodies[b].extent, work.body[b].miss
        miss[0] = max(miss[0], bound_of_step(L, changes, start[b], h, end[b]))
        miss[1], miss[2] = 0.0, max(miss[2], L)
    u, p, lasts = group.v[U], group.v[P], 0.0
    if count == 1:  # of several bodies corners turn all the time
        b = group.member[0]
        lasts = time_of_error(system.bodies[b].extent, start[b], h, end[b])
    for i in range(k):
        point, q = group.points[0][i], 3 * i
        if group.closed[i].turns > 0:
            continue
        slip, friction = (u[q + 1], u[q + 2]), math.hypot(p[q + 1], p[q + 2])
        error = bound_of_slip(group.heading[i], slip, friction, h, lasts)
        work.body[point.a].miss[0] += error / system.bodies[point.a].mass
        if point.b >= 0:
            work.body[point.b].miss[0] += error / system.bodies[point.b].mass


@kernel
def turns_too_far(model, data, count, h):
    """Return whether the rotation at the start alone gives a step of order 2 an error that is not allowed.

    The error is noted: the step is repeated with a shorter length, without its contact problem being solved.
    """
    system, controls, start = model.system, model.controls, data.state
    group, work, far = data.group, data.work, False
    for m in range(count):
        b = group.member[m]
        L, miss = system.bodies[b].extent, work.body[b].miss
        bound = L * (abs(h) * norm(start[b].w)) ** 3 / 12.0
        miss[0], miss[1], miss[2] = max(miss[0], bound), 0.0, max(miss[2], L)
        far = far or bound > allowed_error(controls.rtol, controls.atol, L, miss[2])
    return far


@kernel
def is_better_bounded(model, data, k, h):
    """Return whether for the body of k points a step of order 2 has an allowed error, and its method has not.

    This happens just before a body stops, when the directions of slip turn faster and faster. U and P have the
    velocities and the forces at the end.
    """
    system, controls, active = model.system, model.controls, data.active
    start, end, group, work = data.state, data.work.trial, data.group, data.work
    b, u, p = group.member[0], group.v[U], group.v[P]
    L, miss = system.bodies[b].extent, work.body[b].miss
    allowed = allowed_error(controls.rtol, controls.atol, L, miss[2])
    if miss[0] <= allowed:
        return False
    bound = bound_of_step(L, True, start[b], h, end[b])
    lasts = time_of_error(L, start[b], h, end[b])
    for i in range(k):
        active_point, q = active.points[group.closed[i].active], 3 * i
        if group.closed[i].turns == 0:
            slip, friction = (u[q + 1], u[q + 2]), math.hypot(p[q + 1], p[q + 2])
            error = bound_of_slip(active_point.heading, slip, h * friction, h, lasts)
            bound += error / system.bodies[b].mass
    if bound > allowed:
        return False
    miss[0], miss[1] = 0.0, 0.0
    return True


@kernel
def modes_change(active, k, group):
    """Return whether a point opens, begins to slip or stops in a step, or its body comes to rest."""
    for i in range(k):
        active_point, closed_point = active.points[group.closed[i].active], group.closed[i]
        stops = active_point.mode == SLIP and closed_point.stopped == 1
        if active_point.next != active_point.mode or active_point.comes_to_rest == 1 or stops:
            return True
    return False
