"""Round-off of a gap and of speeds: what counts as zero at a contact."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.contact.thresholds import STILL_PART
from carom.geometry.rotation import norm
from carom.geometry.thresholds import LAST_DIGIT


@kernel
def round_off(contact, state):
    """Return the round-off of a gap [m], from the size of the coordinates that it is computed from."""
    x = state[contact.body].x
    return LAST_DIGIT * (abs(contact.offset) + abs(x[0]) + abs(x[1]) + abs(x[2]) + contact.extent)


@kernel
def speed_of(b, extent, state):
    """Return a bound of the speed of any point of a body."""
    return norm(state[b].v) + extent * norm(state[b].w)


@kernel
def slow(contact, state):
    """Return the speed [m/s] that counts as zero: the round-off of the speeds of the body, or of both.

    It is at least the round-off of the speed of a fall by the size of the body, because a body nearly at rest
    in a crowd has no larger speeds for comparison.
    """
    s = speed_of(contact.body, contact.extent, state)
    if contact.other >= 0:
        s += speed_of(contact.other, contact.other_extent, state)
    return STILL_PART * s + contact.still


@kernel
def located_within(controls, contact, state):
    """Return the gap within which an impact of points at known places is located [m]."""
    return max(controls.gap * contact.extent, round_off(contact, state))
