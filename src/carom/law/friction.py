"""Coulomb's friction: a number, or a law of the slip with a bound of stick (mathematics page, §1.1)."""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom.law.piecewise import depends_on_speed, margin_before_kink, value_at
from carom.model.laws import SLIP


@inlined
def depends_on_slip(laws, number):
    """Return whether the friction of a law depends on the slip."""
    return depends_on_speed(laws, number, SLIP)


@inlined
def bound_of_stick(laws, number):
    """Return mu, or what bounds stick where friction depends on the slip."""
    return laws.table[number].friction


@inlined
def friction_at(laws, number, slip):
    """Return mu at a speed of slip [m/s], and where it is zero, what bounds stick."""
    if depends_on_slip(laws, number) and slip > 0.0:
        return in_slip(laws, number, slip)
    return bound_of_stick(laws, number)


@kernel
def in_slip(laws, number, slip):
    """Return mu at a speed of slip by a law that depends on it."""
    return value_at(laws, number, SLIP, slip)


@kernel
def margin_of_slip(laws, number, before, after, here):
    """Return how far the slip `here` is from the next kink of a law, between two speeds; 1 if there is none."""
    return margin_before_kink(laws, number, SLIP, before, after, here)
