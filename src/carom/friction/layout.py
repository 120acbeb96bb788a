"""Codes of the solver of contacts, and its work arrays."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table

# What a contact may do.
CONE, SLIDING, STICKING, DISC = range(4)

# How a solve ended.
SOLVED, NOT_SOLVED, BAD_INPUT = 0, 1, 2

MESSAGES = {
    SOLVED: "The contact problem was solved to its tolerance.",
    NOT_SOLVED: (
        "The contact problem was not solved to its tolerance; `residual` is the remaining error. "
        "With large friction and redundant contacts the problem may have no solution."
    ),
    BAD_INPUT: "The inverse mass, the velocity or the friction is not finite, or friction is negative.",
}


#: a contact
CONTACT = [
    ("mu", "f8"),
    ("kind", "i8"),
    ("h1", "f8"),  # direction of slip where that is known; of a DISC, its radius
    ("h2", "f8"),
    ("scale", "f8"),  # impulse / scaled impulse
]

# Vectors of length 3K, in scaled variables.
C = 0  # velocity without impulses
P = 1  # impulses: the iterate
VELOCITY = 2  # W p + c
F = 3  # p - projection
STEP = 4
CHANGE = 5  # W step
RHS = 6  # of a linear system
CENTRE = 7  # of the proximal term
KEPT = 8  # the best p of one start
BEST = 9  # the best p of all
GIVEN = 10  # p at the start
VECTORS = 11


# Numbers of a search.
ITERATIONS = 0
ROWS = 1  # of the factors at hand, -1 where there are none
LIMIT = 3  # most steps of one call of Newton, 0: what is usual
BUDGET = 4  # most iterations of a search, about; 0: as many as its starting points take
NEAR = 2  # 1: of several solutions the one near the start is wanted, not that of least norm

# Place in `mismatch`: an |f|, and a residual as a part of c, at which a search may end; 0: at round-off.
ENOUGH = 1


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
    ("response", "f8", (2, 6, 3)),  # of both to an impulse, P G^T; without joints M^-1 G^T
    ("others", "i8"),  # its rows of `other`: from, to
    ("others_end", "i8"),
    ("local", "f8", 6),  # upper triangle of the diagonal block of W
    ("basis", "f8", 4),  # of that (`one_contact.basis_of`)
    ("compliance", "f8", (3, 3)),  # inverse of J
    ("stiffness", "f8", (3, 3)),  # J^-1 D
]

#: a body that an impulse moves by way of joints
OTHER = [("body", "i8"), ("corner", "i8", 2), ("response", "f8", (6, 3))]

ISLAND_BODY = [("motion", "f8", 6), ("pivot", "i8", 6)]


#: how the Delassus operator W is kept: whole; or by bodies, as G and P G^T, W itself never formed
DENSE, BY_BODIES = range(2)


class ContactWork(NamedTuple):
    """Work arrays of a contact problem of up to K contacts; what its kind does not need is empty."""

    kind: int  # DENSE or BY_BODIES
    contact: np.recarray  # (K,) CONTACT
    vector: np.ndarray  # (VECTORS, 3K)
    count: np.ndarray  # (5,) int64
    mismatch: np.ndarray  # (2,) |f| that Newton reached, and one that is ENOUGH
    # DENSE
    W: np.ndarray  # (3K, 3K) scaled: each diagonal block has trace 3
    matrix: np.ndarray  # (3K, 3K) of a linear system, and its factors
    pivot: np.ndarray  # (3K,) int64, rows exchanged
    active: np.ndarray  # (3K,) int64, rows of `matrix`
    # BY_BODIES
    link: np.recarray  # (K,) LINK
    other: np.recarray  # (R,) OTHER
    body: np.recarray  # (N,) ISLAND_BODY
    place: np.recarray  # (N,) PLACE
    later: np.ndarray  # (pairs,) the body of a pair that is eliminated later
    target: (
        np.ndarray
    )  # (updates, 3) pair s, pair t, block from which below[s] right[t] is subtracted
    block: np.ndarray  # (N + 2 pairs, 6, 6)


def new_contact_work(capacity: int) -> ContactWork:
    """Return work arrays for up to `capacity` contacts whose W is given whole."""
    contacts = max(capacity, 1)
    n = 3 * contacts
    return ContactWork(
        kind=DENSE,
        contact=table(CONTACT, contacts),
        vector=np.zeros((VECTORS, n)),
        count=np.zeros(5, dtype=np.int64),
        mismatch=np.zeros(2),
        W=np.zeros((n, n)),
        matrix=np.zeros((n, n)),
        pivot=np.zeros(n, dtype=np.int64),
        active=np.zeros(n, dtype=np.int64),
        link=table(LINK, 0),
        other=table(OTHER, 0),
        body=table(ISLAND_BODY, 0),
        place=table(PLACE, 0),
        later=np.zeros(0, dtype=np.int64),
        target=np.zeros((0, 3), dtype=np.int64),
        block=np.zeros((0, 6, 6)),
    )
