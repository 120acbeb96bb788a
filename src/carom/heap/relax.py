"""The contact problem by sweeps: each contact in turn solved exactly, the others as they are (Gauss-Seidel).

A sweep costs 60 ns a contact and goes on from the last step's impulses. Newton on the graph of the bodies
(`carom.coulomb.solve_island`) takes as long for one factor as a hundred sweeps, and needs hundreds of factors
where a thousand contacts slip and open.
"""

from __future__ import annotations

from carom.coulomb.island import impart, sweep
from carom.coulomb.layout import P
from carom.coulomb.search import residual
from carom.coulomb.solve import scale_vectors
from carom.jit import kernel

EACH = 10  # sweeps between looks at the residual


@kernel
def relax(system, heap, k, tolerance, most, clock):
    """Sweep until the residual is below the tolerance [m/s], or round-off; return a factor, and the residual.

    Impulses go to `heap.p`; the motion that they cause, over the factor, to the bodies of the problem.
    """
    work = heap.problem
    gamma, done = scale_vectors(work, k, heap.c, heap.p), 0
    r, goal, _ = residual(work, k)
    while not gamma * r <= max(tolerance, gamma * goal) and done < most:
        bound_torques(system, heap, k)
        for i in range(EACH):
            sweep(work, k, i % 2 == 1)
        done += EACH
        r, goal, _ = residual(work, k)
    impart(work, k)
    for i in range(3 * k):
        heap.p[i] = gamma * work.contact[i // 3].scale * work.vector[P, i]
    clock.rounds += done
    return gamma, gamma * r


@kernel
def bound_torques(system, heap, k):
    """Write the bounds d N of rolling and pivoting friction, from the normal impulses at hand."""
    row, q = heap.problem.contact, heap.problem.vector[P]
    for i in range(k):
        spot = heap.spots[i]
        if spot.turns > 0:
            d, parent = system.contacts[spot.contact].turning[spot.turns - 1], spot.parent
            most = d / heap.points[0][i].length * row[parent].scale * q[3 * parent]
            row[i].h1 = max(0.0, most) / row[i].scale
