"""The method for stiff springs (`carom.dynamics.implicit`), with coefficients of the classical method."""

from __future__ import annotations

from carom.dynamics.methods.kutta import rk4
from carom.model.method import IMPLICIT, Definition, Method


def implicit(options=None) -> Method:
    """Return the coefficients."""
    return rk4()._replace(kind=IMPLICIT)


METHODS = {"implicit": Definition(IMPLICIT, 2, implicit)}
