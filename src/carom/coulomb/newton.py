"""Semi-smooth Newton on the equations of Alart and Curnier, with a proximal term.

f(p) = p - project(p - w) = 0 with w = W p + c + eps (p - centre), in scaled variables. W is often singular
(four corners of a box: rank 6 of 12); eps makes the step unique, and with the centre at 0 the
solution that of least norm. Mathematics page, VI.2.
"""

from __future__ import annotations

import math

from carom.coulomb.cone import project
from carom.coulomb.operators import factor, multiply, solve
from carom.jit import kernel

_FLOOR = 1e-13  # below this part of 1 + |p| the iteration only polishes, while each step halves f
_SHORTEST = 1e-3  # of the line search
_CHORD = 0.1  # factors are kept for another step if the last one reduced f by this


@kernel
def newton(k, mu, kind, heading, eps, limit, patient, rows, work):
    """Iterate from work.p; return (iterations, rows of the factors at hand, or -1).

    A step must reduce |f|; or, if `patient`, the greatest of the last four: the way past a kink. `rows` is
    what the last call returned if its factors may be tried first, else -1.
    """
    p, count = work.p, 0
    size = _arrive(k, mu, kind, heading, eps, work)
    before1, before2, before3 = 0.0, 0.0, 0.0
    while count < limit and size > 0.0:
        count += 1
        chord = rows >= 0
        if not chord:
            rows = factor(work, k, mu, kind, heading, eps)
        solve(work, k, mu, kind, heading, rows)
        for i in range(3 * k):
            work.change[i] = eps * work.step[i]
        multiply(work, k, work.step, work.change)
        t = 1.0
        if not chord:
            bound = max(size, before1, before2, before3) if patient else size
            t = _search(k, mu, kind, heading, bound, work)
            if t == 0.0:
                break
        elif not _mismatch(k, mu, kind, heading, t, work) < _CHORD * size:
            rows = -1
            if size < _FLOOR * _magnitude(k, work):
                break
            continue
        for i in range(3 * k):
            p[i] += t * work.step[i]
        before1, before2, before3 = size, before1, before2
        size = _arrive(k, mu, kind, heading, eps, work)
        if size < _FLOOR * _magnitude(k, work) and not size < 0.5 * before1:
            break
        if not size < _CHORD * before1:
            rows = -1
    return count, rows


@kernel
def _search(k, mu, kind, heading, bound, work):
    """Return the first of t = 1, 1/2, ... with |f| well below the bound, else the best, 0 if none is below."""
    t, best_t, best = 1.0, 0.0, bound
    while t >= _SHORTEST:
        trial = _mismatch(k, mu, kind, heading, t, work)
        if trial < best:
            best_t, best = t, trial
        if trial < (1.0 - 0.1 * t) * bound:
            break
        t *= 0.5
    return best_t


@kernel
def _arrive(k, mu, kind, heading, eps, work):
    """Write w and f at p; return |f|."""
    velocity(k, work)
    for i in range(3 * k):
        work.w[i] += eps * (work.p[i] - work.centre[i])
    return _mismatch(k, mu, kind, heading, 0.0, work)


@kernel
def velocity(k, work):
    """Write w = W p + c."""
    for i in range(3 * k):
        work.w[i] = work.c[i]
    multiply(work, k, work.p, work.w)


@kernel
def _magnitude(k, work):
    """Return 1 + the greatest scaled impulse: what round-off is relative to."""
    most = 0.0
    for i in range(3 * k):
        most = max(most, abs(work.p[i]))
    return 1.0 + most


@kernel
def _mismatch(k, mu, kind, heading, t, work):
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
