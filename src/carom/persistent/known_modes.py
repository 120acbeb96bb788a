"""Forces of the points of one body whose modes are known: one linear system, checked against Coulomb's law.

    (G dv/dt)_n = 0 for loaded points (N > 0), all three rows for those that stick,
    lam_t = -mu lam_n d for those that slip along d.

Rolling or pivoting friction of a point that rotates about the axis e is the torque -d lam_n e. If a point does
not rotate, the rows of that rotation are given, too.

Forces need not be unique (four corners of a face). The forces of a face of equal springs are used, the limit of
(A + eps S) lam = -c for eps -> 0, with S the scales of the points, as in `carom.friction.newton`. With eps the
loaded points give way by eps S lam; a point without load must not be deeper, or its spring would press too.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction import lu
from carom.friction.layout import SLIDING
from carom.geometry.rotation import cross
from carom.impact.workspace import OLD, C, P
from carom.kinematics.contact_point import contact_motion
from carom.kinematics.rows import inverse_inertia, symmetric_times

# weight of S; number of corrections of the forces; their error, relative to the accelerations without forces
EPS, CORRECTIONS, FITS = 1e-5, 12, 1e-12
PULL = 1e-9  # of the greatest force or acceleration: less counts as round-off of zero


@kernel
def rows_of(push, slides):
    """Return the number of given rows of a point: none if it is not loaded."""
    if not push > 0.0:
        return 0
    return 1 if slides else 3


@kernel
def as_known(k, group):
    """Return whether the loaded points slip or stick in agreement with their given rows."""
    for i in range(k):
        slides, rows = group.kind[i] == SLIDING or group.mu[i] == 0.0, group.closed[i].rows
        if group.closed[i].turns > 0:
            if slides and rows > 0:
                return False
        elif rows > 0 and slides != (rows == 1):
            return False
    return True


@kernel
def solve_given(system, k, state, group, work):
    """Write the forces that satisfy the given rows to P, and the acceleration of the body to its `motion`.

    Return whether they obey Coulomb's law. C has the accelerations without them.
    """
    A, L, rows, x = group.m[1], group.cone.matrix, group.cone.active, group.v[OLD]
    b = group.points[0][0].a
    inverse = inverse_inertia(system.bodies[b], state[b].Q)
    n, push = write_rows(system, inverse, k, group), largest_acceleration(k, group)
    for i in range(n):
        for j in range(n):
            A[i, j] = L[i, j] = dot(group.rows[0, i], group.rows[1, j])
        L[i, i] += EPS * scale_of(system.bodies[b].mass, inverse, group.points[0][rows[i] // 3])
    lu.factor(L, n, group.cone.pivot, 0.0)
    forget_forces(k, group, work.body[b].motion)
    for turn in range(CORRECTIONS):
        if not missed(n, group, work.body[b].motion) > FITS * push:
            return obeys(system, k, push, group, work)
        lu.substitute(L, n, group.cone.pivot, x)
        add_forces(system, k, n, group, work.body[b].motion)
        if turn == 0 and not stays_away(k, push, group, work):
            return False  # it is on the face of the others, and its spring would press
    return False


@kernel
def solve_as_known(system, k, state, group, work):
    """Take the forces in P if they satisfy the given rows, as those of this state do; else solve for them."""
    b, rows, x, p = group.points[0][0].a, group.cone.active, group.v[OLD], group.v[P]
    motion = work.body[b].motion
    n = write_rows(system, inverse_inertia(system.bodies[b], state[b].Q), k, group)
    push = largest_acceleration(k, group)
    for i in range(n):
        x[i] = p[rows[i]]
    forget_forces(k, group, motion)
    add_forces(system, k, n, group, motion)
    if not missed(n, group, motion) > FITS * push:
        return obeys(system, k, push, group, work)
    return solve_given(system, k, state, group, work)


@kernel
def largest_acceleration(k, group):
    """Return the greatest acceleration of the points without their forces."""
    push = 0.0
    for row in range(3 * k):
        push = max(push, abs(group.v[C][row]))
    return push


@kernel
def forget_forces(k, group, motion):
    """Zero the forces, and the acceleration that they give."""
    for row in range(3 * k):
        group.v[P][row] = 0.0
    for r in range(6):
        motion[r] = 0.0


@kernel
def missed(n, group, motion):
    """Write the error of each given row, and return the greatest."""
    x, wrong = group.v[OLD], 0.0
    for i in range(n):
        x[i] = -group.v[C][group.cone.active[i]] - dot(group.rows[0, i], motion)
        wrong = max(wrong, abs(x[i]))
    return wrong


@kernel
def add_forces(system, k, n, group, motion):
    """Add forces along the given rows, and the acceleration that they give."""
    x = group.v[OLD]
    for i in range(n):
        add_force(system, k, group, group.cone.active[i], x[i])
        for r in range(6):
            motion[r] += group.rows[1, i, r] * x[i]


@kernel
def bound_per_force(system, point, closed_point):
    """Return the greatest impulse of a point of rolling or pivoting for a unit normal one: d over a length."""
    return system.contacts[closed_point.contact].turning[closed_point.turns - 1] / point.length


@kernel
def turning_axis(point, turns, d):
    """Return the torque of a unit impulse along d in the rows of rolling or pivoting."""
    E, length = point.axes, point.length
    if turns == 2:
        return length * d[0] * E[0, 0], length * d[0] * E[0, 1], length * d[0] * E[0, 2]
    return (
        length * (d[0] * E[1, 0] + d[1] * E[2, 0]),
        length * (d[0] * E[1, 1] + d[1] * E[2, 1]),
        length * (d[0] * E[1, 2] + d[1] * E[2, 2]),
    )


@kernel
def write_rows(system, inverse, k, group):
    """Write the given rows, and the motions from forces along them; return their number."""
    n, points = 0, group.points[0]
    g = 1.0 / system.bodies[points[0].a].mass
    for i in range(k):
        point, d, turns = points[i], group.heading[i], group.closed[i].turns
        r, E = point.arm_a, point.axes
        mu = group.mu[i] if group.kind[i] == SLIDING else 0.0
        for a in range(group.closed[i].rows):
            G, Y = group.rows[0, n], group.rows[1, n]
            if turns > 0:
                for b in range(3):
                    G[b], Y[b] = 0.0, 0.0
                G[3], G[4], G[5] = turning_axis(point, turns, (1.0 - a, 1.0 * a))
                t = (G[3], G[4], G[5])
            else:
                for b in range(3):
                    G[b], Y[b] = E[a, b], E[a, b] - mu * (d[0] * E[1, b] + d[1] * E[2, b])
                G[3], G[4], G[5] = cross(r[0], r[1], r[2], G[0], G[1], G[2])
                t = cross(r[0], r[1], r[2], Y[0], Y[1], Y[2])
                if a == 0:
                    t = with_turning(system, k, i, t, group)
            t = symmetric_times(inverse, t[0], t[1], t[2])
            for b in range(3):
                Y[b], Y[3 + b] = g * Y[b], t[b]
            group.cone.active[n], n = 3 * i + a + (1 if turns > 0 else 0), n + 1
    return n


@kernel
def with_turning(system, k, i, t, group):
    """Return the torque t of a unit normal force of point i with its rolling and pivoting friction."""
    for j in range(i + 1, k):
        closed_point = group.closed[j]
        if closed_point.turns > 0 and closed_point.parent == i and group.kind[j] == SLIDING:
            most = bound_per_force(system, group.points[0][j], closed_point)
            e = turning_axis(group.points[0][j], closed_point.turns, group.heading[j])
            t = (t[0] - most * e[0], t[1] - most * e[1], t[2] - most * e[2])
    return t


@kernel
def dot(a, b):
    """Return the product of a row with a motion."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5]


