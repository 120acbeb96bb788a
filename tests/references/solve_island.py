"""The contact problem of a large island, without W: `solve_island`."""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.friction import layout as o
from carom.friction.layout import BAD_PROBLEM, NOT_SOLVED, SOLVED
from carom.friction.residual import NOTHING, summary, with_contact
from carom.friction.solve import scale_link, scale_vectors
from carom.friction.strategy import search


@entry
def solve_island(k, island, mu, kind, heading, p, workspace):
    """Solve the contact problem of an `Island`; return (status, residual, iterations).

    As `carom.friction.solve.solve_cones`, with W = G M^-1 G^T given by bodies and rows. `workspace` is from
    `island_arrays.new_island_work` for the graph of these contacts.
    """
    if k == 0:
        return SOLVED, 0.0, 0
    gamma = _load(workspace, k, island, mu, kind, heading, p)
    if not math.isfinite(gamma):
        for i in range(3 * k):
            p[i] = 0.0
        return BAD_PROBLEM, math.inf, 0
    search(workspace, k)
    for i in range(3 * k):
        p[i] = gamma * workspace.contact[i // 3].scale * workspace.vector[o.ITERATE, i]
    residual, tolerance, _, _, _ = measure_island(k, island, mu, kind, heading, p)
    return SOLVED if residual <= tolerance else NOT_SOLVED, residual, workspace.count[o.ITERATIONS]


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


@entry
def measure_island(k, island, mu, kind, heading, p):
    """Return the same as `carom.friction.residual.measure` for an island.

    (|W| |p|)_i is replaced by its bound (|G| |M^-1| |G|^T |p|)_i.
    """
    motion = island.motion
    _impart(k, island, p)
    greatest = NOTHING
    for i in range(k):
        n, trace, size = 3 * i, 0.0, 0.0
        w0, w1, w2 = island.c[n], island.c[n + 1], island.c[n + 2]
        for side in range(2):
            b = island.body[i, side]
            if b < 0:
                continue
            G, M = island.rows[i, side], island.inverse_mass[b]
            for j in range(6):
                w0 += G[0, j] * motion[0, b, j]
                w1 += G[1, j] * motion[0, b, j]
                w2 += G[2, j] * motion[0, b, j]
            for r in range(3):
                s = 0.0
                for j in range(6):
                    s += abs(G[r, j]) * motion[1, b, j]
                    for m in range(6):
                        trace += G[r, j] * M[j, m] * G[r, m]
                size = max(size, s)
        scale = trace, max(abs(island.c[n]), abs(island.c[n + 1]), abs(island.c[n + 2])), size
        cone = kind[i], mu[i], heading[i, 0], heading[i, 1]
        greatest = with_contact(greatest, cone, scale, (p[n], p[n + 1], p[n + 2]), (w0, w1, w2))
    return summary(greatest)


@kernel
def _impart(k, island, p):
    """Write the motion of the bodies that impulses p cause, and a bound of it without cancellation."""
    motion = island.motion
    for b in range(motion.shape[1]):
        for j in range(6):
            motion[0, b, j] = motion[1, b, j] = 0.0
    for i in range(k):
        for side in range(2):
            b = island.body[i, side]
            if b < 0:
                continue
            G, M = island.rows[i, side], island.inverse_mass[b]
            for j in range(6):
                g = G[0, j] * p[3 * i] + G[1, j] * p[3 * i + 1] + G[2, j] * p[3 * i + 2]
                a = abs(G[0, j] * p[3 * i]) + abs(G[1, j] * p[3 * i + 1])
                a += abs(G[2, j] * p[3 * i + 2])
                for r in range(6):
                    motion[0, b, r] += M[r, j] * g
                    motion[1, b, r] += abs(M[r, j]) * a
