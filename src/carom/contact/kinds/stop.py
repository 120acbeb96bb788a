"""Stops in joints: unilateral constraints on a coordinate, gap = side q - offset, without tangents.

A stop strikes through the same boundary layer as any contact, and can be in persistent contact. For an angle,
the gap is the arc at the radius of the body's size, so that all contacts have the same units; a solution
contains angles and torques (`carom.results.assemble`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact import gap as gaps
from carom.contact.continuous_detection import (
    BELOW,
    CLEAR,
    UNSURE,
    arrives,
    cubic_clears,
    safe_time,
    time_of_hop,
)
from carom.contact.gap import round_off, slow
from carom.contact.point_axes import tangents
from carom.contact.point_lists import is_active, write_closed
from carom.geometry.thresholds import RESOLUTION
from carom.kinematics.combination import drift as rate_of_slope
from carom.kinematics.combination import first_of, rate, value
from carom.kinematics.contact_point import contact_velocity
from carom.kinematics.coordinate import (
    along,
    face_drift,
    has_face,
    place_face,
    slides,
    turns_with_place,
)
from carom.kinematics.joints import child_arm, parent_arm
from carom.kinematics.wrap import grip, grip_rate
from carom.model.actions import NOTHING, PERSIST, STRIKE
from carom.model.parts_of_system import has_metric
from carom.model.workspace import MOTION_STOP, MOTION_THREE
from carom.status import FUNCTION_FAILED

located_within, rounding = gaps.located_within, round_off


@kernel
def wrap_of(system, contact):
    """Return the wrap of a rope that rubs."""
    return system.relations.wraps[contact.other_solid - 1]


@unit
def place_stop(system, contact, state, point):
    """Write the point, axes and gap of a stop."""
    of_stop = system.relations.coordinates[contact.solid]
    c = first_of(system, of_stop)  # its axis and arms are for records alone
    if has_face(system, c):
        place_face(system, contact, c, state, point)
        return
    nx, ny, nz = along(system, c, state)
    # the normal is that of the child relative to the parent; its sign changes if the child is the ground
    s = 1.0 if (contact.side > 0.0) == (contact.body == c.child) else -1.0
    point.a, point.b = contact.body, contact.other
    tangents(s * nx, s * ny, s * nz, point.axes)
    for k in range(3):
        point.core[k], point.arm_a[k], point.arm_b[k] = 0.0, 0.0, 0.0
    if c.child >= 0:
        r = child_arm(c, state)
        point.arm_a[0], point.arm_a[1], point.arm_a[2] = r
        if slides(c):
            r = parent_arm(c, state)
            point.arm_b[0], point.arm_b[1], point.arm_b[2] = r
    point.gap = contact.side * value(system, of_stop, state) - contact.offset
    point.motion = MOTION_THREE if has_metric(system) else MOTION_STOP
    point.length, point.coordinate, point.grip = contact.side, contact.solid, 1.0
    if contact.other_solid > 0:
        point.motion = MOTION_THREE
        point.grip = grip(system, wrap_of(system, contact), state)
    point.moves = 0


@unit
def stop_gap(system, contact, state, work) -> tuple[float, float]:
    """Return the gap of a stop and its rate."""
    c = system.relations.coordinates[contact.solid]
    if has_face(system, c):
        place_stop(system, contact, state, work.placed[0])
        return work.placed[0].gap, contact_velocity(system, work.placed[0], state)[0]
    return contact.side * value(system, c, state) - contact.offset, contact.side * rate(
        system, c, state
    )


@unit
def drift(system, contact, feature, point, state, work) -> tuple[float, float, float]:
    """Return (d/dt G) v of a stop."""
    c = system.relations.coordinates[contact.solid]
    if has_face(system, c):
        return face_drift(system, c, state)
    out, k = work.joint[0].target, contact.solid
    n = contact.side * rate_of_slope(system, c, state, out)
    if point.motion != MOTION_THREE:
        return n, 0.0, 0.0
    slip = system.relations.coordinates[k + 1]
    t1 = point.grip * rate_of_slope(system, slip, state, out)
    if contact.other_solid > 0:
        t1 += grip_rate(system, wrap_of(system, contact), state) * rate(system, slip, state)
    return n, t1, rate_of_slope(system, system.relations.coordinates[k + 2], state, out)


@kernel
def place(system, contact, known, state, point, work):
    """Write the point, axes and gap of a stop."""
    place_stop(system, contact, state, point)


@kernel
def room(system, contact, state, pieces):
    """Return no bound: the gap itself is as easily found."""
    return -math.inf


@kernel
def least_gap(system, contact, state, work):
    """Return the gap of a stop."""
    return stop_gap(system, contact, state, work)[0]


@kernel
def event_gap(system, data, c, state):
    """Return the gap of a stop, and its rate."""
    return stop_gap(system, system.contacts[c], state, data.work)


@kernel
def lost_gap(contact):
    """Return the status of a stop without a gap: the user's function has no value."""
    return FUNCTION_FAILED


@kernel
def closing_speed(system, contact, state, work):
    """Return the speed of a stop, which is nearly constant within a step."""
    return abs(stop_gap(system, contact, state, work)[1])


@kernel
def turning_radius(system, contact):
    """Return the distance at the limit, for a distance from a point or a line."""
    c = first_of(system, system.relations.coordinates[contact.solid])
    return abs(contact.offset) if turns_with_place(c) else math.inf


@kernel
def add_points(model, data, c, state, within, spots):
    """Add a stop within a distance, or active, to a list; return whether there is room."""
    k, (near, _) = spots.count[0], within
    if k == spots.closed.shape[0]:
        return False
    point = spots.points[0][k]
    place_stop(model.system, model.system.contacts[c], state, point)
    if not point.gap > near or is_active(data.active, c):
        write_closed(c, 0, point.core, k, spots.closed[k])
        spots.count[0] = k + 1
    return True


@kernel
def due(model, data, c):
    """Return the action that a closed stop asks for."""
    contact = model.system.contacts[c]
    z, rate = stop_gap(model.system, contact, data.state, data.work)
    still = slow(contact, data.state)
    if z > model.controls.tie * contact.extent or rate > still:
        return NOTHING
    if rate < -still:
        return STRIKE
    return NOTHING if is_active(data.active, c) else PERSIST


@kernel
def passage(model, data, c):
    """Return CLEAR, BELOW or UNSURE, and a time before any contact, from the cubic to the trial state."""
    contact, work, h = model.system.contacts[c], data.work, data.work.search[0].dt
    if is_active(data.active, c):
        return CLEAR, h
    z0, rate0 = stop_gap(model.system, contact, data.state, work)
    z1, rate1 = stop_gap(model.system, contact, work.trial, work)
    tiny = max(model.controls.gap * contact.extent, round_off(contact, work.trial))
    if not (z1 >= -tiny):
        slightly = z1 >= -RESOLUTION * contact.extent
        slightly = slightly and time_of_hop(z0, rate0, z1, rate1, h, tiny) == 0.0
        if z0 <= tiny and (slightly or (z0 < -tiny and z1 >= z0)):
            return CLEAR, 0.0
        return BELOW, 2.0 * safe_time(z0, rate0, z1, rate1, h, tiny)
    if arrives(z0, rate0, z1, rate1, tiny, slow(contact, work.trial)):
        data.active.contact_states[c].near = 1
    leaving = data.active.contact_states[c].leaving
    if leaving == 0 and not cubic_clears(z0, rate0, z1, rate1, h, tiny):
        return UNSURE, 0.0
    return CLEAR, h
