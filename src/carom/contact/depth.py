"""Penetration of bodies into each other or a half-space, and of joints beyond their stops."""

from __future__ import annotations

import math

from carom._compiled.decorators import by_reference, kernel
from carom._compiled.units import unit
from carom.collision.faces import load_face
from carom.collision.implicit import field_at
from carom.collision.layout import Pair
from carom.contact.closed_points import apart, round_off_of_both
from carom.contact.gap import lowest
from carom.contact.pair_point import find_touches, smaller
from carom.contact.place_of_other import on_curved_ground
from carom.contact.stop import stop_gap
from carom.geometry.vectors import dot, minus, plus
from carom.model.arrays import KIND_PAIR, KIND_STOP

FACE_PARTS = 8  # of the way from the middle of a face to a corner, at which its depth is looked at


@kernel
def watch_depth(system, state, t, work, watch):
    """Store the largest penetration so far, and its time."""
    depth, number = deepest(system, state, work)
    if depth > watch.depth:
        watch.depth, watch.deep_at, watch.deep_contact = depth, t, number
    for c in range(system.contacts.shape[0]):
        contact = system.contacts[c]
        if contact.kind == KIND_PAIR and on_curved_ground(system, contact):
            depth = depth_of_face(system, contact, state, work)
            if depth > watch.depth:
                watch.depth, watch.deep_at, watch.deep_contact = depth, t, contact.number


@kernel
def deepest(system, state, work):
    """Return the largest penetration beyond round-off, relative to the (smaller) body, and its contact."""
    most, number = 0.0, -1
    for c in range(system.contacts.shape[0]):
        contact = system.contacts[c]
        if contact.kind != KIND_STOP and apart(system, contact, state, 0.0):
            continue
        depth = -least_gap(system, contact, state, work) - 4.0 * round_off_of_both(contact, state)
        depth /= smaller(contact)
        if depth > most:
            most, number = depth, contact.number
    return most, number


@kernel
def least_gap(system, contact, state, work):
    """Return the least gap of a contact [m], negative inside."""
    if contact.kind == KIND_STOP:
        return stop_gap(system, contact, state, work)[0]
    if contact.kind == KIND_PAIR:
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


@unit
def depth_of_face(system, contact, state, work) -> float:
    """Return how far curved ground bulges into the face turned to it, relative to the body; 0 outside.

    Faces touch it at their vertices and edges only, so that nothing else sees this.
    """
    if apart(system, contact, state, 0.0) or find_touches(system, contact, state, 0.0, work) == 0:
        return 0.0
    a, b = system.solids[contact.solid], system.solids[contact.other_solid]
    hulls, s, n = system.hulls, work.pair.state[0], work.touches[0].normal
    w, corners = s.world, s.corner[0]
    x = w[0, 0] * n[0] + w[1, 0] * n[1] + w[2, 0] * n[2]
    y = w[0, 1] * n[0] + w[1, 1] * n[1] + w[2, 1] * n[2]
    z = w[0, 2] * n[0] + w[1, 2] * n[1] + w[2, 2] * n[2]
    load_face(by_reference(Pair(a, b, hulls, s, work.pair.found)), 0, -x, -y, -z)
    count, middle, most = s.count[0], (0.0, 0.0, 0.0), 0.0
    if count < 3:
        return 0.0
    for k in range(count):
        middle = plus(middle, 1.0 / count, (corners[k, 0], corners[k, 1], corners[k, 2]))
    for k in range(count):
        to_corner = minus((corners[k, 0], corners[k, 1], corners[k, 2]), middle)
        for j in range(FACE_PARTS):
            p = plus(middle, j / FACE_PARTS, to_corner)
            value, g, _ = field_at(hulls.surfaces[b.surface], hulls, p)
            most = max(most, a.radius - value / math.sqrt(dot(g, g)))
    return most / smaller(contact)