@kernel
def scale_of(mass, inverse, point):
    """Return a third of the trace of W of a point: 1/m + (tr(J^-1) r^2 - r J^-1 r)/3."""
    trace, r = inverse[0] + inverse[3] + inverse[5], point.arm_a
    if point.turns > 0:
        return point.length**2 * trace / 3.0
    a = symmetric_times(inverse, r[0], r[1], r[2])
    turning = trace * (r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
    turning -= r[0] * a[0] + r[1] * a[1] + r[2] * a[2]
    return 1.0 / mass + turning / 3.0


@kernel
def add_force(system, k, group, row, x):
    """Add a force along a given row; with a normal force, its friction of slip, rolling and pivoting."""
    p, i = group.v[P], row // 3
    p[row] += x
    if row % 3 > 0:
        return
    if group.kind[i] == SLIDING:
        for r in range(2):
            p[row + 1 + r] -= group.mu[i] * group.heading[i, r] * x
    for j in range(i + 1, k):
        closed_point = group.closed[j]
        if closed_point.turns > 0 and closed_point.parent == i and group.kind[j] == SLIDING:
            most = bound_per_force(system, group.points[0][j], closed_point)
            for r in range(2):
                p[3 * j + 1 + r] -= most * group.heading[j, r] * x


@kernel
def note_accelerations(k, group, work):
    """Write the accelerations of all points with the forces found to OLD."""
    a = group.v[OLD]
    for i in range(k):
        q = 3 * i
        a[q], a[q + 1], a[q + 2] = contact_motion(group.points[0][i], work)
        for r in range(3):
            a[q + r] += group.v[C][q + r]


@kernel
def obeys(system, k, push, group, work):
    """Return whether no force pulls or leaves its cone, and no point without force approaches."""
    p, most = group.v[P], 0.0
    if not stays_away(k, push, group, work):
        return False
    for i in range(k):
        most = max(most, p[3 * i])
    for i in range(k):
        q = 3 * i
        if group.closed[i].rows == 0:
            if group.kind[i] != SLIDING and pivots_or_rolls(i, group):
                a = contact_motion(group.points[0][i], work)
                gain = max(abs(group.v[C][q + 1] + a[1]), abs(group.v[C][q + 2] + a[2]))
                if gain > PULL * push:
                    return False
        if p[q] < -PULL * most:
            return False
        if group.closed[i].turns > 0 or group.closed[i].rows == 3:
            friction = math.sqrt(p[q + 1] * p[q + 1] + p[q + 2] * p[q + 2])
            if friction > bound_of(system, i, group) + PULL * most:
                return False
    return True


@kernel
def stays_away(k, push, group, work):
    """Return whether no point without force approaches; `motion` is the acceleration that the forces give."""
    for i in range(k):
        if group.closed[i].rows == 0:
            a = contact_motion(group.points[0][i], work)
            if group.v[C][3 * i] + a[0] < -PULL * push:
                return False
    return True


@kernel
def pivots_or_rolls(i, group):
    """Return whether a closed point is the rolling or pivoting friction of a loaded point."""
    closed_point = group.closed[i]
    return closed_point.turns > 0 and group.closed[closed_point.parent].rows > 0


@kernel
def bound_of(system, i, group):
    """Return the greatest friction of a point under the forces in P."""
    closed_point = group.closed[i]
    if closed_point.turns > 0:
        normal = group.v[P][3 * closed_point.parent]
        return bound_per_force(system, group.points[0][i], closed_point) * normal
    return group.mu[i] * group.v[P][3 * i]


@kernel
def note_given(k, group):
    """Write which points are loaded by the forces in P; return whether sticking ones are inside their cones."""
    p = group.v[P]
    for i in range(k):
        q, slides = 3 * i, group.kind[i] == SLIDING
        group.closed[i].rows = rows_of(p[q], slides)
        friction = math.sqrt(p[q + 1] * p[q + 1] + p[q + 2] * p[q + 2])
        if not slides and p[q] > 0.0 and friction >= (1.0 - 1e-9) * group.mu[i] * p[q]:
            return False
    return True
