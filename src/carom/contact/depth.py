"""Penetration of bodies into each other or a half-space, and of joints beyond their stops."""

from __future__ import annotations

from carom._compiled.decorators import entry, kernel
from carom.contact.kinds.partner import round_off_of_both, smaller
from carom.contact.operations import apart, bulge, least_gap


@kernel
def watch_depth(system, state, t, work, watch):
    """Store the largest penetration so far, and its time."""
    depth, number = deepest(system, state, work)
    if depth > watch.depth:
        watch.depth, watch.deep_at, watch.deep_contact = depth, t, number
    for c in range(system.contacts.shape[0]):
        depth = bulge(system, system.contacts[c], state, work)
        if depth > watch.depth:
            watch.depth, watch.deep_at = depth, t
            watch.deep_contact = system.contacts[c].number


@kernel
def deepest(system, state, work):
    """Return the largest penetration beyond round-off, relative to the (smaller) body, and its contact."""
    most, number = 0.0, -1
    for c in range(system.contacts.shape[0]):
        contact = system.contacts[c]
        if apart(system, contact, state, 0.0):
            continue
        depth = -least_gap(system, contact, state, work) - 4.0 * round_off_of_both(contact, state)
        depth /= smaller(contact)
        if depth > most:
            most, number = depth, contact.number
    return most, number


@entry
def write_least_gaps(system, state, first, work, out):
    """Write the least gaps of the contacts from `first` on, (C - first,)."""
    for c in range(first, system.contacts.shape[0]):
        out[c - first] = least_gap(system, system.contacts[c], state, work)
