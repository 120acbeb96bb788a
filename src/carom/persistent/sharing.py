"""How forces that are not unique are shared in a stage of the implicit member: as springs share them.

Normal forces v that move nothing, W v = 0 (four corners of a face have one), change the discs of friction.
Springs have v . S N = 0. With the projector Pi to all v, orthogonal in S, this is one equation with that of the
accelerations: W N + c + s Pi N = 0, because W N + c is orthogonal to all v.

Stick that moves nothing changes no motion, and is shared in the first guess: so that it depends on the state of
the stage, not on the stage before.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction import lu
from carom.geometry.thresholds import REMAINDER, ROUND_OFF
from carom.model.workspace import MOTION_POINT
from carom.persistent.by_bodies import (
    factor_by_bodies,
    knows_arms,
    move_bodies,
    rate_of_row,
    rest_bodies,
    set_alone,
    solve_by_bodies,
)
from carom.persistent.joint_rows import radius_of
from carom.persistent.settle import greatest
from carom.persistent.springs import SHARES, factor, grip, soften, softness_of
from carom.persistent.thresholds import FREEDOM_ERROR, IDLE_PIVOT, PROXIMAL_SPRING

SQUARES = 3  # of the projector


@kernel
def hold_shares(k, group):
    """Return a compliance for the normal forces that move nothing, with their projector (`find_idle`).

    By bodies there is no matrix of it: they are taken out of the forces before an iteration of Newton's method,
    whose steps (W + eps S)^-1 r have none: v . (W + eps S) x = v . r = 0 is v . S x = 0.
    """
    if not knows_arms(group.equations):
        return find_idle(k, group)
    remove_idle(k, group)
    return 0.0


@kernel
def remove_idle(k, group):
    """Take the normal forces that move nothing out of those that press: N - ((W + eps S)^-1 eps S)^m N."""
    equations, closed, p, n = group.equations, group.closed, group.p, 0
    rows, x, part = equations.chosen, equations.x, equations.r
    for i in range(k):
        if closed[i].motion == MOTION_POINT and closed[i].presses == 1:
            rows[n], x[n], n = 3 * i, p[3 * i], n + 1
            set_alone(equations, 3 * i, softness_of(group, 3 * i))
    factor_by_bodies(n, rows, equations)
    most = greatest(n, x)
    for _ in range(2**SQUARES):
        for i in range(n):
            part[i] = x[i]
            x[i] *= softness_of(group, rows[i])
        solve_by_bodies(n, rows, equations, x)
        change = 0.0
        for i in range(n):
            change = max(change, abs(x[i] - part[i]))
        if change <= ROUND_OFF * most:
            break
    for i in range(n):
        p[rows[i]] -= x[i]


@kernel
def find_idle(k, group):
    """Write the projector to normal forces that move nothing; return a compliance for them, 0 if none.

    ((W + eps S)^-1 eps S)^m, for the normal rows of what presses, has it for a limit.
    """
    equations, closed, W, n, size = group.equations, group.closed, group.problem.W, 0, 0.0
    rows, Y, Z = equations.chosen, group.idle[0], group.idle[1]
    for i in range(k):
        if closed[i].motion == MOTION_POINT and closed[i].presses == 1:
            rows[n], n, size = 3 * i, n + 1, max(size, closed[i].spring)
    for i in range(n):
        for j in range(n):
            equations.A[i, j] = W[rows[i], rows[j]]
    factor(n, rows, group)
    if independent(n, equations):
        return 0.0
    for i in range(n):
        for j in range(n):
            Y[i, j] = PROXIMAL_SPRING * closed[rows[j] // 3].spring if i == j else 0.0
    lu.substitute_all(equations.factor, n, equations.pivot, Y)
    if not trace(n, Y) > 0.5:  # it falls with each square
        return 0.0
    for _ in range(SQUARES):
        square(n, Y, Z)
        Y, Z = Z, Y
    total = trace(n, Y)
    idle = group.idle[0]
    # from the last, whose place no other has taken: the number of a point is at least that of its row
    for i in range(n - 1, -1, -1):
        for j in range(n - 1, -1, -1):
            idle[rows[i] // 3, rows[j] // 3] = Y[i, j]
    return size if total > 0.5 and abs(total - round(total)) < FREEDOM_ERROR else 0.0


@kernel
def trace(n, Y):
    """Return the sum of the diagonal of Y[:n, :n]."""
    total = 0.0
    for i in range(n):
        total += Y[i, i]
    return total


@kernel
def square(n, Y, Z):
    """Write Z = Y Y."""
    for i in range(n):
        for j in range(n):
            Z[i, j] = 0.0
        for m in range(n):
            part, row = Y[i, m], Y[m]
            for j in range(n):
                Z[i, j] += part * row[j]


@kernel
def independent(n, equations):
    """Return whether no pivot of the factor is small: nothing moves nothing then."""
    A, L, most = equations.A, equations.factor, 0.0
    for i in range(n):
        most = max(most, A[i, i])
    for i in range(n):
        if not abs(L[i, i]) > IDLE_PIVOT * most:
            return False
    return True


@kernel
def share(k, n, group):
    """Share the first forces of what presses or sticks as springs do, with nearly the same accelerations.

    Else forces that are not unique would depend on those of the last stage, and change with each iteration of
    its pose: normal ones, and what sticks where others already hold it (a floor, and a hand that pushes).
    """
    equations, p, m = group.equations, group.p, 0
    rows, chosen, x, r = equations.rows, equations.chosen, equations.x, equations.r
    for i in range(n):
        whole = sticks(group, rows[i] // 3)
        group.closed[rows[i] // 3].rows = 3 if whole else 1
        if rows[i] % 3 == 0 or whole:
            chosen[m], m = rows[i], m + 1
    write_shared(m, group)
    soften(k, group)
    for _ in range(SHARES):
        for i in range(m):
            x[i] = r[i]
        solve_shared(m, group)
        for i in range(m):
            p[chosen[i]] = x[i]
        if not grip(k, group):
            break


@kernel
def write_shared(m, group):
    """Write W of the m chosen rows, if the group has matrices, and the accelerations by their forces."""
    equations, p, W = group.equations, group.p, group.problem.W
    chosen, r = equations.chosen, equations.r
    if knows_arms(equations):
        rest_bodies(equations)
        for i in range(m):
            arm = equations.arms[chosen[i]]
            move_bodies(arm, arm.motion, p[chosen[i]], equations.tree.body)
        for i in range(m):
            r[i] = rate_of_row(equations.arms[chosen[i]], equations)
        return
    for i in range(m):
        r[i] = 0.0
        for j in range(m):
            equations.A[i, j] = W[chosen[i], chosen[j]]
            r[i] += W[chosen[i], chosen[j]] * p[chosen[j]]


@kernel
def solve_shared(m, group):
    """Replace x by the forces of springs that cause these accelerations."""
    equations, chosen = group.equations, group.equations.chosen
    if knows_arms(equations):
        for i in range(m):
            set_alone(equations, chosen[i], softness_of(group, chosen[i]))
        factor_by_bodies(m, chosen, equations)
        solve_by_bodies(m, chosen, equations, equations.x)
    else:
        factor(m, chosen, group)
        lu.substitute(equations.factor, m, equations.pivot, equations.x)


@kernel
def sticks(group, i):
    """Return whether the friction of the first guess of a point is within its disc."""
    p = group.p
    return math.hypot(p[3 * i + 1], p[3 * i + 2]) < (1.0 - REMAINDER) * radius_of(group, i)
