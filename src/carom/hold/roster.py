"""The list of held points: taking a point in, striking it off, and which of them share their bodies."""

from __future__ import annotations

import math

from carom.jit import kernel
from carom.motion.contact_point import place


@kernel
def enlist(system, held, seat, mode, state, work):
    """Add a closed point to the list; return its place."""
    i = held.count[0]
    held.count[0] = i + 1
    hold, contact = held.points[i], system.contacts[seat.contact]
    hold.contact, hold.feature, hold.body = seat.contact, seat.feature, contact.body
    hold.mode, hold.next, hold.rest, hold.several = mode, mode, 0, 0
    hold.settles, hold.stop = 0, math.inf
    for k in range(3):
        hold.point[k] = seat.point[k]
        hold.force[k] = 0.0
        for j in range(3):
            hold.W[k, j] = 0.0
    hold.heading[0], hold.heading[1] = 0.0, 0.0
    set_anchor(system, hold, state, work)
    held.carries[seat.feature] = 1
    held.brinks[seat.contact].leaving = 0
    return i


@kernel
def set_anchor(system, hold, state, work):
    """Note where a point is now: it stays there while it sticks."""
    point, x = work.point[0], state[hold.body].x
    place(system.contacts[hold.contact], hold.point, state, point)
    for k in range(3):
        hold.anchor[k] = x[k] + point.arm_a[k]


@kernel
def strike_off(held, i):
    """Take point i off the list, the others keep their order."""
    held.carries[held.points[i].feature] = 0
    held.brinks[held.points[i].contact].leaving = 1
    last = held.count[0] - 1
    for j in range(i, last):
        copy(held.points[j + 1], held.points[j])
    held.count[0] = last


@kernel
def copy(a, b):
    """Copy a held point."""
    b.contact, b.feature, b.body, b.mode = a.contact, a.feature, a.body, a.mode
    b.next, b.several, b.rest, b.stop = a.next, a.several, a.rest, a.stop
    b.settles = a.settles
    for k in range(3):
        b.point[k], b.anchor[k], b.force[k] = a.point[k], a.anchor[k], a.force[k]
        for j in range(3):
            b.W[k, j] = a.W[k, j]
    b.heading[0], b.heading[1] = a.heading[0], a.heading[1]


@kernel
def regroup(system, held):
    """Note which held points share their bodies with others."""
    for i in range(held.count[0]):
        hold = held.points[i]
        group, several = system.contacts[hold.contact].group, 0
        for j in range(held.count[0]):
            if j != i and system.contacts[held.points[j].contact].group == group:
                several = 1
        hold.several = several
