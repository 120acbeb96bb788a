"""Codes of the solver of contacts, and its work arrays for a dense inverse mass."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

# What a contact may do.
CONE, SLIDING, STICKING = 0, 1, 2

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


class ConeWork(NamedTuple):
    """Work arrays of `carom.coulomb.solve.solve_cones` for up to K contacts, in scaled variables."""

    c: np.ndarray  # (3K,) velocity without impulses
    p: np.ndarray  # (3K,) impulses: the iterate
    w: np.ndarray  # (3K,) W p + c
    f: np.ndarray  # (3K,) p - projection
    step: np.ndarray  # (3K,)
    change: np.ndarray  # (3K,) W step
    rhs: np.ndarray  # (3K,) of a linear system
    centre: np.ndarray  # (3K,) of the proximal term
    kept: np.ndarray  # (3K,) best p of one start
    best: np.ndarray  # (3K,) best p of all
    scale: np.ndarray  # (K,) impulse of a contact / scaled impulse
    W: np.ndarray  # (3K, 3K) scaled inverse mass: each diagonal block has trace 3
    matrix: np.ndarray  # (3K, 3K) of a linear system, and its factors
    pivot: np.ndarray  # (3K,) rows exchanged
    active: np.ndarray  # (3K,) rows of `matrix`


def new_cone_work(capacity: int) -> ConeWork:
    """Return work arrays for up to `capacity` contacts."""
    n = 3 * max(capacity, 1)
    return ConeWork(
        *(np.zeros(n) for _ in range(10)),
        scale=np.ones(n // 3),
        W=np.zeros((n, n)),
        matrix=np.zeros((n, n)),
        pivot=np.zeros(n, dtype=np.int64),
        active=np.zeros(n, dtype=np.int64),
    )
