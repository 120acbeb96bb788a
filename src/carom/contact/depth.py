"""Penetration of bodies into each other or a half-space, and of joints beyond their stops."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.closed_points import apart, round_off_of_both
from carom.contact.gap import lowest
from carom.contact.pair_point import find_touches, smaller
from carom.contact.stop import stop_gap
from carom.model.arrays import STOP


@kernel
def watch_depth(system, state, t, work, watch):
    """Store the largest penetration so far, and its time."""
    depth, number = deepest(system, state, work)
    if depth > watch.depth:
        watch.depth, watch.deep_at, watch.deep_contact = depth, t, number


@kernel
def deepest(system, state, work):
    """Return the largest penetration beyond round-off, relative to the (smaller) body, and its contact."""
    most, number = 0.0, -1
    for c in range(system.contacts.shape[0]):
        contact = system.contacts[c]
        if contact.touches != STOP and apart(system, contact, state, 0.0):
            continue
        depth = -least_gap(system, contact, state, work) - 4.0 * round_off_of_both(contact, state)
        depth /= smaller(contact)
        if depth > most:
            most, number = depth, contact.number
    return most, number


@kernel
def least_gap(system, contact, state, work):
    """Return the least gap of a contact [m], negative inside."""
    if contact.touches == STOP:
        return stop_gap(system, contact, state, work)[0]
    if contact.touches == 1:
        return least_of_touches(system, contact, state, work)
    return lowest(contact, system.vertices, state)[0]


@unit
def least_of_touches(system, contact, state, work) -> float:
    """Return the least gap of the points of two solids; -inf if a function of a surface has no value."""
    least = 0.0
    for i in range(find_touches(system, contact, state, 0.0, work)):
        gap = work.touches[i].gap
        least = min(least, gap if gap == gap else -math.inf)
    return least
