"""The contact problem of a large island, without W: `solve_island`."""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.friction import layout as o
from carom.friction.layout import BAD_INPUT, NOT_SOLVED, SOLVED
from carom.friction.residual import measure_island
from carom.friction.solve import scale_link, scale_vectors
from carom.friction.strategy import search


@entry
def solve_island(k, island, mu, kind, heading, p, scratch):
    """Solve the contact problem of an `Island`; return (status, residual, iterations).

    As `carom.friction.solve.solve_cones`, with W = G M^-1 G^T given by bodies and rows. `scratch` is from
    `arrays.new_island_work` for the graph of these contacts.
    """
    if k == 0:
        return SOLVED, 0.0, 0
    gamma = _load(scratch, k, island, mu, kind, heading, p)
    if not math.isfinite(gamma):
        for i in range(3 * k):
            p[i] = 0.0
        return BAD_INPUT, math.inf, 0
    search(scratch, k)
    for i in range(3 * k):
        p[i] = gamma * scratch.contact[i // 3].scale * scratch.vector[o.P, i]
    residual, tolerance, _, _, _ = measure_island(k, island, mu, kind, heading, p, scratch.sums)
    return SOLVED if residual <= tolerance else NOT_SOLVED, residual, scratch.count[o.ITERATIONS]


@kernel
def _load(work, k, island, mu, kind, heading, p):
    """Write the problem in the scaled variables of `solve`; return gamma, or NaN if the input is bad."""
    for i in range(k):
        link = work.link[i]
        for side in range(2):
            b = link.body[side]
            if b < 0:
                continue
            M, G, Y = island.inverse_mass[b], link.rows[side], link.response[side]
            for r in range(6):
                for a in range(3):
                    G[a, r] = island.rows[i, side, a, r]
            for r in range(6):
                for a in range(3):
                    s = 0.0
                    for j in range(6):
                        s += M[r, j] * G[a, j]
                    Y[r, a] = s
        if not scale_link(link, work.contact[i], mu[i], kind[i], heading[i]):
            return math.nan
    return scale_vectors(work, k, island.c, p)
