"""An island of bodies and contacts: what is given, its graph, and the work arrays of its solve.

A block (6, 6) couples two bodies. Diagonal blocks come first, one a body; then, for each pair of bodies that
the elimination couples, the block right of the diagonal, and after all of those the ones below it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Island(NamedTuple):
    """N bodies and k contacts between them: w = G v, v = c + M^-1 G^T p body by body."""

    body: np.ndarray  # (k, 2) int64, the two bodies of a contact; -1 is the ground
    rows: np.ndarray  # (k, 2, 3, 6) G of each contact and body; (n, t1, t2)
    inverse_mass: np.ndarray  # (N, 6, 6) symmetric
    c: np.ndarray  # (3k,) velocity of the contacts without impulses


class IslandGraph(NamedTuple):
    """Which blocks there are and in which order bodies are eliminated; made by `graph.island_graph`."""

    order: np.ndarray  # (N,) bodies in the order of elimination
    start: np.ndarray  # (N + 1,) first pair of each place in that order
    later: np.ndarray  # (pairs,) the body of a pair that is eliminated later
    update: np.ndarray  # (N + 1,) first row of `target` of each place
    target: (
        np.ndarray
    )  # (updates, 3) pair s, pair t, block from which below[s] right[t] is subtracted
    place: np.ndarray  # (k, 2, 2) block of each contact for its bodies, -1 for the ground


class IslandWork(NamedTuple):
    """Work arrays of `carom.coulomb.solve_island.solve_island`, in scaled variables."""

    c: np.ndarray  # (3k,) vectors as in `carom.coulomb.layout.ConeWork`
    p: np.ndarray
    w: np.ndarray
    f: np.ndarray
    step: np.ndarray
    change: np.ndarray
    rhs: np.ndarray
    centre: np.ndarray
    kept: np.ndarray
    best: np.ndarray
    scale: np.ndarray  # (k,)
    graph: IslandGraph
    body: np.ndarray  # (k, 2)
    rows: np.ndarray  # (k, 2, 3, 6) scaled G
    response: np.ndarray  # (k, 2, 6, 3) M^-1 G^T
    local: np.ndarray  # (k, 6) upper triangle of the diagonal block of W
    compliance: np.ndarray  # (k, 3, 3) inverse of J = I - D + eps D, or of sigma
    stiffness: np.ndarray  # (k, 3, 3) J^-1 D
    block: np.ndarray  # (N + 2 pairs, 6, 6)
    pivot: np.ndarray  # (N, 6) int64
    motion: np.ndarray  # (N, 6)


def new_island_work(graph: IslandGraph, body: np.ndarray) -> IslandWork:
    """Return work arrays for islands of one graph."""
    k, bodies, pairs = len(body), len(graph.order), len(graph.later)
    return IslandWork(
        *(np.zeros(3 * k) for _ in range(10)),
        scale=np.ones(k),
        graph=graph,
        body=body,
        rows=np.zeros((k, 2, 3, 6)),
        response=np.zeros((k, 2, 6, 3)),
        local=np.zeros((k, 6)),
        compliance=np.zeros((k, 3, 3)),
        stiffness=np.zeros((k, 3, 3)),
        block=np.zeros((bodies + 2 * pairs, 6, 6)),
        pivot=np.zeros((bodies, 6), dtype=np.int64),
        motion=np.zeros((bodies, 6)),
    )
