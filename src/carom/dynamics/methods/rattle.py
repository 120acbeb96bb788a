"""RATTLE (`carom.dynamics.rattle`) in one part, and its symmetric compositions of order 4 and 6."""

from __future__ import annotations

import numpy as np

from carom.dynamics.methods.dormand_prince import rk8
from carom.dynamics.methods.kutta import rk4
from carom.model.method import RATTLE, Definition, Method


def rattle(options=None) -> Method:
    """Return a step in one part; persistent contacts use the explicit method of order 4."""
    return rk4()._replace(kind=RATTLE, parts=np.ones(1))


def rattle4(options=None) -> Method:
    """Return a step in the 5 parts of order 4 of Suzuki (1990)."""
    g = 1.0 / (4.0 - 4.0 ** (1.0 / 3.0))
    return rk4()._replace(kind=RATTLE, parts=np.array([g, g, 1.0 - 4.0 * g, g, g]))


def rattle6(options=None) -> Method:
    """Return a step in the 9 parts of order 6 of Kahan and Li (1997)."""
    half = [
        0.39216144400731413927925056, 0.33259913678935943859974864, -0.70624617255763935980996482,
        0.08221359629355080023149045,
    ]  # fmt: skip
    parts = np.array([*half, 1.0 - 2.0 * sum(half), *half[::-1]])
    return rk8()._replace(kind=RATTLE, parts=parts)


METHODS = {
    "rattle": Definition(RATTLE, 2, rattle),
    "rattle4": Definition(RATTLE, 4, rattle4),
    "rattle6": Definition(RATTLE, 6, rattle6),
}
