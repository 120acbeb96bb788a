"""The points that are closed together: those within the tolerance of ties or of a located gap, or active.

`gather_closed` lists those of a group of bodies, `persistent.points` those that carry an active contact,
`stepping.crowd.spots` those that a crowd may reach within a step. A list has `closed`, its points, `points`,
the first row of which has their places in the state, and `count`, how many there are.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.groups import unite
from carom.contact.kinds.partner import closed_within, smaller
from carom.contact.kinds.rim import way_round
from carom.contact.operations import add_points, apart, place
from carom.contact.thresholds import RIM_DISTANCE, RIM_TIME
from carom.kinematics.anisotropy import turn_plain
from carom.model.workspace import MOTION_POINT


@kernel
def concerns(contact, label, work):
    """Return whether a contact touches a body of the group."""
    if work.body[contact.body].label == label:
        return True
    return contact.other >= 0 and work.body[contact.other].label == label


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
            if apart(system, contact, state, near):
                continue
            if not add_points(model, data, i, state, (near, rim_time), group):
                return -1
            if group.count[0] > before and contact.other >= 0:
                unite(work, contact.body, contact.other)
                more = True
    if strikes and group.count[0] > group.idle.shape[1]:  # impacts have full matrices
        return -1
    note_active(system, active, group.count[0], state, group)
    return group.count[0]


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
            if same and (one.found == 0 or is_same_point(system, one, point, state)):
                closed_point.active = i


@kernel
def place_closed(system, k, state, group, points, work):
    """Write the positions of all closed points in a state."""
    for i in range(k):
        closed_point = group.closed[i]
        if closed_point.contact < 0:  # friction in a joint
            continue
        contact = system.contacts[closed_point.contact]
        place(system, contact, closed_point, state, points[i], work)
        if closed_point.motion != MOTION_POINT:
            turn_plain(contact, closed_point.motion, smaller(contact), points[i])
