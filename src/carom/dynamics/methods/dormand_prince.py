"""Order 5 with 6 stages (Dormand and Prince 1980), order 8 with 12 (Hairer, Norsett and Wanner 1993, DOP853).

The coefficients are those of SciPy, which is loaded when they are needed.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from carom.model.method import RUNGE_KUTTA, Definition, Method, explicit


def rk5(options=None) -> Method:
    """Return the coefficients of order 5."""
    from scipy.integrate import RK45

    return _tableau(RK45)


def rk8(options=None) -> Method:
    """Return the coefficients of order 8."""
    from scipy.integrate import DOP853

    return _tableau(DOP853)


def _tableau(chosen) -> Method:
    stages = len(chosen.B)
    A = np.zeros((stages, stages))
    A[:, : chosen.A.shape[1]] = chosen.A[:stages]
    return explicit(A, np.array(chosen.B))


@cache
def rk5_with_error() -> Method:
    """Return those of order 5 with a seventh stage at the end, without weight, and the weights of the error."""
    from scipy.integrate import RK45

    method, A = rk5(), np.zeros((7, 7))
    A[:6, :6], A[6, :6] = method.A, method.b
    return method._replace(A=A, b=np.append(method.b, 0.0), E=np.array([RK45.E]))


@cache
def rk8_with_error() -> Method:
    """Return those of order 8 with the weights of both errors, of order 5 and 3."""
    from scipy.integrate import DOP853

    return rk8()._replace(E=np.array([DOP853.E5[:-1], DOP853.E3[:-1]]))


@cache
def rk8_with_kinks() -> Method:
    """Return the same with two more weights of errors of order 5, for forces that have kinks.

    They are orthogonal to that of Hairer, Norsett and Wanner, and as long. All others of order 5 in the stages
    1 and 6 to 12 are sums of these three, since the conditions of order 5 have rank 5 in these eight stages.
    The error of a kink in a step is 0 at some places for each of them, at none for all.
    """
    others = np.zeros((2, 12))
    others[:, [0, *range(5, 12)]] = [
        [
            0.10811085774398249, 1.321260679178407, -1.4362321178001727, 0.43247567966819084,
            -0.5906359511484547, -0.21553430200705073, 0.5669693132364955, -0.18641415887139787,
        ],
        [
            0.008524524078584065, 0.0, -0.35075634949146817, 0.5124376382320663, 1.4832628604629525,
            -1.4485372944881887, -0.2663307153563819, 0.06139933656243606,
        ],
    ]  # fmt: skip
    method = rk8_with_error()
    return method._replace(E=np.vstack([method.E, others]))


METHODS = {
    "rk5": Definition(RUNGE_KUTTA, 5, rk5, rk5_with_error),
    "rk8": Definition(RUNGE_KUTTA, 8, rk8, rk8_with_error, rk8_with_kinks),
}
