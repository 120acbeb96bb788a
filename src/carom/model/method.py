"""The method of the free phase for kernels: one type for all methods."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from carom.model.tableaus import CLOSING, KENNEDY_CARPENTER
from carom.options import Options

#: kinds: explicit Runge-Kutta; symplectic, in parts; implicit for stiff springs; the paper's three fields
RUNGE_KUTTA, RATTLE, IMPLICIT, THREE_FIELD = range(4)


class Method(NamedTuple):
    """Coefficients of a method; all kinds have an explicit and a stiff one, which move persistent contacts."""

    kind: int
    A: np.ndarray  # (S, S) strictly lower triangular
    b: np.ndarray  # (S,) weights
    # weights of its error estimates: (0, S) none; (1, S); (2, S) of orders 5 and 3; (4, S) with two more of 5
    E: np.ndarray
    parts: np.ndarray  # RATTLE: (P,) of h, sum 1
    # THREE_FIELD
    ode: int  # 1: second-order equations of the multipliers, 0: exact constraints
    beta: float  # natural frequency times the step
    zeta: float
    augment: float  # eps relative to the diagonal of A M^-1 A^T
    tolerance: float
    most: int  # iterations
    # a diagonally implicit method of six stages, the first explicit, the last at the end of the step
    stiff: np.ndarray = KENNEDY_CARPENTER.A  # (6, 6)
    stiff_E: np.ndarray = KENNEDY_CARPENTER.E  # (1, 6) weights of its error estimate
    closing: np.ndarray = CLOSING.A  # (2, 2) the same of one stage: implicit Euler
    # its difference from the trapezoidal rule, where its end does not determine it (`note_undetermined`)
    closing_E: np.ndarray = np.array([[0.0, 0.0, 0.0, 0.5]])


def explicit(A: np.ndarray, b: np.ndarray) -> Method:
    """Return an explicit Runge-Kutta method without an estimate of its error."""
    return Method(
        kind=RUNGE_KUTTA, A=A, b=b, E=np.zeros((0, len(b))), parts=np.zeros(0), ode=0, beta=0.0, zeta=0.0,
        augment=0.0, tolerance=0.0, most=0,
    )  # fmt: skip


class Definition(NamedTuple):
    """A method as it is registered in `carom.dynamics.methods`."""

    kind: int
    order: int  # of convergence
    coefficients: Callable[[Options], Method]
    with_error: Callable[[], Method] | None = None  # with E: for steps of varying length
    with_kinks: Callable[[], Method] | None = None  # with more rows of E: for forces with kinks
