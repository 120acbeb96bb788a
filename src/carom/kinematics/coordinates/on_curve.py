"""Arc length along a curve, with its tangent at the foot as the axis (`carom.kinematics.curve`)."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross
from carom.kinematics.curve import (
    can_be_left,
    find_foot,
    foot_of,
    is_upright,
    rail_drift,
    relative_bias,
    speed_beside,
)
from carom.kinematics.joints import anchor_speed, child_arm, parent_arm
from carom.kinematics.thresholds import RAIL_TRAVEL, TURN_OF_STEP
from carom.model.workspace import MOTION_POINT


@kernel
def slides(c):
    """Return True."""
    return True


@kernel
def along(system, c, state):
    """Return the tangent at the foot."""
    find_foot(system, c, state)
    a = foot_of(system, c).along
    return a[0], a[1], a[2]


@kernel
def value(system, c, state):
    """Return the coordinate of the foot [m]."""
    find_foot(system, c, state)
    return foot_of(system, c).s


@kernel
def drift(system, c, state, out):
    """Return q'' for bodies without acceleration."""
    ax, ay, az = along(system, c, state)
    lx, ly, lz = relative_bias(c, state)
    return -(ax * lx + ay * ly + az * lz)


@kernel
def counts_turns(c):
    """Return False."""
    return False


@kernel
def speed_along(system, c, state):
    """Return the speed of the foot."""
    ax, ay, az = along(system, c, state)
    ux, uy, uz = anchor_speed(c, state)
    return ax * ux + ay * uy + az * uz


@kernel
def turn_within(system, c, start, end, h):
    """Return how far the direction of the curve may turn in a step, so that the foot is found.

    Above a rail that can be left, the point may reach it (its gap is that at the end).
    """
    turn = h * max(abs(speed_along(system, c, start)), abs(speed_along(system, c, end)))
    one, foot = system.relations.curves[c.number], foot_of(system, c)
    if can_be_left(one):
        travel = h * max(speed_beside(c, start), speed_beside(c, end))
        far = travel < foot.gap[1] and not is_upright(system.relations.curve_pieces[one.first])
        turn = 0.0 if far else TURN_OF_STEP / RAIL_TRAVEL * travel
    return turn * one.sharpest


@kernel
def has_face(system, c):
    """Return whether it is that of a rail that can be left, whose contact is its stop."""
    return can_be_left(system.relations.curves[c.number])


@kernel
def place_face(system, contact, c, state, point):
    """Write the contact point of a rail at the foot: normal, tangent, and across the plane."""
    find_foot(system, c, state)
    foot = foot_of(system, c)
    n, across, r, s = foot.normal[1], foot.normal[0], child_arm(c, state), parent_arm(c, state)
    t = cross(across[0], across[1], across[2], n[0], n[1], n[2])
    point.a, point.b, point.gap = contact.body, contact.other, foot.gap[1]
    point.motion, point.length, point.moves = MOTION_POINT, 1.0, 0
    for k in range(3):
        point.core[k], point.arm_a[k], point.arm_b[k] = 0.0, r[k], s[k]
        point.axes[0, k], point.axes[1, k], point.axes[2, k] = n[k], t[k], across[k]


@kernel
def face_drift(system, c, state):
    """Return (d/dt G) v of this point."""
    find_foot(system, c, state)
    return rail_drift(c, foot_of(system, c), state)
