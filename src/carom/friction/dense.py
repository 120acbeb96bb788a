"""Full matrix W: products, sweeps, and the linear systems of Newton's method."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.friction import layout as o
from carom.friction.cone import slope
from carom.friction.local import solve_local
from carom.friction.lu import factor, substitute
from carom.friction.thresholds import LEAST_PIVOT


@kernel
def add_product(n, W, x, out):
    """Add W x to `out`, column by column; the columns of the symmetric W are its rows."""
    for j in range(n):
        q, column = x[j], W[j]
        if q != 0.0:
            for i in range(n):
                out[i] += q * column[i]


@kernel
def magnitude(work, k):
    """Return the greatest (|W| |p|)_i / s_i."""
    most, p = 0.0, work.vector[o.ITERATE]
    for i in range(3 * k):
        row, total = work.W[i], 0.0
        for j in range(3 * k):
            total += abs(row[j] * p[j])
        most = max(most, total / work.contact[i // 3].scale)
    return most


@kernel
def sweep(work, k, backward):
    """Solve each contact in turn, with fixed impulses of the others."""
    p, c = work.vector[o.ITERATE], work.vector[o.BIAS]
    for place in range(k):
        i = k - 1 - place if backward else place
        n = 3 * i
        r0, r1, r2 = work.W[n], work.W[n + 1], work.W[n + 2]
        c0, c1, c2 = c[n], c[n + 1], c[n + 2]
        for j in range(3 * k):
            q = p[j]
            c0 += r0[j] * q
            c1 += r1[j] * q
            c2 += r2[j] * q
        q0, q1, q2 = p[n], p[n + 1], p[n + 2]
        W = r0[n], r0[n + 1], r0[n + 2], r1[n + 1], r1[n + 2], r2[n + 2]
        c0 -= W[0] * q0 + W[1] * q1 + W[2] * q2
        c1 -= W[1] * q0 + W[3] * q1 + W[4] * q2
        c2 -= W[2] * q0 + W[4] * q1 + W[5] * q2
        found, x0, x1, x2 = solve_local(work.contact[i], W, (c0, c1, c2))
        if found:
            p[n], p[n + 1], p[n + 2] = x0, x1, x2


@kernel
def factor_newton(work, k, eps):
    """Factor I - D + D (W + eps), and count its rows.

    For an open contact D = 0 and the step is -f, as for the normal impulse of a disc: their rows are left out.
    """
    p, w, active, m = work.vector[o.ITERATE], work.vector[o.RESULTING], work.active, 0
    for i in range(k):
        n, kind = 3 * i, work.contact[i].kind
        if p[n] - w[n] > 0.0 or kind == o.STICKING:
            if kind != o.DISC:
                active[m] = n
                m += 1
            active[m], active[m + 1] = n + 1, n + 2
            m += 2
    e, place = 1.0 - eps, 0
    while place < m:
        n = 3 * (active[place] // 3)
        d00, d10, d11, d12, d20, d21, d22 = slope(
            work.contact[n // 3], p[n] - w[n], p[n + 1] - w[n + 1], p[n + 2] - w[n + 2]
        )
        r0, r1, r2 = work.W[n], work.W[n + 1], work.W[n + 2]
        if active[place] == n:
            j0 = work.matrix[place]
            for q in range(m):
                j0[q] = d00 * r0[active[q]]
            j0[place] += 1.0 - e * d00
            place += 1
        j1, j2 = work.matrix[place], work.matrix[place + 1]
        for q in range(m):
            j = active[q]
            a, b, c = r0[j], r1[j], r2[j]
            j1[q] = d10 * a + d11 * b + d12 * c
            j2[q] = d20 * a + d21 * b + d22 * c
        if place > 0 and active[place - 1] == n:
            j1[place - 1] -= e * d10
            j2[place - 1] -= e * d20
        j1[place] += 1.0 - e * d11
        j1[place + 1] -= e * d12
        j2[place] -= e * d21
        j2[place + 1] += 1.0 - e * d22
        place += 2
    factor(work.matrix, m, work.pivot, LEAST_PIVOT)
    work.count[o.FACTOR_ROWS] = m


@kernel
def solve_newton(work, k):
    """Write the step for the f at p, w with the present factors."""
    p, w, f = work.vector[o.ITERATE], work.vector[o.RESULTING], work.vector[o.F]
    step, rhs = work.vector[o.STEP], work.vector[o.RHS]
    opening, rows = False, work.count[o.FACTOR_ROWS]
    for j in range(3 * k):
        step[j] = -f[j]
    for q in range(rows):
        step[work.active[q]] = 0.0
        rhs[q] = -f[work.active[q]]
    for j in range(3 * k):
        opening = opening or step[j] != 0.0
    place = 0
    while opening and place < rows:
        n = 3 * (work.active[place] // 3)
        d00, d10, d11, d12, d20, d21, d22 = slope(
            work.contact[n // 3], p[n] - w[n], p[n + 1] - w[n + 1], p[n + 2] - w[n + 2]
        )
        r0, r1, r2 = work.W[n], work.W[n + 1], work.W[n + 2]
        s0, s1, s2 = 0.0, 0.0, 0.0  # effect of the steps of open contacts
        for j in range(3 * k):
            q = step[j]
            s0 += r0[j] * q
            s1 += r1[j] * q
            s2 += r2[j] * q
        if work.active[place] == n:
            rhs[place] -= d00 * s0
            place += 1
        rhs[place] -= d10 * s0 + d11 * s1 + d12 * s2
        rhs[place + 1] -= d20 * s0 + d21 * s1 + d22 * s2
        place += 2
    substitute(work.matrix, rows, work.pivot, rhs)
    for q in range(rows):
        step[work.active[q]] = rhs[q]
