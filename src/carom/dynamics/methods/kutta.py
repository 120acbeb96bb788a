"""The classical method of order 4 (Kutta 1901)."""

from __future__ import annotations

import numpy as np

from carom.model.method import RUNGE_KUTTA, Definition, Method, explicit


def rk4(options=None) -> Method:
    """Return the coefficients."""
    A = np.zeros((4, 4))
    A[1, 0] = A[2, 1] = 0.5
    A[3, 2] = 1.0
    return explicit(A, np.array([1.0, 2.0, 2.0, 1.0]) / 6.0)


METHODS = {"rk4": Definition(RUNGE_KUTTA, 4, rk4)}
