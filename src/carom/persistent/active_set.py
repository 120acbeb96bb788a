"""The active set: adding a point, removing it, and which of its points share their bodies."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.contact.closed_points import closed_within
from carom.contact.gap import slow
from carom.contact.groups import label_groups
from carom.contact.pair_point import (
    REACH,
    find_touches,
    own_point,
    smaller,
    touch_rate,
)
from carom.contact.place import place_any
from carom.contact.rim import same_point
from carom.impact.effective_restitution import TIRED


@kernel
def begin_point(hold, contact, c, feature, mode):
    """Write a point of contact c that is held from now on, as one of several and without a force."""
    hold.contact, hold.feature = c, feature
    hold.body, hold.other, hold.touches = contact.body, contact.other, contact.touches
    hold.mode, hold.next, hold.rest, hold.several = mode, mode, 0, 1
    hold.jams, hold.due, hold.lift, hold.grip = 0, 0, 1.0, 1.0
    hold.settles, hold.stop = 0, math.inf
    hold.turn_stop[0], hold.turn_stop[1] = math.inf, math.inf
    hold.heading[0], hold.heading[1] = 0.0, 0.0
    for k in range(3):
        hold.force[k], hold.torque[k] = 0.0, 0.0
        for j in range(3):
            hold.W[k, j] = 0.0


@kernel
def enlist(system, held, seat, mode, state, work):
    """Add a closed point to the active set; return its place."""
    i = held.count[0]
    held.count[0] = i + 1
    hold, contact = held.points[i], system.contacts[seat.contact]
    begin_point(hold, contact, seat.contact, seat.feature, mode)
    hold.several = 0
    for k in range(3):
        hold.point[k] = seat.point[k]
    set_anchor(system, hold, state, work)
    if contact.touches == 0:
        held.carries[seat.feature] = 1
    held.brinks[seat.contact].leaving = 0
    return i


@kernel
def set_anchor(system, hold, state, work):
    """Note where a point is now: it stays there while it sticks."""
    point, x = work.point[0], state[hold.body].x
    place_any(system, system.contacts[hold.contact], hold.feature, hold.point, state, point, work)
    for k in range(3):
        hold.anchor[k] = x[k] + point.arm_a[k]


@kernel
def strike_off(held, i):
    """Remove point i from the active set; the others keep their order."""
    if held.points[i].touches == 0:
        held.carries[held.points[i].feature] = 0
    held.brinks[held.points[i].contact].leaving = 1
    last = held.count[0] - 1
    for j in range(i, last):
        copy(held.points[j + 1], held.points[j])
    held.count[0] = last


@kernel
def let_go(held):
    """Remove all points that share bodies: they strike, and persist again, at the end of the next step."""
    for i in range(held.count[0] - 1, -1, -1):
        hold = held.points[i]
        if hold.several == 1:
            c = hold.contact
            strike_off(held, i)
            held.brinks[c].leaving, held.brinks[c].near, held.brinks[c].blows = 0, 0, TIRED


@kernel
def copy(a, b):
    """Copy a held point."""
    b.contact, b.feature, b.body, b.other, b.mode = a.contact, a.feature, a.body, a.other, a.mode
    b.next, b.several, b.rest, b.stop = a.next, a.several, a.rest, a.stop
    b.settles, b.jams, b.due, b.lift, b.grip = a.settles, a.jams, a.due, a.lift, a.grip
    b.touches = a.touches
    for k in range(3):
        b.point[k], b.anchor[k], b.force[k] = a.point[k], a.anchor[k], a.force[k]
        for j in range(3):
            b.W[k, j] = a.W[k, j]
        b.torque[k] = a.torque[k]
    b.turn_stop[0], b.turn_stop[1] = a.turn_stop[0], a.turn_stop[1]
    b.heading[0], b.heading[1], b.speed = a.heading[0], a.heading[1], a.speed


@kernel
def together(contact):
    """Return whether a point of a contact is always stepped as one of several."""
    own = contact.touches == 0 or (contact.touches == 1 and contact.other < 0)
    return not own or contact.turning[0] > 0.0 or contact.turning[1] > 0.0


@kernel
def regroup(system, held, work):
    """Label the groups that held points make, and note which points share their bodies with others."""
    label_groups(system, held, work)
    joined, n = 0, work.body.shape[0]  # the number N is of all that have joints
    for b in range(n):
        work.body[b].holds = 0
    for i in range(held.count[0]):
        group = work.body[held.points[i].body].group
        if group < n:
            work.body[group].holds += 1
        else:
            joined += 1
    for i in range(held.count[0]):
        hold = held.points[i]
        group = work.body[hold.body].group
        others = (work.body[group].holds if group < n else joined) - 1
        hold.several = 1 if others > 0 or together(system.contacts[hold.contact]) else 0


@kernel
def is_held(system, held, c, touch, state):
    """Return whether a point of contact c that was found is held."""
    contact = system.contacts[c]
    for i in range(held.count[0]):
        hold = held.points[i]
        if hold.contact == c and same_point(
            system, contact, touch, hold.feature, hold.point, state
        ):
            return True
    return False


@unit
def _refresh_pairs(system, controls, held, state, work) -> bool:
    """Let points whose features are no more give way to those that took their place.

    As faces slide on each other the corners of their overlap change; the set stays that of the closed
    points. Others are noted where they are now. Returns whether anything changed.
    """
    changed, i = False, 0
    while i < held.count[0]:
        hold = held.points[i]
        if hold.touches != 1 or hold.rest == 1:
            i += 1
            continue
        c, contact = hold.contact, system.contacts[hold.contact]
        count = find_touches(system, contact, state, REACH * smaller(contact), work)
        there = False
        for t in range(count):
            touch = work.touches[t]
            if same_point(system, contact, touch, hold.feature, hold.point, state):
                own_point(contact, touch, state, hold.point)
                there = True
        if there:
            i += 1
            continue
        mode = hold.mode
        strike_off(held, i)
        held.brinks[c].leaving = 0
        changed = True
        near, still = closed_within(controls, contact, state), 10.0 * slow(contact, state)
        for t in range(count):
            touch = work.touches[t]
            free = held.count[0] < held.points.shape[0]
            if touch.gap > near or is_held(system, held, c, touch, state):
                continue
            if free and (contact.other >= 0 or touch_rate(contact, touch, state) >= -still):
                enlist_touch(contact, c, touch, mode, state, held)
    return changed


@kernel
def enlist_touch(contact, c, touch, mode, state, held):
    """Add a point that was found to the active set, without an event."""
    hold = held.points[held.count[0]]
    held.count[0] += 1
    begin_point(hold, contact, c, touch.feature, mode)
    own_point(contact, touch, state, hold.point)


@inlined
def refresh_pairs(system, controls, held, state, work):
    """Let points whose features are no more give way to those that took their place."""
    if system.solids.shape[0] > 0:
        return _refresh_pairs(system, controls, held, state, work)
    return False
