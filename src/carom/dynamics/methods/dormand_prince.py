"""Order 5 with 6 stages (Dormand and Prince 1980), order 8 with 12 (DOP853)."""

from __future__ import annotations

from functools import cache

import numpy as np

from carom.model.method import RUNGE_KUTTA, Definition, Method, explicit
from carom.model.tableaus import DORMAND_PRINCE, HAIRER, OF_KINKS


def rk5(options=None) -> Method:
    """Return the coefficients of order 5."""
    return explicit(DORMAND_PRINCE.A[:6, :6].copy(), DORMAND_PRINCE.b[:6].copy())


def rk8(options=None) -> Method:
    """Return the coefficients of order 8."""
    return explicit(HAIRER.A, HAIRER.b)


@cache
def rk5_with_error() -> Method:
    """Return those of order 5 with a seventh stage at the end, without weight, and the weights of the error."""
    return explicit(DORMAND_PRINCE.A, DORMAND_PRINCE.b)._replace(E=DORMAND_PRINCE.E)


@cache
def rk8_with_error() -> Method:
    """Return those of order 8 with the weights of both errors, of order 5 and 3."""
    return rk8()._replace(E=HAIRER.E)


@cache
def rk8_with_kinks() -> Method:
    """Return the same with two more weights of errors of order 5, for forces that have kinks."""
    return rk8()._replace(E=np.vstack([HAIRER.E, OF_KINKS]))


METHODS = {
    "rk5": Definition(RUNGE_KUTTA, 5, rk5, rk5_with_error),
    "rk8": Definition(RUNGE_KUTTA, 8, rk8, rk8_with_error, rk8_with_kinks),
}
