"""The closed points of a group of bodies: vertices on a surface, points of two solids, active contacts."""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.contact.gap import along_normal, gap_and_rate, plane_in_body, round_off
from carom.contact.groups import unite
from carom.contact.pair_point import (
    REACH,
    find_touches,
    own_point,
    smaller,
    write_touch,
)
from carom.contact.place import place_any
from carom.contact.rim import OTHER_SIDE, closed_rim, way_round
from carom.contact.stop import is_held_stop, place_stop
from carom.kinematics.contact_point import place
from carom.model.arrays import STOP

#: part of the step in which a rim that turns flat is flat, as far as the step can tell
RIM_TIME = 1.0 / 64.0


@kernel
def closed_within(controls, contact, state):
    """Return the gap up to which a point counts as closed [m]."""
    near = max(controls.tie, controls.gap) * smaller(contact)
    return max(near, 4.0 * round_off_of_both(contact, state))


@kernel
def round_off_of_both(contact, state):
    """Return the round-off of a gap that the coordinates of both bodies cause [m]."""
    tiny = round_off(contact, state)
    if contact.other < 0:
        return tiny
    x = state[contact.other].x
    return max(tiny, 1e-15 * (abs(x[0]) + abs(x[1]) + abs(x[2]) + contact.other_extent))


@kernel
def concerns(contact, group, work):
    """Return whether a contact touches a body of the group."""
    if work.body[contact.body].group == group:
        return True
    return contact.other >= 0 and work.body[contact.other].group == group


@kernel
def apart(contact, state, near):
    """Return whether the balls around the two are further apart than `near`."""
    x = state[contact.body].x
    if contact.other < 0:
        return along_normal(contact, x) - contact.offset - contact.radius - contact.extent > near
    y = state[contact.other].x
    d = contact.extent + contact.other_extent + near
    return (x[0] - y[0]) ** 2 + (x[1] - y[1]) ** 2 + (x[2] - y[2]) ** 2 > d * d


@kernel
def gather_closed(system, controls, held, c, state, cluster, work, strikes):
    """List the points that are closed in `state` together with contact c; return how many, -1 for too many.

    Closed: within the tolerance of ties or of a located gap, or held; where it `strikes`, a rim that is as good
    as flat, too. Writes the closed points and where they are. Bodies that closed points link become one group,
    in which all closed points count.
    """
    first, k, more = system.contacts[c].body, 0, True
    rim_time = RIM_TIME * controls.step if strikes else 0.0
    if system.contacts[c].other >= 0:
        unite(work, first, system.contacts[c].other)
    for i in range(system.contacts.shape[0]):
        held.brinks[i].seen = 0
    while more:
        more = False
        for i in range(system.contacts.shape[0]):
            contact, brink = system.contacts[i], held.brinks[i]
            if brink.seen == 1 or not concerns(contact, work.body[first].group, work):
                continue
            brink.seen = 1
            near = closed_within(controls, contact, state)
            if contact.touches != STOP and apart(contact, state, near):
                continue
            before = k
            if contact.touches == 0:
                k = add_vertices(system, held, i, near, state, k, cluster)
            elif contact.touches == STOP:
                k = add_stop(system, held, i, near, state, k, cluster)
            else:
                k = add_touches(system, i, near, rim_time, state, k, cluster, work)
                if k > before and contact.other >= 0:
                    unite(work, contact.body, contact.other)
                    more = True
            if k < 0:
                return -1
    seat_held(system, held, k, state, cluster, work)
    return k


@kernel
def add_vertices(system, held, c, near, state, k, cluster):
    """Add the vertices that are closed to a half-space; return the new count, -1 if there is no room."""
    contact = system.contacts[c]
    plane = plane_in_body(contact, state)
    for i in range(contact.first, contact.last):
        z, _ = gap_and_rate(plane, system.vertices[i])
        if z <= near or held.carries[i] == 1:
            if k == cluster.seats.shape[0]:
                return -1
            take_seat(c, i, system.vertices[i], cluster.seats[k])
            place(contact, cluster.seats[k].point, state, cluster.points[0][k])
            k += 1
    return k


