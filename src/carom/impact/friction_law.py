"""The friction of a contact: a number, or a law of the slip with a bound of stick (mathematics page, §1.1)."""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom.dynamics.curve import value_at

STRIKES, PERSISTENT = range(2)  # in impacts, and in persistent contact


@inlined
def depends_on_slip(contact, held):
    """Return whether the friction of a contact is a law."""
    return contact.last_friction_piece[held] > contact.friction_piece[held]


@inlined
def friction_at(system, contact, held, slip):
    """Return mu of a contact that slips at a speed [m/s], and where it is zero, that which bounds stick."""
    if depends_on_slip(contact, held) and slip > 0.0:
        return in_slip(system.curves, contact, held, slip)
    return contact.friction_held if held == PERSISTENT else contact.friction


@kernel
def in_slip(pieces, contact, held, slip):
    """Return mu by the law of a contact at a speed of slip."""
    return value_at(pieces, law_of(contact, held), slip)


@kernel
def law_of(contact, held):
    """Return first piece, that after the last, and exponent of the law of a contact."""
    first, last = contact.friction_piece[held], contact.last_friction_piece[held]
    return first, last, contact.friction_exponent[held]
