"""The active set: adding a point, removing a point, and points with common bodies."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.gap import slow
from carom.contact.groups import label_groups
from carom.contact.kinds.found_points import own_point, touch_rate
from carom.contact.kinds.level_surfaces import is_of_moving, related
from carom.contact.kinds.partner import closed_within, has_one_normal, smaller
from carom.contact.kinds.rim import place_of, same_point
from carom.contact.operations import apart, find_touches, is_fixed, is_found, place
from carom.contact.point_lists import mark
from carom.contact.thresholds import REACH
from carom.model.actions import MODE_OPEN, MODE_STICK
from carom.model.event_rows import begin_event, end_event
from carom.model.parts_of_system import has_solids
from carom.model.records import OPENS, SLIPS, STICKS
from carom.persistent.thresholds import CUT_RESIDUAL


@kernel
def begin_point(active_point, contact, c, feature, mode):
    """Write a new active point of contact c, marked as one of several, without a force."""
    active_point.contact, active_point.feature = c, feature
    active_point.body, active_point.other = contact.body, contact.other
    active_point.fixed = 1 if is_fixed(contact) else 0
    active_point.found = 1 if is_found(contact) else 0
    active_point.mode, active_point.next, active_point.rest, active_point.shares = mode, mode, 0, 1
    active_point.due, active_point.bounces, active_point.left = 0, 0.0, 1.0
    active_point.heading[0], active_point.heading[1] = 0.0, 0.0
    active_point.W[:] = 0.0
    clear(active_point)


@kernel
def clear(active_point):
    """Take force, margins and stops from an active point."""
    active_point.stop, active_point.jams, active_point.comes_to_rest = math.inf, 0, 0
    active_point.pull = 0.0
    active_point.lift, active_point.grip = 1.0, 1.0
    active_point.kink[0], active_point.kink[1] = 1.0, 1.0
    active_point.turn_stop[0], active_point.turn_stop[1] = math.inf, math.inf
    for r in range(3):
        active_point.force[r], active_point.torque[r] = 0.0, 0.0


@kernel
def activate(system, data, closed_point):
    """Add a closed point to the active set, where it sticks at first; return its index."""
    active = data.active
    i = active.count[0]
    active.count[0] = i + 1
    active_point, contact = active.points[i], system.contacts[closed_point.contact]
    begin_point(active_point, contact, closed_point.contact, closed_point.feature, MODE_STICK)
    active.contact_states[closed_point.contact].broken = 0
    active_point.shares = 0
    for k in range(3):
        active_point.point[k] = closed_point.point[k]
    mark(active, active_point, 1)
    active.contact_states[closed_point.contact].leaving = 0
    return i


@kernel
def set_anchor(system, active_point, state, work):
    """Store the present position of a vertex, at which it stays while it sticks."""
    if active_point.fixed == 0:
        return
    point, x = work.placed[0], state[active_point.body].x
    place(system, system.contacts[active_point.contact], active_point, state, point, work)
    for k in range(3):
        active_point.anchor[k] = x[k] + point.arm_a[k]


@kernel
def deactivate(active, i):
    """Remove point i from the active set; the others keep their order."""
    mark(active, active.points[i], 0)
    active.contact_states[active.points[i].contact].leaving = 1
    last = active.count[0] - 1
    for j in range(i, last):
        active.points[j] = active.points[j + 1]
    active.count[0] = last


@kernel
def switch(system, data, i, mode):
    """Give active point i a mode, or take it from the active set (MODE_OPEN), with an event."""
    active, state, clock, records = data.active, data.state, data.clocks[0], data.records
    active_point, c = active.points[i], active.points[i].contact
    begin_event(system, c, active_point.feature, state, clock, records)
    active_point.mode = mode
    if mode == MODE_STICK:
        set_anchor(system, active_point, state, data.work)
    elif mode == MODE_OPEN:
        deactivate(active, i)
        active.contact_states[c].broken = 1
    kind = OPENS if mode == MODE_OPEN else STICKS if mode == MODE_STICK else SLIPS
    end_event(system, c, kind, state, clock, records)


@kernel
def regroup(system, active, work):
    """Label the groups of active points, and mark points whose bodies have other active points.

    All joined and loaded bodies have one right-hand side, so that they are one group.
    """
    label_groups(system, active, work)
    unite_loaded(system, work)
    joined, n = 0, work.body.shape[0]
    for b in range(n):
        work.body[b].n_active = 0
    for i in range(active.count[0]):
        label = work.body[active.points[i].body].label
        if label < n:
            work.body[label].n_active += 1
        else:
            joined += 1
    for i in range(active.count[0]):
        label = work.body[active.points[i].body].label
        count = work.body[label].n_active if label < n else joined
        active.points[i].shares = 1 if count > 1 else 0


@kernel
def unite_loaded(system, work):
    """Give all joined and loaded bodies, and those in contact with them, the label N."""
    n = work.body.shape[0]
    for b in range(n):
        label = work.body[b].label
        if system.bodies[b].ballistic == 0 and label != n:
            for i in range(n):
                if work.body[i].label == label:
                    work.body[i].label = n


@unit(where=has_solids, otherwise=False)
def refresh_pairs(system, controls, data) -> bool:
    """Replace points whose features no longer exist by the points of the new features.

    When faces slide on each other, the corners of their overlap change, and the active set must follow. The
    present positions of the other points are stored. Return whether the set has changed.
    """
    active, state, work = data.active, data.state, data.work
    changed, i = False, 0
    while i < active.count[0]:
        active_point = active.points[i]
        if active_point.found == 0 or active_point.rest == 1:
            i += 1
            continue
        c, contact = active_point.contact, system.contacts[active_point.contact]
        count = find_touches(system, contact, state, REACH * smaller(contact), work)
        there = False
        for t in range(count):
            touch = work.touches[t]
            if same_point(system, contact, touch, active_point.feature, active_point.point, state):
                own_point(contact, touch, state, active_point.point)
                there = True
        if there:
            if is_of_moving(contact) and is_first(active, i, 0):
                changed = add_riding(system, controls, data, i) or changed
            i += 1
            continue
        mode, f, pull = active_point.mode, active_point.force, active_point.pull
        force = (f[0], f[1], f[2])
        deactivate(active, i)
        before = active.count[0]
        active.contact_states[c].leaving = 0
        changed = True
        for d in range(system.contacts.shape[0]):
            if related(system, c, d):
                replace_points(system, controls, data, d, mode, d != c and is_of_moving(contact))
        for j in range(before, active.count[0]):  # they share its force, until the next step
            active.points[j].pull = pull / (active.count[0] - before)
            for r in range(3):
                active.points[j].force[r] = force[r] / (active.count[0] - before)
    return changed


@kernel
def is_first(active, i, begin):
    """Return whether an active point is the first of its contact; no other is before `begin`."""
    for j in range(begin, i):
        if active.points[j].contact == active.points[i].contact:
            return False
    return True


@kernel
def add_riding(system, controls, data, i):
    """Activate points of related rows on the level surface of active point i; return whether there are any."""
    active, before = data.active, data.active.count[0]
    c, mode = active.points[i].contact, active.points[i].mode
    for d in range(system.contacts.shape[0]):
        if d != c and related(system, c, d):
            replace_points(system, controls, data, d, mode, True)
    return active.count[0] > before


@kernel
def replace_points(system, controls, data, c, mode, rides):
    """Activate the closed points of contact c, in place of a point that no longer exists.

    Only those on level surfaces of moving bodies, if it `rides` there.

    Points that approach faster than a contact problem may leave unsolved are not persistent: of two bodies they
    strike (the edge of a cam whose flat top becomes level with its follower).
    """
    active, state, work, contact = data.active, data.state, data.work, system.contacts[c]
    near, still = closed_within(controls, contact, state), 10.0 * slow(contact, state)
    if apart(system, contact, state, near):
        return
    plane = has_one_normal(contact)
    if not plane:
        still = max(still, CUT_RESIDUAL * controls.step * controls.pull)
    for t in range(find_touches(system, contact, state, REACH * smaller(contact), work)):
        touch = work.touches[t]
        free = active.count[0] < active.points.shape[0]
        if touch.gap > near or place_of(system, active, c, touch, state) >= 0:
            continue
        if rides and touch.surface == 0:
            continue
        if touch_rate(contact, touch, state) < -still:
            active.contact_states[c].near = max(active.contact_states[c].near, 0 if plane else 1)
        elif free:
            active_point = active.points[active.count[0]]
            active.count[0] += 1
            begin_point(active_point, contact, c, touch.feature, mode)
            own_point(contact, touch, state, active_point.point)
