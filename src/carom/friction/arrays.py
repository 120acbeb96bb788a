"""An island of bodies and contacts: what is given, its graph, and the work arrays of its solve.

A block (6, 6) couples two bodies. Diagonal blocks come first, one a body; then, for each pair of bodies that
the elimination couples, the block right of the diagonal, and after all of those the ones below it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.friction.layout import CONTACT, VECTORS


class Island(NamedTuple):
    """N bodies and k contacts between them: w = G v, v = c + M^-1 G^T p body by body."""

    body: np.ndarray  # (k, 2) int64, the two bodies of a contact; -1 is the ground
    rows: np.ndarray  # (k, 2, 3, 6) G of each contact and body; (n, t1, t2)
    inverse_mass: np.ndarray  # (N, 6, 6) symmetric
    c: np.ndarray  # (3k,) velocity of the contacts without impulses


class IslandGraph(NamedTuple):
    """Which blocks there are and in which order bodies are eliminated; made by `carom.stepping.crowd.graph`."""

    place: np.recarray  # (N,) PLACE
    later: np.ndarray  # (pairs,) the body of a pair that is eliminated later
    target: (
        np.ndarray
    )  # (updates, 3) pair s, pair t, block from which below[s] right[t] is subtracted
    corner: np.ndarray  # (k, 2, 2) block of each contact for its bodies, -1 for the ground


#: a place in the order of elimination
PLACE = [
    ("body", "i8"),
    ("pair", "i8"),  # its pairs: from, to
    ("pairs_end", "i8"),
    ("update", "i8"),  # its rows of `target`: from, to
    ("updates_end", "i8"),
]

#: a contact and its bodies
LINK = [
    ("body", "i8", 2),
    ("corner", "i8", (2, 2)),
    ("rows", "f8", (2, 3, 6)),  # scaled G
    ("response", "f8", (2, 6, 3)),  # M^-1 G^T
    ("local", "f8", 6),  # upper triangle of the diagonal block of W
    ("compliance", "f8", (3, 3)),  # inverse of J
    ("stiffness", "f8", (3, 3)),  # J^-1 D
]

ISLAND_BODY = [("motion", "f8", 6), ("pivot", "i8", 6)]


class IslandWork(NamedTuple):
    """Work arrays of a solve through bodies."""

    contact: np.recarray  # (k,) CONTACT
    link: np.recarray  # (k,) LINK
    vector: np.ndarray  # (VECTORS, 3k)
    count: np.ndarray  # (5,) int64
    mismatch: np.ndarray  # (2,) |f| that Newton reached, and one that is ENOUGH
    body: np.recarray  # (N,) ISLAND_BODY
    place: np.recarray  # (N,) PLACE
    later: np.ndarray
    target: np.ndarray
    block: np.ndarray  # (N + 2 pairs, 6, 6)
    sums: np.ndarray  # (2, N, 6) for the residual


def new_island_work(graph: IslandGraph, body: np.ndarray) -> IslandWork:
    """Return work arrays for the island of contacts between `body` (k, 2) with that graph."""
    k, bodies, pairs = len(body), len(graph.place), len(graph.later)
    link = table(LINK, k)
    link.body, link.corner = body, graph.corner
    return IslandWork(
        table(CONTACT, k),
        link,
        np.zeros((VECTORS, 3 * k)),
        np.zeros(5, dtype=np.int64),
        np.zeros(2),
        table(ISLAND_BODY, bodies),
        graph.place,
        graph.later,
        graph.target,
        np.zeros((bodies + 2 * pairs, 6, 6)),
        np.zeros((2, bodies, 6)),
    )
