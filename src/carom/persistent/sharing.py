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
from carom.geometry.thresholds import REMAINDER
from carom.impact.workspace import KEPT, OLD, P
from carom.persistent.joint_rows import radius_of
from carom.persistent.springs import SHARES, compliance_of, grip, soften
from carom.persistent.thresholds import FREEDOM_ERROR, PROXIMAL_SPRING

SQUARES = 3  # of the projector


@kernel
def find_idle(k, group):
    """Write the projector to normal forces that move nothing; return a compliance for them, 0 if none.

    ((W + eps S)^-1 eps S)^m, for the normal rows of what presses, has it for a limit.
    """
    rows, L, Y, Z = group.cone.active, group.cone.matrix, group.idle[0], group.idle[1]
    closed, x, W, n, size = group.closed, group.v[OLD], group.m[0], 0, 0.0
    for i in range(k):
        if closed[i].turns == 0 and closed[i].loaded == 1:
            rows[n], n, size = i, n + 1, max(size, closed[i].spring)
    for i in range(n):
        for j in range(n):
            L[i, j] = W[3 * rows[i], 3 * rows[j]]
        L[i, i] += PROXIMAL_SPRING * closed[rows[i]].spring
    lu.factor(L, n, group.cone.pivot, 0.0)
    for j in range(n):
        for i in range(n):
            x[i] = PROXIMAL_SPRING * closed[rows[j]].spring if i == j else 0.0
        lu.substitute(L, n, group.cone.pivot, x)
        for i in range(n):
            Y[rows[i], rows[j]] = x[i]
    for _ in range(SQUARES):
        for i in range(n):
            for j in range(n):
                total = 0.0
                for m in range(n):
                    total += Y[rows[i], rows[m]] * Y[rows[m], rows[j]]
                Z[i, j] = total
        for i in range(n):
            for j in range(n):
                Y[rows[i], rows[j]] = Z[i, j]
    total = 0.0
    for i in range(n):
        total += Y[rows[i], rows[i]]
    return size if total > 0.5 and abs(total - round(total)) < FREEDOM_ERROR else 0.0


@kernel
def share(k, n, group):
    """Share the first forces of what presses or sticks as springs do, with nearly the same accelerations.

    Else forces that are not unique would depend on those of the last stage, and change with each iteration of
    its pose: normal ones, and what sticks where others already hold it (a floor, and a hand that pushes).
    """
    rows, x, kept, p, m = group.cone.active, group.v[OLD], group.v[KEPT], group.v[P], 0
    L, W, chosen = group.cone.matrix, group.m[0], group.cone.vector[0]
    for i in range(n):
        whole = sticks(group, rows[i] // 3)
        group.closed[rows[i] // 3].rows = 3 if whole else 1
        if rows[i] % 3 == 0 or whole:
            chosen[m], m = rows[i], m + 1
    for i in range(m):
        kept[i] = 0.0
        for j in range(m):
            kept[i] += W[int(chosen[i]), int(chosen[j])] * p[int(chosen[j])]
    soften(k, group)
    for _ in range(SHARES):
        for i in range(m):
            x[i] = kept[i]
            for j in range(m):
                L[i, j] = W[int(chosen[i]), int(chosen[j])]
            L[i, i] += PROXIMAL_SPRING * compliance_of(group, int(chosen[i]))
        lu.factor(L, m, group.cone.pivot, 0.0)
        lu.substitute(L, m, group.cone.pivot, x)
        for i in range(m):
            p[int(chosen[i])] = x[i]
        if not grip(k, group):
            break


@kernel
def sticks(group, i):
    """Return whether the friction of the first guess of a point is within its disc."""
    p = group.v[P]
    return math.hypot(p[3 * i + 1], p[3 * i + 2]) < (1.0 - REMAINDER) * radius_of(group, i)