@kernel
def add_stop(system, held, c, near, state, k, cluster):
    """Add a stop that is closed or held; return the new count, -1 if there is no room."""
    if k == cluster.seats.shape[0]:
        return -1
    point = cluster.points[0][k]
    place_stop(system, system.contacts[c], state, point)
    if point.gap > near and not is_held_stop(held, c):
        return k
    take_seat(c, 0, point.core, cluster.seats[k])
    return k + 1


@unit
def _add_touches(system, c, near, rim_time, state, k, cluster, work) -> int:
    """Add the points of two solids that are closed; return the new count, -1 if there is no room.

    A rim that is flat within `rim_time` counts as flat.
    """
    contact = system.contacts[c]
    count = find_touches(system, contact, state, REACH * smaller(contact), work)
    if rim_time > 0.0:
        n = work.touches[0].normal
        near = max(near, closed_rim(system, contact, n, state, rim_time))
    for i in range(count):
        touch = work.touches[i]
        if touch.gap <= near:
            if k == cluster.seats.shape[0]:
                return -1
            own_point(contact, touch, state, cluster.seats[k].point)
            take_seat(c, touch.feature, cluster.seats[k].point, cluster.seats[k])
            write_touch(contact, touch, state, cluster.points[0][k])
            k += 1
    return k


@inlined
def add_touches(system, c, near, rim_time, state, k, cluster, work):
    """Add the points of two solids that are closed; return the new count, -1 if there is no room."""
    if system.solids.shape[0] > 0:
        return _add_touches(system, c, near, rim_time, state, k, cluster, work)
    return k


@unit
def _seat_stays(system, hold, point, state, work) -> bool:
    """Return whether a closed point with the feature of a held one is the same point."""
    contact, r, n = system.contacts[hold.contact], point.arm_a, point.axes[0]
    way = way_round(system, contact, n, (r[0], r[1], r[2]), hold.point, state)
    return way < OTHER_SIDE


@inlined
def seat_stays(system, hold, point, state, work):
    """Return whether a closed point with the feature of a held one is the same point."""
    if system.solids.shape[0] > 0:
        return _seat_stays(system, hold, point, state, work)
    return True


@kernel
def seat_held(system, held, k, state, cluster, work):
    """Note the place of each closed point among the held ones."""
    for i in range(held.count[0]):
        hold = held.points[i]
        for j in range(k):
            seat = cluster.seats[j]
            if seat.contact == hold.contact and seat.feature == hold.feature:
                if hold.touches != 1 or seat_stays(system, hold, cluster.points[0][j], state, work):
                    seat.held = i


@kernel
def gather_held(system, held, group, state, cluster, work):
    """List the held points of a group, then their rolling and pivoting; return how many."""
    k = 0
    for i in range(held.count[0]):
        hold = held.points[i]
        if work.body[hold.body].group == group and k < cluster.seats.shape[0]:
            take_seat(hold.contact, hold.feature, hold.point, cluster.seats[k])
            cluster.seats[k].held = i
            k += 1
    for i in range(k):
        seat = cluster.seats[i]
        turning = system.contacts[seat.contact].turning
        for turns in range(1, 3):
            if turning[turns - 1] > 0.0 and k < cluster.seats.shape[0]:
                take_seat(seat.contact, seat.feature, seat.point, cluster.seats[k])
                cluster.seats[k].held, cluster.seats[k].parent = seat.held, i
                cluster.seats[k].turns = turns
                k += 1
    place_seats(system, k, state, cluster, cluster.points[0], work)
    return k


@kernel
def place_seats(system, k, state, cluster, points, work):
    """Write the points of all seats, as they are in a state."""
    for i in range(k):
        seat = cluster.seats[i]
        place_any(
            system, system.contacts[seat.contact], seat.feature, seat.point, state, points[i], work
        )
        if seat.turns > 0:
            points[i].turns = seat.turns
            points[i].length = smaller(system.contacts[seat.contact])


@kernel
def take_seat(c, feature, p, seat):
    """Write one closed point."""
    seat.contact, seat.feature, seat.held, seat.stays = c, feature, -1, 0
    seat.turns = 0
    for k in range(3):
        seat.point[k] = p[k]
