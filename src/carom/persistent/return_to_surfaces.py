"""Return of a group of bodies to the surfaces of its active points, and of sticking vertices to their points.

    xi = -P G^T lam,   W lam = phi,    phi: the gap of each loaded point, and for a vertex that sticks also the
                                       tangential displacement from its anchor,

repeated until phi is round-off. Rows that depend on others are left out.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.closed_points import place_closed, round_off_of_both
from carom.contact.gap import round_off
from carom.contact.place import place_any
from carom.dynamics.contact_impulse import gain
from carom.dynamics.passed_edges import has_passed
from carom.dynamics.project import project_position, shift
from carom.dynamics.several_points import spread_all, velocities, yields
from carom.friction.ldl import factor_by_pivots, substitute
from carom.impact.workspace import RETURN, P
from carom.kinematics.contact_point import in_axes
from carom.model.actions import MODE_STICK
from carom.persistent.thresholds import DEPENDENCE


@kernel
def mark_rows(system, active, k, group):
    """Write how many `rows` each point gives: 0, 1 (its gap), 3 (gap and position); return whether any.

    A point without load gives its gap if that is negative.
    """
    some = False
    for i in range(k):
        group.closed[i].rows = 0
        if group.closed[i].turns > 0:
            continue
        active_point, p, q = active.points[group.closed[i].active], group.v[P], 3 * i
        if group.points[1][i].gap < -1e-12 * system.contacts[active_point.contact].extent:
            some = True
            group.closed[i].rows = 1
        if p[q] > 0.0 and not has_passed(active, i, group):
            some = True
            friction = math.sqrt(p[q + 1] * p[q + 1] + p[q + 2] * p[q + 2])
            contact = system.contacts[active_point.contact]
            core = contact.radius == 0.0 and contact.touches == 0
            inside = friction < (1.0 - 1e-9) * group.mu[i] * p[q]
            sticks = active_point.mode == MODE_STICK and inside
            group.closed[i].rows = 3 if core and sticks else 1
    return some


@kernel
def given(group, row):
    """Return whether a row is given and its W is not zero.

    The first row of a point of rolling or pivoting is its bound.
    """
    closed_point = group.closed[row // 3]
    first = 1 if closed_point.turns > 0 else 0
    return first <= row % 3 < first + closed_point.rows and yields(group.W, row)


@kernel
def factor_given(k, group):
    """List the given rows, and factor W for those that do not depend on others; return their number."""
    n, equations = 0, group.equations
    rows, L, own = equations.rows, equations.factor, equations.diagonal
    for i in range(3 * k):
        if given(group, i):
            rows[n], n = i, n + 1
    for i in range(n):
        own[i] = group.W[rows[i], rows[i]]
        for j in range(n):
            L[i, j] = group.W[rows[i], rows[j]]
    return factor_by_pivots(n, DEPENDENCE, rows, own, L)


@kernel
def solve_rows(k, n, group, x):
    """Replace x, in the n rows, by the impulses that remove it; zero the others."""
    rows, y = group.equations.rows, group.equations.x
    for i in range(n):
        y[i] = -x[rows[i]]
    substitute(n, group.equations.factor, y)
    for i in range(3 * k):
        x[i] = 0.0
    for i in range(n):
        x[rows[i]] = y[i]


@kernel
def onto_surfaces(system, active, k, count, state, group, work):
    """Move the bodies of the group back to the surfaces at the loaded points."""
    place_closed(system, k, state, group, group.points[1], work)
    if not mark_rows(system, active, k, group):
        return
    n, x = factor_given(k, group), group.v[RETURN]
    for _ in range(11):
        if errors(system, active, k, state, group, x, work):
            break
        solve_rows(k, n, group, x)
        spread_all(system, k, group.points[0], x, count, group.member, work.stage, work)
        for m in range(count):
            shift(work.body[group.member[m]].motion, 1.0, state[group.member[m]])
        if system.joints.shape[0] > 0:
            project_position(system, state, False, 1e-14, work)


@kernel
def onto_tangents(system, k, count, state, group, work):
    """Remove the velocities of the bodies of the group in the rows that are given."""
    n, x = factor_given(k, group), group.v[RETURN]
    velocities(k, group.points[0], state, x)
    solve_rows(k, n, group, x)
    spread_all(system, k, group.points[0], x, count, group.member, work.stage, work)
    for m in range(count):
        gain(work.body[group.member[m]].motion, state[group.member[m]])


@kernel
def errors(system, active, k, state, group, x, work):
    """Write the errors of all rows (0 for rows not given); return whether all are round-off."""
    small = True
    for i in range(k):
        closed_point, point = group.closed[i], group.points[1][i]
        x[3 * i], x[3 * i + 1], x[3 * i + 2] = 0.0, 0.0, 0.0
        if closed_point.rows == 0:
            continue
        active_point = active.points[closed_point.active]
        contact = system.contacts[closed_point.contact]
        place_any(system, contact, closed_point.feature, closed_point.point, state, point, work)
        tiny = round_off(contact, state)
        if contact.touches == 1:
            tiny = 4.0 * round_off_of_both(contact, state)
        x[3 * i] = point.gap
        small = small and abs(point.gap) <= tiny
        if group.closed[i].rows == 3:
            c, a, r = state[active_point.body].x, active_point.anchor, point.arm_a
            _, t1, t2 = in_axes(point, c[0] + r[0] - a[0], c[1] + r[1] - a[1], c[2] + r[2] - a[2])
            x[3 * i + 1], x[3 * i + 2] = t1, t2
            small = small and max(abs(t1), abs(t2)) <= tiny
    return small
