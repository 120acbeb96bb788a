"""The method of the free phase for kernels: one type for all methods."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from carom.options import Options

#: kinds: explicit Runge-Kutta; symplectic, in parts; implicit for stiff springs; the paper's three fields
RUNGE_KUTTA, RATTLE, IMPLICIT, THREE_FIELD = range(4)


class Method(NamedTuple):
    """Coefficients of a method; all kinds have an explicit method, which also moves persistent contacts."""

    kind: int
    A: np.ndarray  # (S, S) strictly lower triangular
    b: np.ndarray  # (S,) weights
    E: np.ndarray  # weights of its error estimates: (0, S) none; (1, S); (2, S) of orders 5 and 3
    parts: np.ndarray  # RATTLE: (P,) of h, sum 1
    # THREE_FIELD
    ode: int  # 1: second-order equations of the multipliers, 0: exact constraints
    beta: float  # natural frequency times the step
    zeta: float
    augment: float  # eps relative to the diagonal of A M^-1 A^T
    tolerance: float
    most: int  # iterations


def explicit(A: np.ndarray, b: np.ndarray) -> Method:
    """Return an explicit Runge-Kutta method without an estimate of its error."""
    return Method(RUNGE_KUTTA, A, b, np.zeros((0, len(b))), np.zeros(0), 0, 0.0, 0.0, 0.0, 0.0, 0)


class Definition(NamedTuple):
    """A method as it is registered in `carom.dynamics.methods`."""

    kind: int
    order: int  # of convergence
    coefficients: Callable[[Options], Method]
    with_error: Callable[[], Method] | None = None  # with E: for steps of varying length
