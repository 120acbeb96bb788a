"""An island of bodies and contacts: what is given, its graph, and the work arrays of its solve.

A block (6, 6) couples two bodies. Diagonal blocks come first, one a body; then, for each pair of bodies that
the elimination couples, the block right of the diagonal, and after all of those the ones below it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.friction.layout import (
    BY_BODIES,
    CONTACT,
    ISLAND_BODY,
    LINK,
    PATH,
    VECTORS,
    ContactWork,
    new_contact_work,
)


class Island(NamedTuple):
    """N bodies and k contacts between them: w = G v, v = c + M^-1 G^T p body by body."""

    body: np.ndarray  # (k, 2) int64, the two bodies of a contact; -1 is the ground
    rows: np.ndarray  # (k, 2, 3, 6) G of each contact and body; (n, t1, t2)
    inverse_mass: np.ndarray  # (N, 6, 6) symmetric
    c: np.ndarray  # (3k,) velocity of the contacts without impulses
    motion: np.ndarray  # (2, N, 6) workspace


class IslandGraph(NamedTuple):
    """Which blocks there are and in which order bodies are eliminated; made by `island_graph`."""

    place: np.recarray  # (N,) PLACE
    later: np.ndarray  # (pairs,) the body of a pair that is eliminated later
    target: (
        np.ndarray
    )  # (updates, 3) pair s, pair t, block from which below[s] right[t] is subtracted
    corner: np.ndarray  # (k, 2, 2) block of each contact for its bodies, -1 for the ground


def new_island_work(graph: IslandGraph, body: np.ndarray) -> ContactWork:
    """Return work arrays for the island of contacts between `body` (k, 2) with that graph."""
    k, bodies, pairs = len(body), len(graph.place), len(graph.later)
    link = table(LINK, k)
    link.body, link.corner = body, graph.corner
    return new_contact_work(0)._replace(
        kind=BY_BODIES,
        contact=table(CONTACT, k),
        vector=np.zeros((VECTORS, 3 * k)),
        link=link,
        path=table(PATH, k),
        body=table(ISLAND_BODY, bodies),
        place=graph.place,
        later=graph.later,
        target=graph.target,
        block=np.zeros((bodies + 2 * pairs, 6, 6)),
    )
