"""Codes and work arrays of the solver of contacts."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

# What a contact may do.
CONE, SLIDING, STICKING = 0, 1, 2

# How a solve ended.
SOLVED, NOT_SOLVED, NOT_FINITE = 0, 1, 2

MESSAGES = {
    SOLVED: "The contact problem was solved to its tolerance.",
    NOT_SOLVED: (
        "The contact problem was not solved to its tolerance: the residual tells how far it is off. "
        "Large friction with redundant contacts may have no solution at all."
    ),
    NOT_FINITE: "The inverse mass, the velocity or the friction is not finite.",
}


class ConeWork(NamedTuple):
    """Work arrays of `carom.coulomb.solve.solve_cones` for up to K contacts, in scaled variables."""

    W: np.ndarray  # (3K, 3K) scaled inverse mass, trace 3 in each diagonal block
    c: np.ndarray  # (3K,)
    p: np.ndarray  # (3K,) iterate
    best: np.ndarray  # (3K,) the best iterate so far
    kept: np.ndarray  # (3K,) the best of one try
    centre: np.ndarray  # (3K,) of the proximal term
    w: np.ndarray  # (3K,) W p + c
    f: np.ndarray  # (3K,) p - projection
    step: np.ndarray  # (3K,)
    change: np.ndarray  # (3K,) W step
    rhs: np.ndarray  # (3K,) of a linear system
    jacobian: np.ndarray  # (3K, 3K)
    scale: np.ndarray  # (K,) impulse of a contact = scale * scaled impulse
    active: np.ndarray  # (3K,) rows in the reduced system
    pivot: np.ndarray  # (3K,)


def new_cone_work(capacity: int) -> ConeWork:
    """Return work arrays for up to `capacity` contacts."""
    n = 3 * max(capacity, 1)
    vectors = [np.zeros(n) for _ in range(10)]
    return ConeWork(
        np.zeros((n, n)),
        *vectors,
        np.zeros((n, n)),
        np.ones(max(capacity, 1)),
        np.zeros(n, dtype=np.int64),
        np.zeros(n, dtype=np.int64),
    )
