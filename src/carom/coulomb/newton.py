"""Semi-smooth Newton on the equations of Alart and Curnier, with a proximal term.

f(p) = p - project(p - w) = 0 with w = W p + c + eps (p - centre), in scaled variables. W is often singular
(four corners of a box: rank 6 of 12); eps makes the step unique, and with the centre at 0 the
solution that of least norm. Mathematics page, VI.2.
"""

from __future__ import annotations

import math

from carom.coulomb.cone import project
from carom.coulomb.jacobian import factor_jacobian, solve_step
from carom.coulomb.scaled import add_columns, velocity
from carom.jit import kernel

_FLOOR = 1e-13  # below this part of |p| + 1 the iteration only polishes, as long as each step halves f
_SHORTEST = 1e-3  # of the line search
_CHORD = 0.1  # factors are kept for another step if the last one reduced f by this


@kernel
def newton(k, mu, kind, heading, eps, limit, factored, work):
    """Iterate from work.p; return (|f|, iterations, rows of the factors at hand).

    `factored` is what the last call returned if its factors may be tried first, else -1.
    """
    n, p = 3 * k, work.p
    count, m = 0, factored
    size = _arrive(k, mu, kind, heading, eps, work)
    while count < limit and size > 0.0:
        count += 1
        chord = m >= 0
        if not chord:
            m = factor_jacobian(k, mu, kind, heading, eps, work)
        solve_step(k, mu, kind, heading, m, work)
        _change(k, eps, work)
        if chord:
            t = 1.0
            trial = mismatch(k, mu, kind, heading, t, work)
            if not trial < _CHORD * size:
                m = -1
                if size < _FLOOR * magnitude(k, work):
                    break
                continue
        else:
            t, trial = _search(k, mu, kind, heading, size, work)
            if not trial < size:
                break
        for i in range(n):
            p[i] += t * work.step[i]
        before = size
        size = _arrive(k, mu, kind, heading, eps, work)
        if size < _FLOOR * magnitude(k, work) and not size < 0.5 * before:
            break
        if not size < _CHORD * before:
            m = -1
    return size, count, m


@kernel
def _search(k, mu, kind, heading, size, work):
    """Return (t, |f|) on the line of the step: the first t = 1, 1/2, ... that reduces f enough, or the best."""
    t, best_t, best = 1.0, 0.0, size
    while t >= _SHORTEST:
        trial = mismatch(k, mu, kind, heading, t, work)
        if trial < best:
            best_t, best = t, trial
        if trial < (1.0 - 0.1 * t) * size:
            break
        t *= 0.5
    return best_t, best


@kernel
def _arrive(k, mu, kind, heading, eps, work):
    """Write w and f at p; return |f|."""
    velocity(k, work)
    for i in range(3 * k):
        work.w[i] += eps * (work.p[i] - work.centre[i])
    return mismatch(k, mu, kind, heading, 0.0, work)


@kernel
def magnitude(k, work):
    """Return 1 + the greatest scaled impulse: what round-off is relative to."""
    most = 0.0
    for i in range(3 * k):
        most = max(most, abs(work.p[i]))
    return 1.0 + most


@kernel
def _change(k, eps, work):
    """Write (W + eps) step."""
    for i in range(3 * k):
        work.change[i] = eps * work.step[i]
    add_columns(k, work.W, work.step, work.change)


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
