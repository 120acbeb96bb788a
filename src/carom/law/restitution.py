"""The coefficient of restitution: a number, or a law of the speed of approach."""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom.law.piecewise import depends_on_speed, value_at
from carom.model.laws import APPROACH


@inlined
def depends_on_approach(laws, number):
    """Return whether the restitution of a law depends on the speed of approach."""
    return depends_on_speed(laws, number, APPROACH)


@inlined
def restitution_at(laws, number, approach):
    """Return e at a speed of approach [m/s]."""
    if depends_on_approach(laws, number):
        return by_approach(laws, number, approach)
    return laws.table[number].restitution


@kernel
def by_approach(laws, number, approach):
    """Return e by a law that depends on the speed of approach."""
    return min(1.0, max(0.0, value_at(laws, number, APPROACH, approach)))
