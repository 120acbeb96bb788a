"""Lists of contact points within a distance: vertices on a surface, points of two solids, stops.

`gather_closed` lists the closed and the active points of a group of bodies, `persistent.points` those that
carry an active contact, `stepping.crowd.spots` those that a crowd may reach within a step. A list has `closed`,
its points, `points`, the first row of which has their places in the state, and `count`, how many there are.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.gap import along_normal, gap_and_rate, plane_in_body, round_off
from carom.contact.groups import unite
from carom.contact.pair_point import find_touches, own_point, smaller, write_touch
from carom.contact.parting import beside_face
from carom.contact.parting_on_surface import room_over_surface
from carom.contact.place import place_any
from carom.contact.place_of_other import balls, centre_of_other, on_curved_ground, on_half_space
from carom.contact.rim import closed_rim, most_of_rim, way_round
from carom.contact.stop import is_active, place_stop
from carom.contact.thresholds import REACH, RIM_DISTANCE, RIM_TIME
from carom.geometry.vectors import dot, minus
from carom.kinematics.anisotropy import turn_plain
from carom.kinematics.contact_point import place
from carom.model.arrays import KIND_PAIR, KIND_STOP, KIND_VERTICES
from carom.model.workspace import MOTION_POINT


@kernel
def closed_within(controls, contact, state):
    """Return the gap up to which a point counts as closed [m]."""
    near = max(controls.tie, controls.gap) * smaller(contact)
    return max(near, 4.0 * round_off_of_both(contact, state))


@kernel
def round_off_of_both(contact, state):
    """Return the round-off of a gap that the coordinates of both bodies cause [m]."""
    tiny = round_off(contact, state)
    if on_half_space(contact):
        return tiny
    x = centre_of_other(contact, state)
    return max(tiny, 1e-15 * (abs(x[0]) + abs(x[1]) + abs(x[2]) + contact.other_extent))


@kernel
def concerns(contact, label, work):
    """Return whether a contact touches a body of the group."""
    if work.body[contact.body].label == label:
        return True
    return contact.other >= 0 and work.body[contact.other].label == label


@kernel
def apart(system, contact, state, near):
    """Return whether the distance of the balls around the two, or around two pieces, is larger than `near`."""
    if on_half_space(contact):
        x = state[contact.body].x
        return along_normal(contact, x) - contact.offset - contact.radius - contact.extent > near
    for pieces in range(1 + contact.part):
        if on_curved_ground(system, contact):
            if room_over_surface(system, contact, state, pieces == 1) > near:
                return True
            continue
        x, y, radii = balls(system, contact, state, pieces == 1)
        d = minus(x, y)
        if dot(d, d) > (radii + near) * (radii + near):
            return True
    return False


@kernel
def gather_closed(model, data, c, strikes):
    """List the points that are closed together with contact c; return their number, -1 for too many.

    A point is closed if its gap is within the tolerance of ties or of a located gap, or if it is active. If
    `strikes` is true, points of a nearly flat rim are closed too. Closed points and their positions are written
    to `data.group`. Bodies connected by closed points form one group, and all its closed points are listed.
    """
    system, active, state = model.system, data.active, data.state
    group, work = data.group, data.work
    first, more = system.contacts[c].body, True
    rim_time = RIM_TIME * model.controls.step if strikes else 0.0
    group.count[0] = 0
    if system.contacts[c].other >= 0:
        unite(work, first, system.contacts[c].other)
    for i in range(system.contacts.shape[0]):
        active.contact_states[i].visited = 0
    while more:
        more = False
        for i in range(system.contacts.shape[0]):
            contact, contact_state = system.contacts[i], active.contact_states[i]
            if contact_state.visited == 1 or not concerns(contact, work.body[first].label, work):
                continue
            contact_state.visited = 1
            near, before = closed_within(model.controls, contact, state), group.count[0]
            if contact.kind == KIND_STOP:
                near = math.inf if is_active(active, i) else near
                room = add_stop(system, i, near, state, group)
            elif apart(system, contact, state, near):
                continue
            elif contact.kind == KIND_VERTICES:
                room = add_vertices(system, active, i, near, state, group)
            else:
                near = find_closed(system, contact, near, rim_time, state, work)
                room = add_touches(system, i, near, state, group, work)
                if group.count[0] > before and contact.other >= 0:
                    unite(work, contact.body, contact.other)
                    more = True
            if not room:
                return -1
    note_active(system, active, group.count[0], state, group)
    return group.count[0]


@kernel
def add_vertices(system, active, c, near, state, spots):
    """Add the vertices within `near` of a half-space, or active, to a list; return whether there is room."""
    contact = system.contacts[c]
    plane = plane_in_body(contact, state)
    for i in range(contact.first, contact.last):
        z, _ = gap_and_rate(plane, system.vertices[i])
        if z <= near or active.carries[i] == 1:
            k = spots.count[0]
            if k == spots.closed.shape[0]:
                return False
            write_closed(c, i, system.vertices[i], spots.closed[k])
            place(contact, spots.closed[k].point, state, spots.points[0][k])
            spots.count[0] = k + 1
    return True


@kernel
def add_stop(system, c, near, state, spots):
    """Add a stop that is within `near` to a list; return whether there is room."""
    k = spots.count[0]
    if k == spots.closed.shape[0]:
        return False
    point = spots.points[0][k]
    place_stop(system, system.contacts[c], state, point)
    if not point.gap > near:
        write_closed(c, 0, point.core, spots.closed[k])
        spots.count[0] = k + 1
    return True


@kernel
def find_closed(system, contact, near, rim_time, state, work):
    """Write the points of two solids that may be within `near`; return the gap up to which they are closed.

    It is `near`, or more for a rim that is flat within `rim_time`: this counts as flat.
    """
    if beside_face(system, contact, state, max(near, most_of_rim(contact, state, rim_time))):
        work.pair.state[0].total = 0
        return near
    count = find_touches(system, contact, state, max(near, REACH * smaller(contact)), work)
    if rim_time > 0.0 and count > 0:
        near = max(near, closed_rim(system, contact, work.touches[0].normal, state, rim_time))
    return near


@kernel
def add_touches(system, c, near, state, spots, work):
    """Add the found points of two solids that are within `near`; return whether there is room."""
    for i in range(work.pair.state[0].total):
        k, touch = spots.count[0], work.touches[i]
        if touch.gap <= near:
            if k == spots.closed.shape[0]:
                return False
            add_touch(system.contacts[c], c, touch, state, k, spots)
            spots.count[0] = k + 1
    return True


@kernel
def add_touch(contact, c, touch, state, k, group):
    """Write a found point of two solids as point k."""
    own_point(contact, touch, state, group.closed[k].point)
    write_closed(c, touch.feature, group.closed[k].point, group.closed[k])
    write_touch(contact, touch, state, group.points[0][k])


@unit
def is_same_point(system, active_point, point, state) -> bool:
    """Return whether a closed point with the feature of an active one is the same point."""
    contact, r, n = system.contacts[active_point.contact], point.arm_a, point.axes[0]
    moved = way_round(system, contact, n, (r[0], r[1], r[2]), active_point.point, state)
    return moved < RIM_DISTANCE


@kernel
def note_active(system, active, k, state, group):
    """Store the index of each closed point among the active ones."""
    for i in range(active.count[0]):
        one = active.points[i]
        for j in range(k):
            closed_point, point = group.closed[j], group.points[0][j]
            same = closed_point.contact == one.contact and closed_point.feature == one.feature
            if same and (one.kind != KIND_PAIR or is_same_point(system, one, point, state)):
                closed_point.active = i


@kernel
def place_closed(system, k, state, group, points, work):
    """Write the positions of all closed points in a state."""
    for i in range(k):
        closed_point = group.closed[i]
        if closed_point.contact < 0:  # friction in a joint
            continue
        place_any(system, closed_point, state, points[i], work)
        if closed_point.motion != MOTION_POINT:
            contact = system.contacts[closed_point.contact]
            turn_plain(contact, closed_point.motion, smaller(contact), points[i])


@kernel
def write_closed(c, feature, p, closed_point):
    """Write one point of a list, which is not known to be active."""
    closed_point.contact, closed_point.feature, closed_point.active = c, feature, -1
    closed_point.motion = MOTION_POINT
    for k in range(3):
        closed_point.point[k] = p[k]


@kernel
def write_turning(i, motion, parent, closed_point):
    """Write the rolling (`MOTION_ROLL`) or pivoting friction of point i of a list."""
    write_closed(parent.contact, parent.feature, parent.point, closed_point)
    closed_point.motion, closed_point.parent, closed_point.active = motion, i, parent.active
