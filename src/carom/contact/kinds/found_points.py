"""Contact points that are found anew in each state, in the form that the rest of the library uses.

They belong to two bodies, or to a curved body and a half-space (then the other body is -1).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.collision.features import OF_A, OF_B
from carom.collision.layout import POINT, Placed
from carom.collision.touch import touch_unit
from carom.contact.kinds.partner import on_half_space, pose_of
from carom.contact.kinds.rim import same_point
from carom.contact.point_axes import tangents, turned_axes
from carom.geometry.rotation import rotate, rotate_back
from carom.geometry.thresholds import ROUND_OFF
from carom.geometry.vectors import dot, minus, plus
from carom.kinematics.anisotropy import lay_along_axis
from carom.kinematics.contact_point import carry_field
from carom.kinematics.flexible import (
    displacement,
    gradient,
    greatest_deflection,
    in_body,
    in_world,
    ringing,
    write_shapes,
)
from carom.kinematics.wrench import point_velocity
from carom.model.parts_of_system import has_modes
from carom.model.workspace import MOTION_POINT, STATIC


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
    """Write the points of a body and another solid into work.touches; return how many."""
    a, b = placed(system, contact, other_solid, state, work)
    touch_unit(a, b, system.hulls, further(system, contact, state, reach), work.pair, work.touches)
    bend(system, contact, state, work)
    return work.pair.state[0].total


@kernel
def further(system, contact, state, reach):
    """Return how far above the least gap points of the undeformed bodies are sought: modes move both ends."""
    if contact.bends == 0:
        return reach
    return reach + 2.0 * greatest_deflection(system, contact.body, contact.other, state)


@kernel
def bend(system, contact, state, work):
    """Move the found points with the modes of both bodies, along the normal of the undeformed ones."""
    if contact.bends == 1:
        for i in range(work.pair.state[0].total):
            bend_unit(system, contact, state, work.touches[i])


@unit(where=has_modes, otherwise=None)
def bend_unit(system, contact, state, touch):
    """Move one found point, and write its places on the undeformed bodies."""
    n, touch.ringing = touch.normal, 0.0
    for side in range(2):
        b, sign = (contact.body, 1.0) if side == 0 else (contact.other, -1.0)
        on, place = (touch.on_a, touch.place_a) if side == 0 else (touch.on_b, touch.place_b)
        if b < 0 or system.bodies[b].modes == 0:
            continue
        x = state[b].x
        r = in_body(system, b, state, (on[0] - x[0], on[1] - x[1], on[2] - x[2]))
        place[0], place[1], place[2] = r
        write_shapes(system, b, place)
        d, v = displacement(system, b, state), ringing(system, b, state)
        for k in range(3):
            on[k] += d[k]
        touch.gap += sign * dot(n, d)
        touch.ringing += sign * dot(n, v)
    if on_half_space(contact):
        for k in range(3):
            touch.on_b[k] = touch.on_a[k] - touch.gap * n[k]
    else:
        tilt(system, contact, state, touch)


@kernel
def tilt(system, contact, state, touch):
    """Turn the normal with the bent face that has it: to n - grad h, made unit; h = n . R Phi eta.

    So n . (v_a - v_b) is the rate of the gap where a point slides along a bent face. A ball touches elsewhere.
    """
    n, turned = touch.normal, (0.0, 0.0, 0.0)
    for side in range(2):
        b, place = (contact.body, touch.place_a) if side == 0 else (contact.other, touch.place_b)
        if b < 0 or system.bodies[b].modes == 0:
            continue
        other = system.solids[contact.other_solid if side == 0 else contact.solid]
        owns = touch.owner == (OF_A if side == 0 else OF_B)
        if not (owns or other.kind == POINT):
            continue
        g = gradient(system, b, place, state, in_body(system, b, state, n))
        g = in_world(system, b, state, g)
        along = dot(n, g)
        turned = plus(turned, -1.0, (g[0] - along * n[0], g[1] - along * n[1], g[2] - along * n[2]))
    if turned[0] == 0.0 and turned[1] == 0.0 and turned[2] == 0.0:
        return
    m = plus(turned, 1.0, n)
    s = 1.0 / math.sqrt(dot(m, m))
    for side in range(2):
        solid = system.solids[contact.solid if side == 0 else contact.other_solid]
        on, sign = (touch.on_a, -1.0) if side == 0 else (touch.on_b, 1.0)
        if solid.kind == POINT:
            for k in range(3):
                on[k] += sign * solid.radius * (s * m[k] - n[k])
    n[0], n[1], n[2] = s * m[0], s * m[1], s * m[2]


@kernel
def nearest_touch(work):
    """Return the point in work.touches with the least gap."""
    nearest = work.touches[0]
    for i in range(1, work.pair.state[0].total):
        if work.touches[i].gap < nearest.gap:
            nearest = work.touches[i]
    return nearest


@kernel
def write_touch(contact, touch, state, point):
    """Write a found point as a contact point."""
    n, e = touch.normal, contact.axes[0]
    point.a, point.b, point.gap, point.motion = contact.body, contact.other, touch.gap, MOTION_POINT
    point.owner, point.parts[0], point.parts[1] = touch.owner, touch.parts[0], touch.parts[1]
    point.bends = contact.bends
    if contact.bends == 1:
        for k in range(3):
            point.place_a[k], point.place_b[k] = touch.place_a[k], touch.place_b[k]
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


@kernel
def touch_rate(contact, touch, state):
    """Return the rate of the gap at a found point."""
    n, x, p = touch.normal, state[contact.body].x, touch.on_a
    u = point_velocity(state, contact.body, p[0] - x[0], p[1] - x[1], p[2] - x[2])
    if contact.other >= 0:
        x, p = state[contact.other].x, touch.on_b
        u = minus(u, point_velocity(state, contact.other, p[0] - x[0], p[1] - x[1], p[2] - x[2]))
    return dot(n, u) if contact.bends == 0 else dot(n, u) + touch.ringing
