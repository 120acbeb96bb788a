"""What has sunk in comes back to the surfaces: 0 <= lam _|_ phi + W_nn lam >= 0, xi = P G_n^T lam.

The same sweeps as for velocities, without friction, on gaps phi; repeated, as gaps are not linear.
"""

from __future__ import annotations

import math

from carom.contact.pair_point import smaller
from carom.coulomb.layout import CONE
from carom.heap.relax import relax
from carom.heap.spots import place_all
from carom.jit import kernel
from carom.motion.project import shift

TINY = 1e-11  # of the smaller body
PASSES, SWEEPS = 6, 200


@kernel
def onto_surfaces(system, k, count, end, heap, work):
    """Move the bodies apart where points have sunk in; `heap.points[1]` are those at the end."""
    problem = heap.problem
    for i in range(k):
        problem.contact[i].mu, problem.contact[i].kind = 0.0, CONE
    for _ in range(PASSES):
        place_all(system, k, end, heap, heap.points[1], work)
        deepest, tiny = 0.0, 1.0
        for i in range(k):
            gap = heap.points[1][i].gap if heap.spots[i].turns == 0 else math.inf
            size = smaller(system.contacts[heap.spots[i].contact])
            if gap < -TINY * size:
                deepest, tiny = max(deepest, -gap), min(tiny, 0.1 * TINY * size)
            heap.c[3 * i], heap.c[3 * i + 1], heap.c[3 * i + 2] = min(gap, size), 0.0, 0.0
            for r in range(3):
                heap.p[3 * i + r] = 0.0
        if deepest == 0.0:
            break
        gamma = relax(system, heap, k, tiny, SWEEPS)
        move(count, gamma, end, problem)


@kernel
def move(count, factor, state, problem):
    """Displace all bodies by a factor times the motions of the problem."""
    for b in range(count):
        xi = problem.body[b].motion
        for r in range(6):
            xi[r] *= factor
        shift(xi, state[b])
