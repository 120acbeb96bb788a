"""Rims of cylinders and discs that lie nearly flat on a surface: their lowest point moves fast around the rim.

The lowest point of a rim of radius r has the same feature at all positions. At a small tilt it moves along the
rim much faster than the body turns; when the rim passes through the flat position, the point jumps to the other
side. There a step is shortened until it can follow the point. If the time would be negligible against the step,
the rim counts as flat, and all its points strike together.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.layout import CYLINDER
from carom.contact.kinds.partner import on_half_space
from carom.contact.thresholds import FLAT_RIM, RIM_DISTANCE
from carom.geometry.rotation import norm, rotate, rotate_back


@kernel
def in_solid(solid, contact, side, state, n):
    """Return a world vector in axes of the solid of the body (side 0), or of the other solid (1)."""
    s, a = solid.Q, (n[0], n[1], n[2])
    if side == 0 or contact.static == 0:
        q = state[contact.body if side == 0 else contact.other].Q
        a = rotate_back(q, n)
    return rotate_back(s, a)


@kernel
def flat_rim(system, contact, n, state):
    """Return radius and tilt (a sine) of a rim that is nearly flat on a surface with the normal n.

    The radius is 0 if there is no such rim.
    """
    for side in range(1 if on_half_space(contact) else 2):
        solid = system.solids[contact.solid if side == 0 else contact.other_solid]
        if solid.kind == CYLINDER:
            x, y, z = in_solid(solid, contact, side, state, n)
            if 1.0 - z * z < FLAT_RIM * FLAT_RIM:
                return solid.half[0], math.sqrt(x * x + y * y)  # exact for a small tilt, too
    return 0.0, 0.0


@kernel
def way_round(system, contact, n, arm, p, state):
    """Return the squared distance from p (body axes) to an arm (world), relative to r; 0 for a steep rim."""
    radius, _ = flat_rim(system, contact, n, state)
    if radius == 0.0:
        return 0.0
    q = state[contact.body].Q
    r = rotate(q, p)
    d = (arm[0] - r[0]) ** 2 + (arm[1] - r[1]) ** 2 + (arm[2] - r[2]) ** 2
    return d / (radius * radius)


@kernel
def way_to(system, contact, touch, p, state):
    """Return `way_round` from p to a found point."""
    x, s = state[contact.body].x, touch.on_a
    arm = (s[0] - x[0], s[1] - x[1], s[2] - x[2])
    return way_round(system, contact, touch.normal, arm, p, state)


@kernel
def same_point(system, contact, touch, feature, p, state):
    """Return whether a found point is the point with this feature that was at p (body axes)."""
    return touch.feature == feature and way_to(system, contact, touch, p, state) < RIM_DISTANCE


@kernel
def place_of(system, active, c, touch, state):
    """Return the place of a found point of contact c among the active points, -1 if it is not active."""
    for i in range(active.count[0]):
        one = active.points[i]
        if one.contact == c:
            if same_point(system, system.contacts[c], touch, one.feature, one.point, state):
                return i
    return -1


@kernel
def longest_way(system, data, c):
    """Return the largest `way_round` of a trial step from the active points of a contact to those found."""
    longest, work = 0.0, data.work
    for j in range(data.active.count[0]):
        one = data.active.points[j]
        for i in range(work.pair.state[0].total if one.contact == c else 0):
            touch = work.touches[i]
            if touch.feature == one.feature:
                distance = way_to(system, system.contacts[c], touch, one.point, work.trial)
                longest = max(longest, distance)
    return longest


@kernel
def closed_rim(system, contact, n, state, time):
    """Return the greatest gap of a rim whose spin can make it flat within `time`; 0 if there is none."""
    radius, tilt = flat_rim(system, contact, n, state)
    if radius == 0.0:
        return 0.0
    spin = 0.0
    for k in range(3):
        w = state[contact.body].w[k]
        if contact.other >= 0:
            w -= state[contact.other].w[k]
        spin += w * w
    return 2.0 * radius * tilt if tilt < time * math.sqrt(spin) else 0.0


@kernel
def most_of_rim(contact, state, time):
    """Return an upper bound of `closed_rim`, with the size of the body in the place of its radius."""
    spin = norm(state[contact.body].w)
    if contact.other >= 0:
        spin += norm(state[contact.other].w)
    return 2.0 * max(contact.extent, contact.other_extent) * time * spin
