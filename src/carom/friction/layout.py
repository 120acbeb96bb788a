"""Codes of the solver of contacts, and its work arrays for an inverse mass stored whole."""

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
        "The contact problem was not solved to its tolerance; the residual says how far it is off. "
        "With large friction and redundant contacts it may have no solution."
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


class ConeWork(NamedTuple):
    """Work arrays of `carom.friction.solve.solve_cones` for up to K contacts."""

    contact: np.recarray  # (K,) CONTACT
    vector: np.ndarray  # (VECTORS, 3K)
    count: np.ndarray  # (5,) int64
    mismatch: np.ndarray  # (2,) |f| that Newton reached, and one that is ENOUGH
    W: np.ndarray  # (3K, 3K) scaled inverse mass: each diagonal block has trace 3
    matrix: np.ndarray  # (3K, 3K) of a linear system, and its factors
    pivot: np.ndarray  # (3K,) int64, rows exchanged
    active: np.ndarray  # (3K,) int64, rows of `matrix`


def new_cone_work(capacity: int) -> ConeWork:
    """Return work arrays for up to `capacity` contacts."""
    contacts = max(capacity, 1)
    n = 3 * contacts
    return ConeWork(
        table(CONTACT, contacts),
        np.zeros((VECTORS, n)),
        np.zeros(5, dtype=np.int64),
        np.zeros(2),
        np.zeros((n, n)),
        np.zeros((n, n)),
        np.zeros(n, dtype=np.int64),
        np.zeros(n, dtype=np.int64),
    )
