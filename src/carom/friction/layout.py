"""Codes of the solver of contacts, and its work arrays."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table

# Kinds of contact.
CONE, SLIDING, STICKING, DISC = range(4)

# Results of a solve.
SOLVED, NOT_SOLVED, BAD_PROBLEM = 0, 1, 2

MESSAGES = {
    SOLVED: "The contact problem was solved to its tolerance.",
    NOT_SOLVED: (
        "The contact problem was not solved to its tolerance; `residual` is the remaining error. "
        "With large friction and redundant contacts the problem may have no solution."
    ),
    BAD_PROBLEM: "The inverse mass, the velocity or the friction is not finite, or friction is negative.",
}


#: a contact
CONTACT = [
    ("mu", "f8"),
    ("kind", "i8"),
    ("h1", "f8"),  # known direction of slip of SLIDING; radius of a DISC
    ("h2", "f8"),
    ("scale", "f8"),  # impulse / scaled impulse
]

# Vectors of length 3K, in scaled variables.
BIAS = 0  # velocity without impulses
ITERATE = 1  # impulses: the iterate
RESULTING = 2  # W p + c
F = 3  # p - projection
STEP = 4
CHANGE = 5  # W step
RHS = 6  # right-hand side of a linear system
CENTRE = 7  # centre of the proximal term
START_BEST = 8  # the best p of one start
BEST = 9  # the best p of all
GIVEN = 10  # p at the start
UNDAMPED_START = 11  # p before undamped steps of Newton's method
VECTORS = 12


# Places in `count`, the numbers of a search.
ITERATIONS = 0
FACTOR_ROWS = 1  # rows of the present factors, -1 if there are none
BUDGET = 2  # approximate greatest number of iterations of a search; 0: no limit

# Place in `mismatch` of a tolerance for |f|, and for the residual relative to c; 0: round-off.
ENOUGH = 1


#: a place in the order of elimination
PLACE = [
    ("body", "i8"),
    ("pair", "i8"),  # range of its pairs
    ("pairs_end", "i8"),
    ("update", "i8"),  # range of its rows of `target`
    ("updates_end", "i8"),
]

#: a contact and its bodies
LINK = [
    ("body", "i8", 2),
    ("corner", "i8", (2, 2)),
    ("rows", "f8", (2, 3, 6)),  # scaled G
    ("response", "f8", (2, 6, 3)),  # of both bodies to an impulse, P G^T; without joints M^-1 G^T
    ("others", "i8"),  # range of its rows of `other`
    ("others_end", "i8"),
    ("spans", "i8"),  # 1 if the contact has rows of these bodies too
    ("local", "f8", 6),  # upper triangle of the diagonal block of W
    ("basis", "f8", 4),  # eigenbasis of that block (`one_contact.basis_of`)
    ("compliance", "f8", (3, 3)),  # inverse of J
    ("stiffness", "f8", (3, 3)),  # J^-1 D
]

#: a body that an impulse moves through joints
OTHER = [("body", "i8"), ("corner", "i8", 2), ("rows", "f8", (3, 6)), ("response", "f8", (6, 3))]

#: a contact on the central path (`carom.friction.cone_pair`): of the normal, and of the disc of friction
PATH = [
    ("x", "f8"),  # normal velocity, positive
    ("y", "f8", 3),  # sigma and the slip times mu, inside the cone
    ("z", "f8", 3),  # normal impulse, and the tangential one over mu, inside the cone
    ("dx", "f8"),
    ("dy", "f8", 3),
    ("dz", "f8", 3),
    ("error", "f8", 3),  # velocities minus x and y
    ("c", "f8"),  # the scaling: c, s, beta, D, its axis d, and l = S z
    ("s", "f8"),
    ("beta", "f8"),
    ("D", "f8"),
    ("d", "f8", 2),
    ("l", "f8", 3),
    ("k", "f8"),  # effect of the velocities on the impulses: normal, along d, across
    ("kd", "f8"),
    ("kp", "f8"),
    ("hd", "f8"),  # parts that the proximal term leaves of these two
    ("hp", "f8"),
    ("turn", "f8"),  # effect of the normal impulse along d
    ("normal", "f8"),  # right-hand sides: normal, scaled, along d, across
    ("r", "f8", 3),
    ("along", "f8"),
    ("across", "f8"),
    ("sy", "f8", 3),  # the direction in scaled space
    ("sz", "f8", 3),
]

ISLAND_BODY = [
    ("motion", "f8", 6),
    ("pivot", "i8", 6),
    # motion at a point of the central path, and what it lacks of that of the impulses
    ("reached", "f8", 6),
    ("lack", "f8", 6),
]


#: the Delassus operator W is stored as a full matrix; or by bodies, as G and P G^T, without W itself
DENSE, BY_BODIES = range(2)


class ContactProblem(NamedTuple):
    """The problem w = W p + c of K contacts, with the friction of each; the first k of each array are used."""

    W: np.ndarray  # (3K, 3K) Delassus operator, symmetric; rows (n, t1, t2) of each contact
    c: np.ndarray  # (3K,) velocity without impulses
    mu: np.ndarray  # (K,) friction
    # (K,) int64: CONE, friction against w_t; SLIDING, p_t = -mu p_n heading; STICKING, w_t = 0; DISC
    kind: np.ndarray
    heading: np.ndarray  # (K, 2) direction of slip of SLIDING; of a DISC, |p_t| <= heading[i, 0]


class ContactWork(NamedTuple):
    """Work arrays of a contact problem of up to K contacts; arrays that its kind does not need are empty."""

    kind: int  # DENSE or BY_BODIES
    contact: np.recarray  # (K,) CONTACT
    vector: np.ndarray  # (VECTORS, 3K)
    count: np.ndarray  # (3,) int64
    mismatch: np.ndarray  # (2,) |f| that Newton reached, and the tolerance ENOUGH
    # DENSE
    W: np.ndarray  # (3K, 3K) scaled: each diagonal block has trace 3
    matrix: np.ndarray  # (3K, 3K) matrix of a linear system, then its factors
    pivot: np.ndarray  # (3K,) int64, rows exchanged
    active: np.ndarray  # (3K,) int64, rows of `matrix`
    # BY_BODIES
    link: np.recarray  # (K,) LINK
    path: np.recarray  # (K,) PATH
    other: np.recarray  # (R,) OTHER
    body: np.recarray  # (N,) ISLAND_BODY
    place: np.recarray  # (N,) PLACE
    later: np.ndarray  # (pairs,) the body of a pair that is eliminated second
    # (updates, 3) pair s, pair t, block from which below[s] right[t] is subtracted
    target: np.ndarray
    block: np.ndarray  # (N + 2 pairs, 6, 6)


def new_contact_work(capacity: int) -> ContactWork:
    """Return work arrays for up to `capacity` contacts with a full matrix W."""
    contacts = max(capacity, 1)
    n = 3 * contacts
    whole = partial(np.zeros, dtype=np.int64)
    return ContactWork(
        kind=DENSE, contact=table(CONTACT, contacts), vector=np.zeros((VECTORS, n)), count=whole(3),
        mismatch=np.zeros(2), W=np.zeros((n, n)), matrix=np.zeros((n, n)), pivot=whole(n),
        active=whole(n), link=table(LINK, 0), path=table(PATH, 0), other=table(OTHER, 0),
        body=table(ISLAND_BODY, 0), place=table(PLACE, 0), later=whole(0), target=whole((0, 3)),
        block=np.zeros((0, 6, 6)),
    )  # fmt: skip


def with_bodies(
    work: ContactWork, contacts: int, bodies: int, room: tuple[int, int]
) -> ContactWork:
    """Return work arrays with links of contacts, and with room for blocks of bodies: pairs and updates."""
    pairs, updates = room
    return work._replace(
        link=table(LINK, contacts), body=table(ISLAND_BODY, bodies), place=table(PLACE, bodies),
        later=np.zeros(pairs, dtype=np.int64), target=np.zeros((updates, 3), dtype=np.int64),
        block=np.zeros((bodies + 2 * pairs, 6, 6)),
    )  # fmt: skip
