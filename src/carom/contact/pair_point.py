"""Contact points in the form that the rest of the library uses: arms, axes, gap.

They belong to two bodies, or to a curved body and a half-space (then the other body is -1).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.collision.layout import CURVED_GROUND, PROFILE, Placed, Plane
from carom.collision.on_surface import feature_on_surface
from carom.collision.plane import plane_unit
from carom.collision.touch import touch_unit
from carom.contact.drift import drift_of_solids
from carom.contact.drift_on_surface import drift_on_surface
from carom.contact.level import keep_real_touches, solid_beyond, solid_left
from carom.contact.place_of_other import on_curved_ground, on_half_space, pose_of
from carom.contact.profile_drift import drift_of_profile
from carom.contact.rim import same_point
from carom.contact.roll import roll_on_plane
from carom.contact.thresholds import ACTIVE_REACH
from carom.geometry.rotation import cross, rotate, rotate_back
from carom.geometry.thresholds import ROUND_OFF
from carom.geometry.vectors import dot, minus, plus
from carom.kinematics.anisotropy import lay_along_axis
from carom.kinematics.contact_point import carry_field
from carom.kinematics.wrench import point_velocity
from carom.model.workspace import MOTION_POINT, STATIC


@kernel
def find_touches(system, contact, state, reach, work):
    """Write the points of a contact that count into work.touches; return how many, perhaps none."""
    count = list_touches(system, contact, state, reach, work)
    if contact.first_level < contact.last_level or contact.first_mine < contact.last_mine:
        return keep_real_touches(system, contact, state, work)
    return count


@kernel
def list_touches(system, contact, state, reach, work):
    """Write all points of a contact into work.touches, also hidden ones; return how many."""
    solid, pose = system.solids[contact.solid], work.solid_pose
    x, q = pose_of(solid, contact.body, state)
    pose[0, 0], pose[0, 1], pose[0, 2] = x
    pose[0, 3], pose[0, 4], pose[0, 5], pose[0, 6] = q
    if on_half_space(contact):
        plane, a = Plane(contact.axes[0], contact.offset), Placed(solid, pose[0, :3], pose[0, 3:])
        plane_unit(a, plane, system.hulls, reach, work.pair, work.touches)
    else:
        list_on_solid(system, contact, contact.other_solid, state, reach, work)
    return work.pair.state[0].total


@kernel
def smaller(contact):
    """Return the size of the smaller of two bodies, or that of the one."""
    if on_half_space(contact):
        return contact.extent
    return min(contact.extent, contact.other_extent)


@kernel
def tangents(n0, n1, n2, axes):
    """Write rows n, t1, t2: t1 is the tangent part of world x, or of y if n is near x; t2 = n x t1.

    The axis with the least component along n is not used: if two are equal, round-off would decide each time.
    """
    e0, e1, e2 = (1.0, 0.0, 0.0) if abs(n0) < 0.8 else (0.0, 1.0, 0.0)
    d = e0 * n0 + e1 * n1 + e2 * n2
    t0, t1, t2 = e0 - d * n0, e1 - d * n1, e2 - d * n2
    s = 1.0 / math.sqrt(t0 * t0 + t1 * t1 + t2 * t2)
    t0, t1, t2 = s * t0, s * t1, s * t2
    axes[0, 0], axes[0, 1], axes[0, 2] = n0, n1, n2
    axes[1, 0], axes[1, 1], axes[1, 2] = t0, t1, t2
    axes[2, 0], axes[2, 1], axes[2, 2] = cross(n0, n1, n2, t0, t1, t2)


@kernel
def turned_axes(n, e, axes):
    """Write rows n, t1, t2: t1 and t2 are e[1] and e[2] after the shortest turn from e[0] to n.

    They change steadily with n, so that a slip keeps its direction; only at n = -e[0] is the turn not unique.
    """
    e0, e1 = (e[0, 0], e[0, 1], e[0, 2]), (e[1, 0], e[1, 1], e[1, 2])
    divisor = 1.0 + dot(n, e0)
    f = -dot(n, e1) / divisor if divisor > 0.0 else 0.0
    t = plus(plus(e1, f, n), f, e0)
    s = 1.0 / math.sqrt(dot(t, t))
    axes[0, 0], axes[0, 1], axes[0, 2] = n[0], n[1], n[2]
    axes[1, 0], axes[1, 1], axes[1, 2] = s * t[0], s * t[1], s * t[2]
    axes[2, 0], axes[2, 1], axes[2, 2] = cross(n[0], n[1], n[2], s * t[0], s * t[1], s * t[2])


@kernel
def write_touch(contact, touch, state, point):
    """Write a found point as a contact point."""
    n, e = touch.normal, contact.axes[0]
    point.a, point.b, point.gap, point.motion = contact.body, contact.other, touch.gap, MOTION_POINT
    point.owner, point.parts[0], point.parts[1] = touch.owner, touch.parts[0], touch.parts[1]
    carry_field(contact, point)
    if contact.static == 1:
        point.b = STATIC
    for k in range(3):
        point.arm_a[k] = touch.on_a[k] - state[contact.body].x[k]
        point.core[k] = 0.0  # `drift` gives the change of the velocity at the point
        if contact.other >= 0:
            point.arm_b[k] = touch.on_b[k] - state[contact.other].x[k]
        elif contact.static == 1:
            point.arm_b[k] = touch.on_b[k]
    if contact.static == 1 and e[0] * e[0] + e[1] * e[1] + e[2] * e[2] > 0.0:
        point.b = -1  # on curved ground points last, as on a plane: their events are located
        turned_axes(n, contact.axes, point.axes)
        return
    beyond = contact.surface > 0 and not n[0] * e[0] + n[1] * e[1] + n[2] * e[2] > 1.0 - ROUND_OFF
    if beyond or not on_half_space(contact):
        tangents(n[0], n[1], n[2], point.axes)
    else:
        for k in range(3):
            for i in range(3):
                point.axes[i, k] = contact.axes[i, k]
    if contact.axis_of != 0:
        lay_along_axis(contact, state, point)


@kernel
def own_point(contact, touch, state, p):
    """Write the position of a found point on the first body, in axes of that body."""
    q, x, s = state[contact.body].Q, state[contact.body].x, touch.on_a
    r = rotate_back(q, (s[0] - x[0], s[1] - x[1], s[2] - x[2]))
    p[0], p[1], p[2] = r


@kernel
def which_touch(system, contact, feature, p, state, work):
    """Return the point that has the feature; if none has it any more, the one nearest to the core point p."""
    q, x = state[contact.body].Q, state[contact.body].x
    r = rotate(q, p)
    best, chosen = math.inf, 0
    for i in range(work.pair.state[0].total):
        touch = work.touches[i]
        if same_point(system, contact, touch, feature, p, state):
            return i
        d = 0.0
        for k in range(3):
            d += (touch.on_a[k] - x[k] - r[k]) ** 2
        if d < best:
            best, chosen = d, i
    return chosen


@unit
def touch_of_active(system, contact, feature, p, state, work) -> int:
    """Write the points of a contact, and return the one that has a feature, or that replaces it.

    A point of a level surface that has passed its rim is replaced by one of the solid that it has left.
    """
    if on_curved_ground(system, contact):
        a, b = placed(system, contact, contact.other_solid, state, work)
        feature_on_surface(a, b, system.hulls, feature, work.pair, work.touches)
        return 0
    list_touches(system, contact, state, ACTIVE_REACH * smaller(contact), work)
    i = which_touch(system, contact, feature, p, state, work)
    if contact.surface == 0:
        return i
    solid = solid_left(system, contact, work.touches[i].on_b)
    if solid < 0:
        return i
    list_on_solid(system, contact, solid, state, ACTIVE_REACH * smaller(contact), work)
    return which_touch(system, contact, feature, p, state, work)


@kernel
def placed(system, contact, other_solid, state, work):
    """Return the solid of a body and another one with their poses, which are written to work.solid_pose."""
    pose, solid, other = work.solid_pose, system.solids[contact.solid], system.solids[other_solid]
    x, q = pose_of(solid, contact.body, state)
    pose[0, 0], pose[0, 1], pose[0, 2] = x
    pose[0, 3], pose[0, 4], pose[0, 5], pose[0, 6] = q
    x, q = pose_of(other, contact.other, state)
    pose[1, 0], pose[1, 1], pose[1, 2] = x
    pose[1, 3], pose[1, 4], pose[1, 5], pose[1, 6] = q
    return Placed(solid, pose[0, :3], pose[0, 3:]), Placed(other, pose[1, :3], pose[1, 3:])


@kernel
def list_on_solid(system, contact, other_solid, state, reach, work):
    """Write the points of a body, whose pose is in work.solid_pose, and another solid into work.touches."""
    pose, other = work.solid_pose, system.solids[other_solid]
    x, q = pose_of(other, contact.other, state)
    pose[1, 0], pose[1, 1], pose[1, 2] = x
    pose[1, 3], pose[1, 4], pose[1, 5], pose[1, 6] = q
    a = Placed(system.solids[contact.solid], pose[0, :3], pose[0, 3:])
    b = Placed(other, pose[1, :3], pose[1, 3:])
    touch_unit(a, b, system.hulls, reach, work.pair, work.touches)


@kernel
def touch_rate(contact, touch, state):
    """Return the rate of the gap at a found point."""
    n, x, p = touch.normal, state[contact.body].x, touch.on_a
    u = point_velocity(state, contact.body, p[0] - x[0], p[1] - x[1], p[2] - x[2])
    if contact.other >= 0:
        x, p = state[contact.other].x, touch.on_b
        u = minus(u, point_velocity(state, contact.other, p[0] - x[0], p[1] - x[1], p[2] - x[2]))
    return dot(n, u)


@unit
def drift(system, contact, feature, point, state) -> tuple[float, float, float]:
    """Return (d/dt G) v, contact axes: the change of the velocity at the point for constant velocities.

    The point must have been written for this state (`write_touch`). For two solids `feature` is not used.
    """
    plane = on_half_space(contact)
    solid = solid_beyond(system, contact, point, state) if plane else contact.other_solid
    if solid >= 0 and system.solids[solid].kind == CURVED_GROUND:
        return drift_on_surface(system, contact, point, state)
    curve = system.solids[contact.solid].kind == PROFILE
    if curve or (solid >= 0 and system.solids[solid].kind == PROFILE):
        return drift_of_profile(system, contact, solid, point, state)
    if solid < 0:
        return roll_on_plane(system, contact, feature, point, state)
    return drift_of_solids(system, contact, solid, point, state)
