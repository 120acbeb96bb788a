"""How the solvers go about it: Newton first; where that fails, from other starting points."""

from __future__ import annotations

import math

from carom.coulomb.alternating import alternate
from carom.coulomb.cone import nearest, project, shift
from carom.coulomb.newton import newton, velocity
from carom.coulomb.operators import magnitude, sweep
from carom.coulomb.residual import RELATIVE, ROUND_OFF
from carom.jit import kernel

_EPS = 1e-8  # weight of the proximal term
_NEWTON = 100  # most iterations a try
_POLISH = 8  # most moves of the proximal centre
_STARTS = 20  # most starting points
_EXTRA = 2  # more of them where the tolerance is met, but not to round-off
_SWEEPS = 25  # at first, twice as many each time, at most
_MOST_SWEEPS = 200
_ALTERNATIONS = 300
_CONTINUE_FROM, _CONTINUE_BY = 0.3, 0.3  # weights of the proximal term in a continuation


@kernel
def search(k, mu, kind, heading, work):
    """Leave in work.p the best that is found from one starting point after the other; return iterations."""
    p, best = work.p, work.best
    least, iterations, last, start = math.inf, 0, _STARTS, 0
    while start < last:
        if start > 0:
            iterations += _approach(k, mu, kind, heading, start, work)
        count, r, goal, tolerance = _polished(k, mu, kind, heading, start, work)
        iterations += count
        if r < least:
            least = r
            for i in range(3 * k):
                best[i] = p[i]
        if least <= goal:
            break
        start += 1
        if least <= 0.9 * tolerance:
            last = min(last, start + _EXTRA)
    for i in range(3 * k):
        p[i] = best[i]
    return iterations


@kernel
def _approach(k, mu, kind, heading, start, work):
    """Move work.p to another starting point for Newton; return iterations."""
    if start % 2 == 1:
        sweeps = min(_SWEEPS * 2 ** (start // 2), _MOST_SWEEPS)
        for i in range(sweeps):
            sweep(work, k, mu, kind, heading, i % 2 == 1)
        return sweeps
    sigma = 0.01 * 10.0 ** ((start // 2) % 3)
    alternate(k, mu, kind, heading, sigma, _ALTERNATIONS, work)
    total = _ALTERNATIONS
    if start % 4 == 2:  # a strong proximal term, released step by step
        eps = _CONTINUE_FROM
        while eps > 10.0 * _EPS:
            for i in range(3 * k):
                work.centre[i] = work.p[i]
            count, _ = newton(k, mu, kind, heading, eps, _NEWTON, False, -1, work)
            total += count
            eps *= _CONTINUE_BY
    return total


@kernel
def _polished(k, mu, kind, heading, start, work):
    """Newton until the proximal term has no effect; return (iterations, residual, goal, tolerance).

    The term is centred at 0 in the first start, for the solution of least norm, then at p; and it is moved
    to each new solution until its bias is gone. work.p is the best of the rounds.
    """
    p, kept = work.p, work.kept
    for i in range(3 * k):
        work.centre[i] = p[i] if start > 0 else 0.0
    total, rows, least = 0, -1, math.inf
    goal, tolerance = 0.0, 0.0
    for _ in range(_POLISH):
        count, rows = newton(k, mu, kind, heading, _EPS, _NEWTON, start % 2 == 1, rows, work)
        total += count
        for i in range(k):
            n = 3 * i
            p[n], p[n + 1], p[n + 2] = project(
                kind[i], mu[i], heading[i, 0], heading[i, 1], p[n], p[n + 1], p[n + 2]
            )
        r, goal, tolerance = _residual(k, mu, kind, heading, work)
        enough = r <= goal or not r < 0.5 * least
        if r < least:
            least = r
            for i in range(3 * k):
                kept[i] = p[i]
        if enough:
            break
        for i in range(3 * k):
            work.centre[i] = p[i]
    for i in range(3 * k):
        p[i] = kept[i]
    return total, least, goal, tolerance


@kernel
def _residual(k, mu, kind, heading, work):
    """Return (residual, goal, tolerance) of work.p in velocity; the goal is what round-off allows."""
    velocity(k, work)
    p, w = work.p, work.w
    worst, largest = 0.0, 0.0
    for i in range(k):
        a, b, c = 3 * i, 3 * i + 1, 3 * i + 2
        m, h1, h2 = mu[i], heading[i, 0], heading[i, 1]
        x0 = p[a] - w[a] - shift(kind[i], m, h1, h2, w[b], w[c])
        y0, y1, y2 = nearest(kind[i], m, h1, h2, x0, p[b] - w[b], p[c] - w[c])
        d0, d1, d2 = p[a] - y0, p[b] - y1, p[c] - y2
        r = math.sqrt(d0 * d0 + d1 * d1 + d2 * d2) / work.scale[i]
        if not r <= worst and worst == worst:  # NaN enters, and stays
            worst = r
        largest = max(largest, max(abs(work.c[a]), abs(work.c[b]), abs(work.c[c])) / work.scale[i])
    size = magnitude(work, k)
    return worst, 1e-14 * largest + 0.08 * ROUND_OFF * size, RELATIVE * largest + ROUND_OFF * size
