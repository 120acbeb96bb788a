"""A step of one body on several points to order 4: extrapolated from a whole step and two halves.

The step of `carom.persistent.contact_step` is of order 2, and as long as the same points press, slip and stick
its error goes with even powers of h. With the end q' of a whole step and q'' of two halves (Richardson 1911),

    q = Exp_q''(log(q'' q'^-1)/3),    v = v'' + (v'' - v')/3,

brought back to the surfaces. q'' itself is off by d = |q'' - q'|/3; what is left after the extrapolation is
about d theta^2, theta the part of a radian by which the body, or its velocity, turns in the step. (Mathematics
page, VI.1.)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.closed_points import place_closed
from carom.dynamics.acceleration import SLIP
from carom.dynamics.explicit import copy_state
from carom.dynamics.several_points import inverse_masses
from carom.geometry.rotation import exp, log, multiply, norm, normalize
from carom.impact.workspace import BACK, P
from carom.persistent.return_to_surfaces import onto_surfaces, onto_tangents

SAFE = 3.0  # how much more than estimated the error is taken for
WHOLE, BEGIN = range(2)  # states that are kept: the end of the whole step, and its beginning


@kernel
def bound_of_step(L, changes, start, h, end):
    """Return the error [m] of a step of order 2, in which modes change or not.

    Of its turn, L (h w)^3/12; of friction whose direction turns, h |dv| alpha/12, alpha being the angle between
    the velocities (v, L w) at both ends; of a stop inside, h |dv|/8, where half the speed is lost.
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
def note_bounds(system, changes, h, start, end, count, group, work):
    """Keep the errors of the bodies of a group in a step of order 2, and their sizes."""
    for m in range(count):
        b = group.member[m]
        L, miss = system.bodies[b].extent, work.body[b].miss
        miss[0] = max(miss[0], bound_of_step(L, changes, start[b], h, end[b]))
        miss[2] = max(miss[2], L)


@kernel
def same_modes(active, k, group):
    """Return a number for what the points do in a step (press, slip, stick); -1 if a mode changes in it."""
    pattern = 1
    for i in range(k):
        active_point, closed_point = active.points[group.closed[i].active], group.closed[i]
        stops = active_point.mode == SLIP and closed_point.stopped == 1
        if active_point.next != active_point.mode or active_point.comes_to_rest == 1 or stops:
            return -1
        pattern = (pattern * 7 + 2 * closed_point.rows + closed_point.stopped) % 1000003
    return pattern


@kernel
def guess_forces(active, k, part, group):
    """Let the next step begin with the mean forces of the last; with `part` < 0, of what a first half left.

    The impulses of the last step times `part` are its mean forces.
    """
    for i in range(k):
        force = active.points[group.closed[i].active].force
        for r in range(3):
            mean = abs(part) * group.v[P][3 * i + r]
            force[r] = mean if part > 0.0 else 2.0 * force[r] - mean


@kernel
def extrapolate(system, active, k, h, start, end, group, work):
    """Put the end of a step of two halves where the extrapolation has it; return the error that is left [m]."""
    b = group.member[0]
    one, two, L = group.kept[WHOLE], end[b], system.bodies[b].extent
    q, p = two.Q, one.Q
    t = multiply(q[0], q[1], q[2], q[3], p[0], -p[1], -p[2], -p[3])
    a = log(t[0], t[1], t[2], t[3])
    r = exp(a[0] / 3.0, a[1] / 3.0, a[2] / 3.0)
    away, faster = L * norm(a), 0.0
    t = multiply(r[0], r[1], r[2], r[3], q[0], q[1], q[2], q[3])
    q[0], q[1], q[2], q[3] = normalize(t[0], t[1], t[2], t[3])
    x, v, w = 0.0, 0.0, 0.0
    for i in range(3):
        dx, dv, dw = two.x[i] - one.x[i], two.v[i] - one.v[i], two.w[i] - one.w[i]
        x, v, w = x + dx * dx, v + dv * dv, w + dw * dw
        two.x[i] += dx / 3.0
        two.v[i] += dv / 3.0
        two.w[i] += dw / 3.0
    away, faster = max(away, math.sqrt(x)), max(math.sqrt(v), L * math.sqrt(w))
    copy_state(two, work.stage[b])
    place_closed(system, k, end, group, group.points[0], work)
    inverse_masses(system, k, group.points[0], work.stage, work, group.m[0])
    for i in range(3 * k):
        group.v[BACK][i] = 0.0
    onto_surfaces(system, active, k, 1, end, group, work)
    onto_tangents(system, active, k, end, group, work)
    return left_over(L, h, group.kept[BEGIN], two, away, faster)


@kernel
def left_over(L, h, start, end, away, faster):
    """Return d theta^2 [m]; errors of the velocity count as in `carom.dynamics.adapt`."""
    turn = abs(h) * max(norm(start.w), norm(end.w))
    change, _ = change_of_velocity(L, start, end)
    least = min(norm(start.v) + L * norm(start.w), norm(end.v) + L * norm(end.w))
    theta = min(1.0, turn + change / least if least > 0.0 else 1.0)
    pace = max(least + change, math.sqrt(L * change / abs(h)))
    T = L / pace if pace > 0.0 else 0.0
    return SAFE * max(away, T * faster) / 3.0 * theta * theta
