"""The closed points of a group of bodies: vertices on the surface, and all that is held."""

from __future__ import annotations

from carom.contact.gap import along_normal, gap_and_rate, plane_in_body, round_off
from carom.jit import kernel
from carom.motion.contact_point import place


@kernel
def gather_closed(system, controls, held, group, state, cluster):
    """List what is closed in `state`; return how many points, -1 if they are too many.

    Closed: within the tolerance of ties or of a located gap, or held. Writes seats and points.
    """
    k = 0
    for c in range(system.contacts.shape[0]):
        contact = system.contacts[c]
        if contact.group != group:
            continue
        near = max(controls.tie, controls.gap) * contact.extent
        near = max(near, 4.0 * round_off(contact, state))
        height = along_normal(contact, state[contact.body].x) - contact.offset - contact.radius
        if height - contact.extent > near:
            continue
        plane = plane_in_body(contact, state)
        for i in range(contact.first, contact.last):
            z, _ = gap_and_rate(plane, system.vertices[i])
            if z <= near or held.carries[i] == 1:
                if k == cluster.seats.shape[0]:
                    return -1
                take_seat(contact, c, i, system.vertices[i], cluster.seats[k])
                place(contact, cluster.seats[k].point, state, cluster.points[k])
                k += 1
    for i in range(held.count[0]):
        hold = held.points[i]
        for j in range(k):
            seat = cluster.seats[j]
            if seat.contact == hold.contact and seat.feature == hold.feature:
                seat.held = i
    return k


@kernel
def gather_held(system, held, group, state, cluster):
    """List the held points of a group; return how many."""
    k = 0
    for i in range(held.count[0]):
        hold = held.points[i]
        contact = system.contacts[hold.contact]
        if contact.group == group and k < cluster.seats.shape[0]:
            take_seat(contact, hold.contact, hold.feature, hold.point, cluster.seats[k])
            cluster.seats[k].held = i
            place(contact, hold.point, state, cluster.points[k])
            k += 1
    return k


@kernel
def take_seat(contact, c, feature, p, seat):
    """Write one closed point."""
    seat.contact, seat.feature, seat.held, seat.stays = c, feature, -1, 0
    for k in range(3):
        seat.point[k] = p[k]
