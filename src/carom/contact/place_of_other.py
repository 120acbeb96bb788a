"""The partner of a body in a contact: another body, a static body, or a half-space."""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def on_half_space(contact):
    """Return whether a body touches a half-space."""
    return contact.other < 0 and contact.static == 0


@kernel
def centre_of_other(contact, state):
    """Return position and velocity of the mass centre of the other body, moving or static."""
    if contact.static == 1:
        c = contact.centre
        return c[0], c[1], c[2], 0.0, 0.0, 0.0
    x, v = state[contact.other].x, state[contact.other].v
    return x[0], x[1], x[2], v[0], v[1], v[2]
