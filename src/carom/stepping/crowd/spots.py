"""The points of a crowd that may touch within a step, and their positions in a state."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.closed_points import (
    add_stop,
    add_touches,
    add_vertices,
    apart,
    find_closed,
    write_turning,
)
from carom.contact.depth import least_gap
from carom.contact.pair_point import list_touches, smaller, which_touch, write_touch
from carom.contact.place_of_other import on_half_space
from carom.contact.stop import place_stop
from carom.contact.thresholds import ACTIVE_REACH
from carom.dynamics.thresholds import EDGE_JUMP
from carom.geometry.rotation import norm
from carom.kinematics.anisotropy import turn_plain
from carom.kinematics.contact_point import contact_velocity, place
from carom.law.turning import arm_of_torque
from carom.model.arrays import KIND_STOP, KIND_VERTICES
from carom.model.workspace import MOTION_PIVOT, MOTION_ROLL


@kernel
def closing_speed(contact, state):
    """Return a bound of the speed at which the two bodies approach each other [m/s]."""
    a, b = state[contact.body], contact.other
    s, v0, v1, v2 = contact.extent * norm(a.w), a.v[0], a.v[1], a.v[2]
    if b >= 0:
        s += contact.other_extent * norm(state[b].w)
        v0, v1, v2 = v0 - state[b].v[0], v1 - state[b].v[1], v2 - state[b].v[2]
    return s + math.sqrt(v0 * v0 + v1 * v1 + v2 * v2)


@kernel
def gather(model, data, h, fall, wide):
    """List the points that may touch within a time h; return their number, -1 if there is no room.

    The distance of a pair decreases at most by its speeds and by impulses of other bodies, for which twice g h
    is allowed. A single body may turn so that its other end falls at twice its speed; three times is allowed.
    If a point was missed, the distances are multiplied by `wide`.
    """
    system, active, state, crowd = model.system, data.active, data.state, data.crowd
    quicker, flight, crowd.count[0] = wide * (3.0 if state.shape[0] == 1 else 1.0), crowd.flight, 0
    chain(system, active, crowd)
    for c in range(system.contacts.shape[0]):
        contact, first, room = system.contacts[c], crowd.count[0], True
        if contact.kind == KIND_STOP:
            if reaches_stop(model, data, contact, h, wide * fall):
                room = add_stop(system, c, math.inf, state, crowd)
        else:
            speed = max(closing_speed(contact, state), closing_speed(contact, flight))
            if wide > 1.0:  # also with the velocities from the impulses found before
                speed = max(speed, closing_speed(contact, data.work.trial))
            reach = h * (quicker * speed + 2.0 * wide * fall * h)
            room = add_points(model, data, c, reach, state)
        for i in range(first, crowd.count[0]):
            crowd.closed[i].gap = crowd.points[0][i].gap
            find_active(active, crowd.closed[i], crowd)
        if not (room and add_turning(system, first, crowd)):
            return -1
    return crowd.count[0]


@kernel
def add_points(model, data, c, reach, state):
    """Add the points of a contact that are within reach; return whether there is room."""
    system, crowd, work = model.system, data.crowd, data.work
    contact = system.contacts[c]
    if apart(system, contact, state, reach):
        return True
    if contact.kind == KIND_VERTICES:
        return add_vertices(system, data.active, c, reach, state, crowd)
    find_closed(system, contact, reach, 0.0, state, work)
    return add_touches(system, c, reach, state, crowd, work)


@kernel
def gather_sunk(model, data, k, depth):
    """Add to the k spots the points of contacts that end inside by more than `depth` of the smaller body.

    Return the new count, -1 if there is no room.
    """
    system, end, crowd = model.system, data.work.trial, data.crowd
    crowd.count[0] = k
    for c in range(system.contacts.shape[0]):
        contact = system.contacts[c]
        if contact.kind == KIND_STOP or apart(system, contact, end, 0.0):
            continue
        if least_gap(system, contact, end, data.work) >= -depth * smaller(contact):
            continue
        if not add_points(model, data, c, 0.0, end):
            return -1
    return crowd.count[0]


@kernel
def add_turning(system, first, crowd):
    """Add rolling and pivoting friction of the spots from `first`; return whether there is room."""
    for i in range(first, crowd.count[0]):
        spot = crowd.closed[i]
        for motion in (MOTION_ROLL, MOTION_PIVOT):
            if arm_of_torque(system.laws, system.contacts[spot.contact], motion) > 0.0:
                k = crowd.count[0]
                if k == crowd.closed.shape[0]:
                    return False
                write_turning(i, motion, spot, crowd.closed[k])
                crowd.closed[k].gap = spot.gap
                crowd.count[0] = k + 1
    return True


@kernel
def reaches_stop(model, data, contact, h, fall):
    """Return whether a stop may be reached within a time h."""
    system, state, flight, point = model.system, data.state, data.crowd.flight, data.work.placed[0]
    place_stop(system, contact, flight, point)
    after, rate = point.gap, abs(contact_velocity(point, flight)[0])
    place_stop(system, contact, state, point)
    rate = max(rate, abs(contact_velocity(point, state)[0]))
    return min(point.gap, after) <= h * (rate + 2.0 * fall * h)


@kernel
def chain(system, active, crowd):
    """Link the active points of each contact in a chain; `visited` of the contact is 1 + its first point."""
    for c in range(system.contacts.shape[0]):
        active.contact_states[c].visited = 0
    for i in range(active.count[0] - 1, -1, -1):
        contact_state = active.contact_states[active.points[i].contact]
        crowd.follows[i] = contact_state.visited - 1
        contact_state.visited = i + 1


@kernel
def find_active(active, spot, crowd):
    """Find the active point of a spot."""
    i = active.contact_states[spot.contact].visited - 1
    while i >= 0:
        active_point = active.points[i]
        if active_point.feature == spot.feature:
            spot.active = i
            return
        i = crowd.follows[i]


@kernel
def place_all(model, data, first_spot, k, state, points):
    """Write the points from `first_spot` to k in a state."""
    system, crowd, work, i = model.system, data.crowd, data.work, first_spot
    while i < k:
        c = crowd.closed[i].contact
        contact = system.contacts[c]
        if contact.kind == KIND_VERTICES:
            place(contact, crowd.closed[i].point, state, points[i])
            turn_plain(contact, crowd.closed[i].motion, contact.extent, points[i])
            i += 1
            continue
        if contact.kind == KIND_STOP:
            place_stop(system, contact, state, points[i])
            i += 1
            continue
        first = i
        list_touches(system, contact, state, ACTIVE_REACH * smaller(contact), work)
        while i < k and crowd.closed[i].contact == c:
            spot = crowd.closed[i]
            t = which_touch(system, contact, spot.feature, spot.point, state, work)
            write_touch(contact, work.touches[t], state, points[i])
            turn_plain(contact, spot.motion, smaller(contact), points[i])
            i += 1
        if not on_half_space(contact):
            share_plane(points, first, i, state)


@kernel
def share_plane(points, first, last, state):
    """Move points of two bodies with nearly equal normals to one plane, with one normal.

    Each acts half-way between the two surfaces. Two bodies can then satisfy the conditions of all four corners
    of a face; with normals that differ by 1e-7 no impulses of moderate size would satisfy them.
    """
    nearest = first
    for i in range(first + 1, last):
        if points[i].gap < points[nearest].gap:
            nearest = i
    plane = points[nearest]
    a, n = state[plane.a].x, plane.axes[0]
    for i in range(first, last):
        point = points[i]
        for j in range(3):
            b = state[plane.b].x[j] if plane.b >= 0 else 0.0
            half = 0.5 * (a[j] + point.arm_a[j] - b - point.arm_b[j])
            point.arm_a[j], point.arm_b[j] = point.arm_a[j] - half, point.arm_b[j] + half
    for i in range(first, last):
        point, turned, away = points[i], 0.0, 0.0
        for j in range(3):
            turned += abs(point.axes[0, j] - n[j])
            away += n[j] * (point.arm_a[j] - plane.arm_a[j])
        if turned > EDGE_JUMP or i == nearest:
            continue
        for j in range(3):
            point.arm_a[j], point.arm_b[j] = (
                point.arm_a[j] - away * n[j],
                point.arm_b[j] - away * n[j],
            )
            for r in range(3):
                point.axes[r, j] = plane.axes[r, j]
