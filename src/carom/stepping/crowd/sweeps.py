"""The contact problem by sweeps: each contact in turn solved exactly, the others as they are (Gauss-Seidel).

A sweep costs 60 ns a contact, and goes on from the last step's impulses.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.friction.layout import BEST, P
from carom.friction.operators import sweep
from carom.friction.strategy import copy, residual

EACH = 20  # sweeps between looks at the residual
DIVERGED = 1e3  # times the residual at the start: that is no way


@kernel
def sweep_until(system, crowd, k, tolerance, most):
    """Sweep until the scaled residual is small; return it, what round-off makes of it, and how often.

    With friction sweeps may diverge, above all where joints tie the points: what has become worse is given up.
    """
    work, done = crowd.problem, 0
    p, start = work.vector[P], work.vector[BEST]
    r, goal, _ = residual(work, k)
    before = r
    copy(k, p, start)
    while not r <= max(tolerance, goal) and done < most and r <= DIVERGED * before:
        bound_torques(system, crowd, k)
        for i in range(EACH):
            sweep(work, k, i % 2 == 1)
        done += EACH
        r, goal, _ = residual(work, k)
    if not r <= before:
        copy(k, start, p)
        r, goal, _ = residual(work, k)
    return r, goal, done


@kernel
def bound_torques(system, crowd, k):
    """Write the bounds d N of rolling and pivoting friction, from the normal impulses at hand."""
    row, q = crowd.problem.contact, crowd.problem.vector[P]
    for i in range(k):
        spot = crowd.spots[i]
        if spot.turns > 0:
            d, parent = system.contacts[spot.contact].turning[spot.turns - 1], spot.parent
            most = d / crowd.points[0][i].length * row[parent].scale * q[3 * parent]
            row[i].h1 = max(0.0, most) / row[i].scale
