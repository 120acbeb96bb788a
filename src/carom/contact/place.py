"""The contact point of any contact in a state: of a vertex, of two bodies, or of a stop."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.contact.pair_point import drift, place_pair
from carom.contact.stop import place_stop, stop_drift
from carom.kinematics.contact_point import place
from carom.model.arrays import STOP


@kernel
def place_any(system, contact, feature, p, state, point, work):
    """Write the contact point of a feature: the core point p, a stop, or a point found by `carom.collision`."""
    if contact.touches == 0:
        place(contact, p, state, point)
    elif contact.touches == STOP:
        place_stop(system, contact, state, point)
    else:
        place_pair(system, contact, feature, p, state, point, work)


@kernel
def drift_of(system, contact, feature, point, state, work):
    """Return (d/dt G) v, contact axes, of two touching bodies or of a stop.

    The point must have been written for this state.
    """
    if contact.touches == STOP:
        return stop_drift(system, contact, state, work), 0.0, 0.0
    return drift(system, contact, feature, point, state)
