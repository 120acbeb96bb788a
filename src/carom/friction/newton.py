"""Semi-smooth Newton on the equations of Alart and Curnier, with a proximal term.

f(p) = p - project(p - w) = 0 with w = W p + c + eps (p - centre), in scaled variables. W is often singular
(four corners of a box: rank 6 of 12). With eps the step is unique; if the centre is 0, the solution is
the one of least norm. Mathematics page, §3.2.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction import layout as o
from carom.friction.cone import project
from carom.friction.operators import factor, multiply, solve
from carom.friction.thresholds import CHORD_GAIN, NEWTON_FLOOR, SHORTEST_SEARCH, UNDAMPED_MISMATCH

_LIMIT = 100
_UNDAMPED = 10  # greatest number of undamped steps in a row


@unit
def newton(work, k, eps, patient):
    """Iterate from p; add the number of steps to `ITERATIONS`, and write the final |f| to `mismatch`.

    A step must reduce |f|; if `patient`, it must only be below the greatest of the last four |f|, which helps
    to pass a kink. Existing factors (work.count[ROWS] >= 0) are tried first.

    Near a solution whose matrix is almost singular, a whole step makes |f| greater by the curvature of cones,
    and the next one removes that: damped, such steps creep along a curved valley. So where no shorter step
    reduces a small |f|, some undamped steps follow, which count if they halve it (a watchdog: Chamberlain et
    al. 1982).
    """
    p, step, change = work.vector[o.ITERATE], work.vector[o.STEP], work.vector[o.CHANGE]
    count, undamped, least = 0, 0, 0.0
    size = _arrive(work, k, eps)
    before1, before2, before3 = 0.0, 0.0, 0.0
    while count < _LIMIT and size > work.mismatch[o.ENOUGH]:
        count += 1
        chord = work.count[o.FACTOR_ROWS] >= 0
        if not chord:
            factor(work, k, eps)
        solve(work, k)
        for i in range(3 * k):
            change[i] = eps * step[i]
        multiply(work, k, step, change)
        t = 1.0
        if not chord and undamped == 0:
            bound = max(size, before1, before2, before3) if patient else size
            t = _search(work, k, bound)
            if t == 0.0:
                if not size < UNDAMPED_MISMATCH * largest_impulse(work, k):
                    break
                copy(k, p, work.vector[o.UNDAMPED_START])
                t, undamped, least = 1.0, 1, size
        elif chord and not _mismatch(work, k, t) < CHORD_GAIN * size:
            work.count[o.FACTOR_ROWS] = -1
            if size < NEWTON_FLOOR * largest_impulse(work, k):
                break
            continue
        for i in range(3 * k):
            p[i] += t * step[i]
        before1, before2, before3 = size, before1, before2
        size = _arrive(work, k, eps)
        if size < NEWTON_FLOOR * largest_impulse(work, k) and not size < 0.5 * before1:
            break
        if not size < CHORD_GAIN * before1:
            work.count[o.FACTOR_ROWS] = -1
        if undamped > 0:
            undamped = 0 if size < 0.5 * least else undamped + 1
            if undamped > _UNDAMPED or not size < math.inf:
                break
    if undamped > 0 and not size < least:
        copy(k, work.vector[o.UNDAMPED_START], p)
        size = least
    work.count[o.ITERATIONS] += count
    work.mismatch[0] = size


@kernel
def step(work, k, eps):
    """Make one whole step from p, which is also the centre of the proximal term, and project the result."""
    p, centre, change = work.vector[o.ITERATE], work.vector[o.CENTRE], work.vector[o.STEP]
    copy(k, p, centre)
    _arrive(work, k, eps)
    factor(work, k, eps)
    solve(work, k)
    for i in range(3 * k):
        p[i] += change[i]
    for i in range(k):
        n = 3 * i
        p[n], p[n + 1], p[n + 2] = project(work.contact[i], p[n], p[n + 1], p[n + 2])
    work.count[o.ITERATIONS] += 1


@kernel
def _search(work, k, bound):
    """Return the first of t = 1, 1/2, ... with |f| well below the bound; else the best, 0 if none is below."""
    t, best_t, best = 1.0, 0.0, bound
    while t >= SHORTEST_SEARCH:
        trial = _mismatch(work, k, t)
        if trial < best:
            best_t, best = t, trial
        if trial < (1.0 - 0.1 * t) * bound:
            break
        t *= 0.5
    return best_t


@kernel
def _arrive(work, k, eps):
    """Write w and f at p; return |f|."""
    velocity(work, k)
    p, w, centre = work.vector[o.ITERATE], work.vector[o.RESULTING], work.vector[o.CENTRE]
    for i in range(3 * k):
        w[i] += eps * (p[i] - centre[i])
    return _mismatch(work, k, 0.0)


@kernel
def velocity(work, k):
    """Write w = W p + c."""
    w, c = work.vector[o.RESULTING], work.vector[o.BIAS]
    copy(k, c, w)
    multiply(work, k, work.vector[o.ITERATE], w)


@kernel
def copy(k, p, to):
    """Copy the impulses of k contacts."""
    for i in range(3 * k):
        to[i] = p[i]


@kernel
def largest_impulse(work, k):
    """Return 1 + the greatest scaled impulse: the scale of round-off."""
    most, p = 0.0, work.vector[o.ITERATE]
    for i in range(3 * k):
        most = max(most, abs(p[i]))
    return 1.0 + most


@kernel
def _mismatch(work, k, t):
    """Return |f| at p + t step; f itself is written for t = 0."""
    total = 0.0
    p, w, f = work.vector[o.ITERATE], work.vector[o.RESULTING], work.vector[o.F]
    step, change = work.vector[o.STEP], work.vector[o.CHANGE]
    for i in range(k):
        a, b, c = 3 * i, 3 * i + 1, 3 * i + 2
        p0, p1, p2 = p[a], p[b], p[c]
        x0, x1, x2 = p0 - w[a], p1 - w[b], p2 - w[c]
        if t != 0.0:
            p0, p1, p2 = p0 + t * step[a], p1 + t * step[b], p2 + t * step[c]
            x0 += t * (step[a] - change[a])
            x1 += t * (step[b] - change[b])
            x2 += t * (step[c] - change[c])
        y0, y1, y2 = project(work.contact[i], x0, x1, x2)
        f0, f1, f2 = p0 - y0, p1 - y1, p2 - y2
        total += f0 * f0 + f1 * f1 + f2 * f2
        if t == 0.0:
            f[a], f[b], f[c] = f0, f1, f2
    return math.sqrt(total)
