"""The contact point of any contact in a state: of a vertex, of two bodies, or of a stop."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.contact.pair_point import drift, touch_of_active, write_touch
from carom.contact.stop import place_stop, stop_drift
from carom.kinematics.contact_point import place
from carom.model.arrays import KIND_STOP, KIND_VERTICES


@kernel
def place_any(system, known, state, point, work):
    """Write the contact point in a state of an active or a listed one, or the point that replaces it."""
    contact, p = system.contacts[known.contact], known.point
    if contact.kind == KIND_VERTICES:
        place(contact, p, state, point)
    elif contact.kind == KIND_STOP:
        place_stop(system, contact, state, point)
    else:
        i = touch_of_active(system, contact, known.feature, p, state, work)
        write_touch(contact, work.touches[i], state, point)


@kernel
def drift_of(system, contact, feature, point, state, work):
    """Return (d/dt G) v, contact axes, of two touching bodies or of a stop.

    The point must have been written for this state.
    """
    if contact.kind == KIND_STOP:
        return stop_drift(system, contact, state, work)
    return drift(system, contact, feature, point, state)
