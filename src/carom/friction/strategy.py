"""The strategy of the solver: Newton's method; if it fails, again from other starting points."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction import layout as o
from carom.friction import thresholds as limits
from carom.friction.cone import project
from carom.friction.newton import copy, largest_impulse, newton
from carom.friction.operators import sweep
from carom.friction.residual import residual
from carom.geometry.thresholds import ROUND_OFF

_POLISH = 8  # greatest number of rounds, each with a new proximal centre
_STARTS = 20  # greatest number of starting points
_EXTRA = 2  # further starting points if the tolerance is satisfied, but not round-off; or a hundred times that
_FIRST_SWEEPS = 25  # at first; twice as many each time, up to
_MOST_SWEEPS = 800
_RELEASES = 60


@unit
def search(work, k):
    """Try one starting point after another; leave the best p and the number of iterations in `work`.

    Start 0 seeks the solution of least norm from the given p. Start 1 seeks a solution near the given p,
    unless p is 0. The others begin after sweeps and after a release, in turn.
    """
    p, best, given = work.vector[o.ITERATE], work.vector[o.BEST], work.vector[o.GIVEN]
    least, last, cold = math.inf, _STARTS, True
    work.count[o.ITERATIONS] = 0
    copy(k, p, best)
    copy(k, p, given)
    for i in range(3 * k):
        cold = cold and p[i] == 0.0
    for start in range(_STARTS):
        if start >= last:
            break
        if start == 1:
            if cold:
                continue
            copy(k, given, p)
        elif start > 1:
            if start % 2 == 0:
                _smooth(work, k, (start - 2) // 2)
            else:
                release(work, k)
        r, goal, tolerance = polished(work, k, start == 0, start % 3 == 2)
        if r < least:
            least = r
            copy(k, p, best)
        if not r < math.inf:  # overflow: begin again from 0
            for i in range(3 * k):
                p[i] = 0.0
        if least <= goal:
            break
        if spent(work):
            break
        # where W is singular, round-off in c may be outside its range: then no start has a smaller residual
        if r <= 0.9 * tolerance and settled(work, k):
            break
        if least <= limits.ENOUGH_RESIDUAL * tolerance:
            last = min(last, start + 1 + _EXTRA)
    copy(k, best, p)


@kernel
def budget(k):
    """Return the number of iterations that a search among k contacts may use."""
    return max(300, int(limits.SEARCH_BUDGET / (k * k)))


@kernel
def spent(work):
    """Return whether a search has used up its budget of iterations."""
    return 0 < work.count[o.BUDGET] <= work.count[o.ITERATIONS]


@kernel
def _smooth(work, k, again):
    """Move p to another starting point by sweeps; `again` counts the earlier ones."""
    sweeps = min(_FIRST_SWEEPS * 2**again, _MOST_SWEEPS)
    for i in range(sweeps):
        sweep(work, k, i % 2 == 1)
    work.count[o.ITERATIONS] += sweeps


@kernel
def release(work, k):
    """Apply Newton's method with a strong proximal term, which is weakened as long as the method succeeds."""
    p, kept, centre = work.vector[o.ITERATE], work.vector[o.START_BEST], work.vector[o.CENTRE]
    copy(k, p, kept)
    eps = limits.RELEASE_START
    for _ in range(_RELEASES):
        if spent(work):
            break
        copy(k, kept, p)
        copy(k, kept, centre)
        work.count[o.FACTOR_ROWS] = -1
        newton(work, k, eps, True)
        if work.mismatch[0] < limits.RELEASED_RESIDUAL:
            copy(k, p, kept)
            eps *= limits.RELEASE_FACTOR
        else:
            eps /= limits.RELEASE_FACTOR
        if not 10.0 * limits.PROXIMAL < eps < 10.0 * limits.RELEASE_START:
            break
    copy(k, kept, p)


@kernel
def polished(work, k, least_norm, patient):
    """Iterate Newton's method until the proximal term has no effect; return (residual, goal, tolerance).

    The term is centred at 0, for the solution of least norm, or at p; then it is moved to each new solution
    until its bias is gone. p is the best of the rounds.
    """
    p, kept, centre = work.vector[o.ITERATE], work.vector[o.START_BEST], work.vector[o.CENTRE]
    for i in range(3 * k):
        centre[i] = 0.0 if least_norm else p[i]
    least = math.inf
    work.count[o.FACTOR_ROWS] = -1
    copy(k, p, kept)
    goal, tolerance, eps = 0.0, 0.0, limits.PROXIMAL
    for _ in range(_POLISH):
        newton(work, k, eps, patient)
        for i in range(k):
            n = 3 * i
            p[n], p[n + 1], p[n + 2] = project(work.contact[i], p[n], p[n + 1], p[n + 2])
        r, goal, tolerance = residual(work, k)
        slow = not r < 0.5 * least
        enough = r <= goal or (slow and (r <= tolerance or eps < limits.PROXIMAL)) or spent(work)
        if slow and not enough:  # a soft direction of W: a light body between heavy ones
            eps = limits.LEAST_PROXIMAL
            work.count[o.FACTOR_ROWS] = -1
        if r < least:
            least = r
            copy(k, p, kept)
        if enough:
            break
        copy(k, p, centre)
    copy(k, kept, p)
    return least, goal, tolerance


@kernel
def settled(work, k):
    """Return whether the last equations of Newton's method are solved to round-off."""
    return work.mismatch[0] <= ROUND_OFF * largest_impulse(work, k)
