"""The contact problem of a stage of the implicit member: Coulomb's law at the velocity of the stage.

    (du/dt)_n = W_n p + c_n = 0 where a point presses,     u = u~ + h g W_t p,
    p_t in the disc of radius mu N, against u: p_t = projection of p_t - rho u to that disc,

u~ the slip of the stage without its contact forces. Slip that begins, ends or turns needs no mode: the disc
decides. Rolling and pivoting friction are discs whose radius is that of the normal force of their point times
delta over a length. Newton's method on the equations as they stand (semismooth, damped), with the compliance
eps S of `carom.persistent.springs` on the change of an iteration. Forces that are not unique are those of
springs (`carom.persistent.sharing`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction.layout import CONE, SLIDING
from carom.geometry.thresholds import LAST_DIGIT
from carom.model.workspace import CONSTANT, MOTION_POINT
from carom.persistent import thresholds as limits
from carom.persistent.by_bodies import (
    FACTORED,
    PASS,
    factor_by_bodies,
    knows_arms,
    rate_of_row,
    set_alone,
    set_on_disc,
)
from carom.persistent.joint_load import LOAD_ROUNDS, any_locks, begin_loads, renew_loads
from carom.persistent.joint_rows import is_driven, radius_of
from carom.persistent.settle import dot, greatest, settle
from carom.persistent.sharing import hold_shares, share
from carom.persistent.springs import (
    factor,
    moves,
    moves_freely,
    note_accelerations,
    own,
    place_forces,
    rate_by_forces,
    softness_of,
    unload,
)

STAGE_ITERATIONS, HALVES, TOGETHER = 40, 6, 3


@kernel
def solve_stage(k, hg, known, group):
    """Write the forces of a stage to `p`; return whether they exist.

    `u` has u~, `c` the accelerations without forces. With hg = 0 the law is that of accelerations: slip goes on
    along `heading`, what has no velocity slips the way it accelerates. `known` is a pair: whether `p` has the
    forces of the last iteration of the pose, and the part of the greatest acceleration that may be left.
    """
    for turn in range(LOAD_ROUNDS):
        if not forces_of_stage(k, hg, known, group):
            return False
        if not renew_loads(k, 1.0, False, turn, group):
            return hg == 0.0 or not any_locks(k, hg, group)
    begin_loads(k, group)  # of slip that locks itself no friction is right: this one is small
    forces_of_stage(k, hg, (False, 0.0), group)
    return False


@kernel
def forces_of_stage(k, hg, known, group):
    """Write the forces of a stage under given loads of joints, as `solve_stage` does."""
    closed, (shared, rough) = group.closed, known
    for i in range(k):
        closed[i].presses = 1 if closed[i].weight > 0.0 else 0
    if moves_freely(k, group) and (hg == 0.0 or greatest(3 * k, group.u) == 0.0):
        for row in range(3 * k):
            group.p[row] = 0.0
        return True
    for turn in range(2 * k + 2):
        if turn > 0 or not shared:
            share(k, list_unknowns(k, group), group)
        idle = hold_shares(k, group)
        if idle > 0.0 and not newton(k, hg, (HALVES, rough), idle, group):
            idle = 0.0
        if not (
            newton(k, hg, (HALVES, rough), 0.0, group) or newton(k, hg, (1, rough), 0.0, group)
        ):
            return False
        if not change_loads(k, turn, group):
            return True
    return False


@kernel
def solve_forces(k, group):
    """Write the forces of the points that stay closed, and the accelerations of all k points.

    Slip goes on along the headings that are known. Return whether there is a solution.
    """
    for i in range(k):
        if (
            group.problem.kind[i] == SLIDING
            and group.problem.heading[i, 0] == 0.0
            and group.problem.heading[i, 1] == 0.0
        ):
            group.problem.kind[i] = CONE
    found = solve_stage(k, 0.0, (False, 0.0), group)
    note_accelerations(k, group)
    return found


@kernel
def change_loads(k, turn, group):
    """Unload springs that pull, or load one whose point approaches; return whether there is one."""
    closed, push = group.closed, largest(k, group)
    if unload(k, turn < TOGETHER, group) > 0:
        return True
    place_forces(k, group.p, group)
    for i in range(k):
        if closed[i].motion == MOTION_POINT and closed[i].presses == 0 and closed[i].weight > 0.0:
            if (
                rate_by_forces(k, 3 * i, group) + group.problem.c[3 * i]
                < -limits.SETTLED_SHARE * push
            ):
                closed[i].presses = 1
                return True
    return False


@kernel
def largest(k, group):
    """Return the greatest normal acceleration, or acceleration by friction of joints, without other forces."""
    push = 0.0
    for i in range(k):
        if group.closed[i].motion == MOTION_POINT:
            push = max(push, abs(group.problem.c[3 * i]))
        elif group.closed[i].parent == CONSTANT:
            push = max(push, group.problem.mu[i] * own(group, 3 * i + 1))
    return push


@kernel
def list_unknowns(k, group):
    """List the rows of the unknown forces; return their number. Other forces are zero."""
    rows, n = group.equations.rows, 0
    for i in range(k):
        closed_point = group.closed[i]
        first = 0 if closed_point.motion == MOTION_POINT else 1
        parent = closed_point.parent
        bound = parent == CONSTANT or group.closed[parent].presses == 1
        for a in range(3):
            row = 3 * i + a
            if bound and a >= first and moves(group, row) and (a == 0 or group.problem.mu[i] > 0.0):
                rows[n], n = row, n + 1
            else:
                group.p[row] = 0.0
        if is_driven(group, i):
            u = group.u[3 * i + 1]
            group.p[3 * i + 1] = (
                -group.problem.mu[i] if u > 0.0 else group.problem.mu[i] if u < 0.0 else 0.0
            )
    return n


@kernel
def newton(k, hg, bounds, idle, group):
    """Solve for given loads; return whether equations hold.

    `bounds`: steps are halved less than so many times, and accelerations may have such an error. Halved steps
    can stop where discs meet, between stick and slip; whole steps then go on.
    """
    halves, rough = bounds
    n, p, equations = list_unknowns(k, group), group.p, group.equations
    rows, before, r = equations.rows, equations.before, equations.r
    push, slip = largest(k, group), 0.0
    for i in range(k):
        slip = max(slip, max(abs(group.u[3 * i + 1]), abs(group.u[3 * i + 2])))
    enough = max(limits.EQUATION_ERROR, rough) * push + (
        LAST_DIGIT * slip / hg if hg > 0.0 else 0.0
    )
    size = write_equations(k, n, hg, idle, group)
    for _ in range(STAGE_ITERATIONS):
        if size <= enough:
            return True
        equations.iterations[0] += 1
        for i in range(n):
            r[i], before[i] = -r[i], p[rows[i]]
        factor_stage(n, group)
        asked = limits.LINEAR_ERROR * max(enough, limits.LINEAR_SHARE * size)
        rest = settle(n, 0.0, asked, limits.FORCE_ERROR * push, greatest(3 * k, p), equations)
        part, best = 1.0, size
        for _ in range(halves):
            for i in range(n):
                p[rows[i]] = before[i] + part * equations.x[i]
            size = write_equations(k, n, hg, idle, group)
            if size < (1.0 - 0.1 * part) * best:
                break
            part *= 0.5
        if not size < math.inf:
            return False
        if size >= 0.9 * best and best <= limits.SETTLED_SHARE * push + 1e3 * enough:
            if not size <= best:
                for i in range(n):
                    p[rows[i]] = before[i]
            return True
        if (
            rest > asked and size <= 2.0 * rest <= limits.DEPENDENT_ERROR * push
        ):  # rows that depend on others
            return True
    return size <= limits.SETTLED_SHARE * push


@kernel
def factor_stage(n, group):
    """Write the factor of the Jacobian and eps S: of the matrix, or of the motion of bodies."""
    equations, rows = group.equations, group.equations.rows
    if not knows_arms(equations):
        factor(n, rows, group)
        return
    for i in range(n):
        if equations.arms[rows[i]].own[0] == 0.0:
            set_alone(equations, rows[i], softness_of(group, rows[i]))
    for i in range(n):
        arm = equations.arms[rows[i]]
        if arm.own[0] != 0.0:
            softness = softness_of(group, rows[i]), softness_of(group, arm.other)
            set_on_disc(equations, rows[i], softness)
    factor_by_bodies(n, rows, equations)


@kernel
def write_equations(k, n, hg, idle, group):
    """Write the errors of the equations, as accelerations, and their Jacobian; return the greatest.

    The Jacobian is A, or that of the motion of bodies, which the arms of the rows have.
    """
    equations, rows, i = group.equations, group.equations.rows, 0
    by_bodies = knows_arms(equations)
    place_forces(k, group.p, group)
    while i < n:
        width = 1
        if rows[i] % 3 != 0:
            width = 2 if i + 1 < n and rows[i + 1] // 3 == rows[i] // 3 else 1
            write_disc(k, n, (i, width), hg, group)
        elif by_bodies:
            arm = equations.arms[rows[i]]
            arm.own[0] = 0.0
            equations.r[i] = group.problem.c[rows[i]] + rate_of_row(arm, equations)
        else:
            write_normal(k, n, i, idle, group)
        i += width
    equations.iterations[FACTORED] += 24 * (n + k) // PASS if by_bodies else n * n // 2
    return greatest(n, equations.r)


@kernel
def write_normal(k, n, i, idle, group):
    """Write the equation of the normal force of one point, unknown i."""
    rows, errors, A = group.equations.rows, group.equations.r, group.equations.A
    W, p, row = group.problem.W[rows[i]], group.p, rows[i]
    errors[i] = group.problem.c[row] + dot(3 * k, W, p)
    for j in range(n):
        A[i, j] = W[rows[j]]
        if idle > 0.0 and rows[j] % 3 == 0:
            part = idle * group.idle[0, row // 3, rows[j] // 3]
            errors[i] += part * p[rows[j]]
            A[i, j] += part


@kernel
def write_disc(k, n, place, hg, group):
    """Write the equations of the friction of one point: unknowns i and, if `width` is 2, i + 1."""
    (i, width), rows, errors = place, group.equations.rows, group.equations.r
    p = group.p
    a, b, unit = rows[i], rows[i + width - 1], rows[i] // 3
    closed_point = group.closed[unit]
    normal = 3 * closed_point.parent  # of the force that bounds the friction; below 0 if none does
    scale = 0.5 * (own(group, a) + own(group, b))
    known = closed_point.passes == 1 if hg > 0.0 else group.problem.kind[unit] == SLIDING
    first = group.problem.c[a] if hg == 0.0 else group.u[a] / hg
    second = group.problem.c[b] if hg == 0.0 else group.u[b] / hg
    ga = first + rate_by_forces(k, a, group)
    gb = second + rate_by_forces(k, b, group) if width == 2 else 0.0
    za, zb = p[a] - ga / scale, p[b] - gb / scale if width == 2 else 0.0
    z, radius = math.sqrt(za * za + zb * zb), radius_of(group, unit)
    if known:
        za, zb, z = -group.problem.heading[unit, 0], -group.problem.heading[unit, 1], 1.0
    if not known and z <= radius:
        write_stick(n, (i, width), group)
        errors[i], errors[i + width - 1] = ga, gb if width == 2 else ga
        return
    ea, eb, part = za / z, zb / z, 0.0 if known else radius / z
    errors[i] = scale * (p[a] - radius * ea)
    if width == 2:
        errors[i + 1] = scale * (p[b] - radius * eb)
    grows = group.problem.mu[unit] if normal >= 0 and p[normal] > 0.0 else 0.0
    if knows_arms(group.equations):
        bound_arms((a, b), (ea, eb, part, scale), normal, grows, group.equations)
    else:
        write_slope((i, width), n, (ea, eb, part, scale), normal, grows, group)


@kernel
def write_stick(n, place, group):
    """Write the Jacobian of the friction of one point within its disc."""
    (i, width), rows, A, W = place, group.equations.rows, group.equations.A, group.problem.W
    by_bodies = knows_arms(group.equations)
    for r in range(width):
        if by_bodies:
            group.equations.arms[rows[i + r]].own[0] = 0.0
        for j in range(0 if by_bodies else n):
            A[i + r, j] = W[rows[i + r], rows[j]]


@kernel
def bound_arms(rows, slope, normal, grows, equations):
    """Write the Jacobian of friction on its disc to the arms of its rows; they are the same if there is one."""
    (a, b), (ea, eb, part, scale) = rows, slope
    across = part * ea * eb if a != b else 0.0
    for row, other, e in ((b, a, eb), (a, b, ea)):
        arm, turns = equations.arms[row], part * (1.0 - e * e)
        arm.other, arm.leader = other, normal if grows > 0.0 else row
        arm.rate[0], arm.rate[1] = turns, -across
        arm.own[0], arm.own[1] = scale * (1.0 - turns), scale * across
        arm.bound = -scale * e * grows


@kernel
def write_slope(place, n, slope, normal, grows, group):
    """Write the Jacobian of the friction of one point on its disc: e, the part of a change, and a scale."""
    (i, width), (ea, eb, part, scale) = place, slope
    rows, A, W = group.equations.rows, group.equations.A, group.problem.W
    a, b = rows[i], rows[i + width - 1]
    for j in range(n):
        row = rows[j]
        if W[a, row] == 0.0 and W[b, row] == 0.0 and row != normal:  # of bodies elsewhere
            A[i, j] = A[i + width - 1, j] = 0.0
            continue
        da, db = -W[a, row] / scale, -W[b, row] / scale if width == 2 else 0.0
        da, db = da + (1.0 if j == i else 0.0), db + (1.0 if width == 2 and j == i + 1 else 0.0)
        along = ea * da + eb * db
        g = grows if row == normal else 0.0
        own = 1.0 if j == i else 0.0
        A[i, j] = scale * (own - part * (da - ea * along) - ea * g)
        if width == 2:
            own = 1.0 if j == i + 1 else 0.0
            A[i + 1, j] = scale * (own - part * (db - eb * along) - eb * g)
