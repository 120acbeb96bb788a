"""The linear system of one Newton step: (I - D + D (W + eps)) step = -f, with D the slope of the projection.

Where a contact is open D = 0, so step = -f there: those rows leave the system. The factors are kept, for steps
with a matrix that has hardly changed.
"""

from __future__ import annotations

from carom.coulomb.cone import slope
from carom.coulomb.layout import STICKING
from carom.coulomb.lu import factor, substitute
from carom.jit import kernel

_LEAST_PIVOT = 1e-14


@kernel
def factor_jacobian(k, mu, kind, heading, eps, work):
    """Factor the matrix at work.p, work.w; work.active lists its rows. Return their number."""
    p, w, active, m = work.p, work.w, work.active, 0
    for i in range(k):
        n = 3 * i
        if p[n] - w[n] > 0.0 or kind[i] == STICKING:
            active[m], active[m + 1], active[m + 2] = n, n + 1, n + 2
            m += 3
    e = 1.0 - eps
    for place in range(0, m, 3):
        n = active[place]
        i = n // 3
        d00, d10, d11, d12, d20, d21, d22 = slope(
            kind[i], mu[i], heading[i, 0], heading[i, 1],
            p[n] - w[n], p[n + 1] - w[n + 1], p[n + 2] - w[n + 2],
        )  # fmt: skip
        r0, r1, r2 = work.W[n], work.W[n + 1], work.W[n + 2]
        j0, j1, j2 = work.jacobian[place], work.jacobian[place + 1], work.jacobian[place + 2]
        for q in range(m):
            j = active[q]
            a, b, c = r0[j], r1[j], r2[j]
            j0[q] = d00 * a
            j1[q] = d10 * a + d11 * b + d12 * c
            j2[q] = d20 * a + d21 * b + d22 * c
        j0[place] += 1.0 - e * d00
        j1[place] -= e * d10
        j1[place + 1] += 1.0 - e * d11
        j1[place + 2] -= e * d12
        j2[place] -= e * d20
        j2[place + 1] -= e * d21
        j2[place + 2] += 1.0 - e * d22
    factor(work.jacobian, m, work.pivot, _LEAST_PIVOT)
    return m


@kernel
def solve_step(k, mu, kind, heading, m, work):
    """Write work.step for the f at work.p, work.w, with the factors at hand."""
    p, w, f, step, rhs = work.p, work.w, work.f, work.step, work.rhs
    moved = False
    for j in range(3 * k):
        step[j] = -f[j]
    for q in range(m):
        step[work.active[q]] = 0.0
    for j in range(3 * k):
        moved = moved or step[j] != 0.0
    for place in range(0, m, 3):
        n = work.active[place]
        rhs[place], rhs[place + 1], rhs[place + 2] = -f[n], -f[n + 1], -f[n + 2]
        if not moved:
            continue
        i = n // 3
        d00, d10, d11, d12, d20, d21, d22 = slope(
            kind[i], mu[i], heading[i, 0], heading[i, 1],
            p[n] - w[n], p[n + 1] - w[n + 1], p[n + 2] - w[n + 2],
        )  # fmt: skip
        r0, r1, r2 = work.W[n], work.W[n + 1], work.W[n + 2]
        s0, s1, s2 = 0.0, 0.0, 0.0  # what open contacts do
        for j in range(3 * k):
            q = step[j]
            s0 += r0[j] * q
            s1 += r1[j] * q
            s2 += r2[j] * q
        rhs[place] -= d00 * s0
        rhs[place + 1] -= d10 * s0 + d11 * s1 + d12 * s2
        rhs[place + 2] -= d20 * s0 + d21 * s1 + d22 * s2
    substitute(work.jacobian, m, work.pivot, rhs)
    for q in range(m):
        step[work.active[q]] = rhs[q]
