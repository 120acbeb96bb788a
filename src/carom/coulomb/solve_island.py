"""The contact problem of a large island, without W: `solve_island`."""

from __future__ import annotations

import math

from carom.coulomb.layout import BAD_INPUT, NOT_SOLVED, SOLVED
from carom.coulomb.residual import measure_island
from carom.coulomb.search import search
from carom.coulomb.solve import scale_vectors
from carom.jit import entry, kernel


@entry
def solve_island(k, island, mu, kind, heading, p, scratch, motion):
    """Solve the contact problem of an `Island`; return (status, residual, iterations).

    As `carom.coulomb.solve.solve_cones`, with W = G M^-1 G^T given by bodies and rows. `scratch` is from
    `arrays.new_island_work` for the graph of these contacts, `motion` (2, N, 6) is scratch too.
    """
    if k == 0:
        return SOLVED, 0.0, 0
    gamma = _load(k, island, mu, heading, p, scratch)
    if not math.isfinite(gamma):
        for i in range(3 * k):
            p[i] = 0.0
        return BAD_INPUT, math.inf, 0
    iterations = search(k, mu, kind, heading, scratch)
    for i in range(3 * k):
        p[i] = gamma * scratch.scale[i // 3] * scratch.p[i]
    residual, tolerance, _, _, _ = measure_island(k, island, mu, kind, heading, p, motion)
    return SOLVED if residual <= tolerance else NOT_SOLVED, residual, iterations


@kernel
def _load(k, island, mu, heading, p, work):
    """Write rows and vectors in the scaled variables of `solve`; return gamma, or NaN if the input is bad."""
    total = 0.0
    for i in range(k):
        total += mu[i] + heading[i, 0] + heading[i, 1]
        if not mu[i] >= 0.0:
            return math.nan
        W = work.local[i]
        for r in range(6):
            W[r] = 0.0
        for side in range(2):
            b = island.body[i, side]
            if b < 0:
                continue
            G, M, Y = island.rows[i, side], island.inverse_mass[b], work.response[i, side]
            for r in range(6):
                for a in range(3):
                    s = 0.0
                    for j in range(6):
                        s += M[r, j] * G[a, j]
                    Y[r, a] = s
            at = 0
            for a in range(3):
                for d in range(a, 3):
                    for j in range(6):
                        W[at] += G[a, j] * Y[j, d]
                    at += 1
        trace = W[0] + W[3] + W[5]
        s = math.sqrt(3.0 / trace) if trace > 0.0 else 1.0
        work.scale[i] = s
        for r in range(6):
            W[r] *= s * s
            total += W[r]
        for side in range(2):
            G, H, Y = island.rows[i, side], work.rows[i, side], work.response[i, side]
            for r in range(6):
                for a in range(3):
                    H[a, r] = s * G[a, r]
                    Y[r, a] *= s
    if not math.isfinite(total):
        return math.nan
    return scale_vectors(k, island.c, p, work)
