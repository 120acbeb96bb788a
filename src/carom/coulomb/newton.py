"""Semi-smooth Newton on the equations of Alart and Curnier, with a proximal term.

f(p) = p - project(p - w) = 0 with w = W p + c + eps (p - centre), in scaled variables. W is often singular
(four corners of a box: rank 6 of 12); eps makes the step unique, and with the centre at 0 the
solution that of least norm. Open contacts leave the system. Mathematics page, VI.2.
"""

from __future__ import annotations

import math

from carom.coulomb.cone import project, slope
from carom.coulomb.layout import STICKING
from carom.coulomb.lu import factor, substitute
from carom.coulomb.scaled import velocity
from carom.jit import kernel

_FLOOR = 1e-13  # below this the iteration only polishes, as long as each step halves f
_SHORTEST = 1e-3  # of the line search


@kernel
def newton(k, mu, kind, heading, eps, limit, work):
    """Iterate from work.p; return (f, iterations), f the norm reached; work.w = W p + c at the end."""
    n, p = 3 * k, work.p
    count = 0
    _regularised(k, eps, work)
    size = mismatch(k, mu, kind, heading, 0.0, work)
    while count < limit and size > 0.0:
        count += 1
        _step(k, mu, kind, heading, eps, work)
        _change(k, eps, work)
        t, best_t, best = 1.0, 0.0, size
        while t >= _SHORTEST:
            trial = mismatch(k, mu, kind, heading, t, work)
            if trial < best:
                best_t, best = t, trial
            if trial < (1.0 - 0.1 * t) * size:
                break
            t *= 0.5
        if not best < size:
            break
        for i in range(n):
            p[i] += best_t * work.step[i]
        _regularised(k, eps, work)
        before = size
        size = mismatch(k, mu, kind, heading, 0.0, work)
        if size < _FLOOR and not size < 0.5 * before:
            break
    velocity(k, work)
    return size, count


@kernel
def _regularised(k, eps, work):
    velocity(k, work)
    for i in range(3 * k):
        work.w[i] += eps * (work.p[i] - work.centre[i])


@kernel
def _change(k, eps, work):
    """Write (W + eps) step."""
    n, out = 3 * k, work.change
    for i in range(n):
        out[i] = eps * work.step[i]
    for j in range(n):
        q, column = work.step[j], work.W[j]
        if q != 0.0:
            for i in range(n):
                out[i] += q * column[i]


@kernel
def mismatch(k, mu, kind, heading, t, work):
    """Return |f| at p + t step; f itself is written for t = 0."""
    total = 0.0
    p, w, step, change = work.p, work.w, work.step, work.change
    for i in range(k):
        a, b, c = 3 * i, 3 * i + 1, 3 * i + 2
        p0, p1, p2 = p[a], p[b], p[c]
        x0, x1, x2 = p0 - w[a], p1 - w[b], p2 - w[c]
        if t != 0.0:
            p0, p1, p2 = p0 + t * step[a], p1 + t * step[b], p2 + t * step[c]
            x0 += t * (step[a] - change[a])
            x1 += t * (step[b] - change[b])
            x2 += t * (step[c] - change[c])
        y0, y1, y2 = project(kind[i], mu[i], heading[i, 0], heading[i, 1], x0, x1, x2)
        f0, f1, f2 = p0 - y0, p1 - y1, p2 - y2
        total += f0 * f0 + f1 * f1 + f2 * f2
        if t == 0.0:
            work.f[a], work.f[b], work.f[c] = f0, f1, f2
    return math.sqrt(total)


@kernel
def _step(k, mu, kind, heading, eps, work):
    """Write the step: (I - D + D (W + eps)) step = -f, open contacts (D = 0) eliminated."""
    p, w, f, step = work.p, work.w, work.f, work.step
    active, m = work.active, 0
    for i in range(k):
        n = 3 * i
        closed = p[n] - w[n] > 0.0 or kind[i] == STICKING
        for r in range(n, n + 3):
            if closed:
                active[m] = r
                m += 1
                step[r] = 0.0
            else:
                step[r] = -f[r]
    rhs = work.change
    for place in range(0, m, 3):
        n = active[place]
        i = n // 3
        d00, d10, d11, d12, d20, d21, d22 = slope(
            kind[i], mu[i], heading[i, 0], heading[i, 1],
            p[n] - w[n], p[n + 1] - w[n + 1], p[n + 2] - w[n + 2],
        )  # fmt: skip
        r0, r1, r2 = work.W[n], work.W[n + 1], work.W[n + 2]
        s0, s1, s2 = 0.0, 0.0, 0.0  # W times what is known already: open contacts
        for j in range(3 * k):
            q = step[j]
            s0 += r0[j] * q
            s1 += r1[j] * q
            s2 += r2[j] * q
        rhs[place] = -f[n] - d00 * s0
        rhs[place + 1] = -f[n + 1] - d10 * s0 - d11 * s1 - d12 * s2
        rhs[place + 2] = -f[n + 2] - d20 * s0 - d21 * s1 - d22 * s2
        j0, j1, j2 = work.jacobian[place], work.jacobian[place + 1], work.jacobian[place + 2]
        for q in range(m):
            j = active[q]
            a, b, c = r0[j], r1[j], r2[j]
            j0[q] = d00 * a
            j1[q] = d10 * a + d11 * b + d12 * c
            j2[q] = d20 * a + d21 * b + d22 * c
        e = 1.0 - eps
        j0[place] += 1.0 - e * d00
        j1[place] -= e * d10
        j1[place + 1] += 1.0 - e * d11
        j1[place + 2] -= e * d12
        j2[place] -= e * d20
        j2[place + 1] -= e * d21
        j2[place + 2] += 1.0 - e * d22
    factor(work.jacobian, m, work.pivot, 1e-14)
    substitute(work.jacobian, m, work.pivot, rhs)
    for q in range(m):
        step[active[q]] = rhs[q]
