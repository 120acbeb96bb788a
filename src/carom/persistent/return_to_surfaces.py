"""Return a group of bodies to the surfaces of its held points, and sticking vertices to where they stick.

    xi = -P G^T lam,   W lam = phi,    phi: the gap of each point that presses, and for a vertex that sticks the
                                       tangential way from its anchor too,

with the rows of the middle of the step, repeated to round-off. Redundant rows are left out of the factor. A
step is found in rounds: each begins with what lam came to in the last.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.closed_points import place_seats, round_off_of_both
from carom.contact.gap import round_off
from carom.contact.place import place_any
from carom.dynamics.acceleration import STICK
from carom.dynamics.project import project_position, shift
from carom.dynamics.several_points import factor, spread_all, substitute
from carom.impact.workspace import BACK, P, U
from carom.kinematics.contact_point import in_axes

DROP = 1e-10  # of a pivot, relative to its row: what is left of a redundant one is round-off


@kernel
def mark_rows(system, held, k, cluster):
    """Mark in `rows` what each point gives: 0 nothing, 1 its gap, 3 its gap and its place; return if any.

    A point that does not press gives its gap where that is negative.
    """
    some = False
    for i in range(k):
        hold, p, q = held.points[cluster.seats[i].held], cluster.v[P], 3 * i
        cluster.seats[i].rows = 0
        if cluster.seats[i].turns == 1:
            continue
        if cluster.points[1][i].gap < -1e-12 * system.contacts[hold.contact].extent:
            some = True
            cluster.seats[i].rows = 1
        if p[q] > 0.0:
            some = True
            friction = math.sqrt(p[q + 1] * p[q + 1] + p[q + 2] * p[q + 2])
            contact = system.contacts[hold.contact]
            core = contact.radius == 0.0 and contact.touches == 0
            sticks = hold.mode == STICK and friction < (1.0 - 1e-9) * cluster.mu[i] * p[q]
            cluster.seats[i].rows = 3 if core and sticks else 1
    return some


@kernel
def onto_surfaces(system, held, k, count, state, cluster, work):
    """Bring the bodies of the group back to the points that press."""
    place_seats(system, k, state, cluster, cluster.points[1], work)
    if not mark_rows(system, held, k, cluster):
        return
    n, L = 3 * k, cluster.m[1]
    for i in range(n):
        row = i % 3 < cluster.seats[i // 3].rows
        for j in range(n):
            both = row and j % 3 < cluster.seats[j // 3].rows
            L[i, j] = cluster.m[0][i, j] if both else 1.0 if i == j else 0.0
    factor(n, DROP, L)
    x, way = cluster.v[U], cluster.v[BACK]
    known = False
    for i in range(n):
        x[i] = way[i] if i % 3 < cluster.seats[i // 3].rows else 0.0
        way[i], known = 0.0, known or x[i] != 0.0
    for _ in range(11):
        if not known:
            if errors(system, held, k, state, cluster, x, work):
                break
            substitute(n, L, x)
            for i in range(n):
                x[i] = -x[i] if i % 3 < cluster.seats[i // 3].rows else 0.0
        known = False
        for i in range(n):
            way[i] += x[i]
        spread_all(system, k, cluster.points[0], x, count, cluster.member, work.stage, work)
        for m in range(count):
            shift(work.body[cluster.member[m]].motion, state[cluster.member[m]])
        if system.joints.shape[0] > 0:
            project_position(system, state, False, 1e-14, work)


@kernel
def errors(system, held, k, state, cluster, x, work):
    """Write the errors of all rows (0 where there is none); return whether all are round-off."""
    small = True
    for i in range(k):
        hold, point = held.points[cluster.seats[i].held], cluster.points[1][i]
        contact = system.contacts[hold.contact]
        x[3 * i], x[3 * i + 1], x[3 * i + 2] = 0.0, 0.0, 0.0
        if cluster.seats[i].rows == 0:
            continue
        place_any(system, contact, hold.feature, hold.point, state, point, work)
        tiny = round_off(contact, state)
        if contact.touches == 1:
            tiny = 4.0 * round_off_of_both(contact, state)
        x[3 * i] = point.gap
        small = small and abs(point.gap) <= tiny
        if cluster.seats[i].rows == 3:
            c, a, r = state[hold.body].x, hold.anchor, point.arm_a
            _, t1, t2 = in_axes(point, c[0] + r[0] - a[0], c[1] + r[1] - a[1], c[2] + r[2] - a[2])
            x[3 * i + 1], x[3 * i + 2] = t1, t2
            small = small and max(abs(t1), abs(t2)) <= tiny
    return small
