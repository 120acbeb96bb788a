"""The points of a crowd that may touch within a step, and their positions in a state."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.contact.kinds.found_points import which_touch, write_touch
from carom.contact.kinds.partner import has_one_normal, smaller
from carom.contact.operations import (
    add_points,
    apart,
    closing_speed,
    is_found,
    least_gap,
    list_touches,
    place,
)
from carom.contact.point_lists import write_turning
from carom.contact.thresholds import ACTIVE_REACH, EDGE_JUMP
from carom.kinematics.anisotropy import turn_plain
from carom.law.turning import arm_of_torque
from carom.model.workspace import MOTION_PIVOT, MOTION_POINT, MOTION_ROLL


@kernel
def gather(model, data, h, fall, wide):
    """List the points that may touch within a time h; return their number, -1 if there is no room.

    The distance of a pair decreases at most by its speeds and by impulses of other bodies, for which twice g h
    is allowed. A single body may turn so that its other end falls at twice its speed; three times is allowed.
    If a point was missed, the distances are multiplied by `wide`.
    """
    system, active, state, crowd = model.system, data.active, data.state, data.crowd
    work = data.work
    quicker, flight, crowd.count[0] = wide * (3.0 if state.shape[0] == 1 else 1.0), crowd.flight, 0
    chain(system, active, crowd)
    for c in range(system.contacts.shape[0]):
        contact, first = system.contacts[c], crowd.count[0]
        speed = closing_speed(system, contact, state, work)
        speed = max(speed, closing_speed(system, contact, flight, work))
        if wide > 1.0:  # also with the velocities from the impulses found before
            speed = max(speed, closing_speed(system, contact, work.trial, work))
        reach = h * (quicker * speed + 2.0 * wide * fall * h)
        if not add_spots(model, data, c, reach, state):
            return -1
        for i in range(first, crowd.count[0]):
            crowd.closed[i].gap = crowd.points[0][i].gap
            find_active(active, crowd.closed[i], crowd)
        if not add_turning(system, first, crowd):
            return -1
    return crowd.count[0]


@kernel
def add_spots(model, data, c, reach, state):
    """Add the points of a contact that are within reach; return whether there is room."""
    if apart(model.system, model.system.contacts[c], state, reach):
        return True
    return add_points(model, data, c, state, (reach, 0.0), data.crowd)


@kernel
def gather_sunk(model, data, k, depth):
    """Add to the k spots the points of contacts that end inside by more than `depth` of the smaller body.

    Return the new count, -1 if there is no room.
    """
    system, end, crowd = model.system, data.work.trial, data.crowd
    crowd.count[0] = k
    for c in range(system.contacts.shape[0]):
        contact = system.contacts[c]
        if apart(system, contact, end, 0.0):
            continue
        if least_gap(system, contact, end, data.work) >= -depth * smaller(contact):
            continue
        if not add_spots(model, data, c, 0.0, end):
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
        c, first = crowd.closed[i].contact, i
        contact = system.contacts[c]
        if is_found(contact):
            list_touches(system, contact, state, ACTIVE_REACH * smaller(contact), work)
        while i < k and crowd.closed[i].contact == c:
            spot = crowd.closed[i]
            if is_found(contact):
                t = which_touch(system, contact, spot.feature, spot.point, state, work)
                write_touch(contact, work.touches[t], state, points[i])
            else:
                place(system, contact, spot, state, points[i], work)
            if spot.motion != MOTION_POINT:
                turn_plain(contact, spot.motion, smaller(contact), points[i])
            i += 1
        if is_found(contact) and not has_one_normal(contact):
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
