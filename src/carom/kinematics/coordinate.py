"""Coordinates of joints: an angle about, or a displacement along, an axis of the parent; values and rates.

    q' = t_a . (w_c - w_p) + t_l . (velocity of the child's anchor minus that of the parent at this point)

A displacement may be along a curve (`carom.kinematics.curve`), with its tangent as the axis.
An angle is known up to whole turns; the result is the value nearest to `reference`, the value at the start of
the trial step, which is short enough for this (`carom.dynamics.more_forces.turns_round`). Either side may be
the ground (the second angle of a universal joint is measured from the child). The angles of a ball joint, which
stops limit, are in `carom.kinematics.ball`.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross
from carom.kinematics.ball import along_ball, drift_of_ball, value_of_ball
from carom.kinematics.curve import find_foot, is_on_curve, relative_bias
from carom.kinematics.joints import (
    acceleration_bias,
    anchor_gap,
    anchor_speed,
    axis,
    child_arm,
    parent_arm,
)
from carom.kinematics.wrench import add_force
from carom.model.arrays import PRISMATIC, ROTATION, TWIST

TURN = 2.0 * math.pi


@kernel
def angular_velocity(state, b):
    """Return the angular velocity of body b (-1: the ground)."""
    if b < 0:
        return 0.0, 0.0, 0.0
    w = state[b].w
    return w[0], w[1], w[2]


@kernel
def slides(c):
    """Return whether a coordinate is a displacement, not an angle."""
    return c.kind == PRISMATIC or is_on_curve(c)


@kernel
def along(system, c, state):
    """Return the axis along, or about, which a coordinate grows; that of a curve is its tangent at the foot."""
    if is_on_curve(c):
        find_foot(system, c, state)
        a = system.relations.curves[c.number].along
        return a[0], a[1], a[2]
    if c.kind >= ROTATION:
        return along_ball(c, state)
    return axis(state, c.parent, c.parent_frame, 0)


@kernel
def value(system, c, state):
    """Return the coordinate: an angle [rad] or a displacement [m], 0 if the frames of both sides agree."""
    ax, ay, az = along(system, c, state)
    if is_on_curve(c):
        return system.relations.curves[c.number].s
    if c.kind == PRISMATIC:
        dx, dy, dz = anchor_gap(c, state)
        return ax * dx + ay * dy + az * dz
    if c.kind >= ROTATION:
        angle = value_of_ball(c, state)
        if c.kind != TWIST:
            return angle
    else:
        bx, by, bz = axis(state, c.child, c.child_frame, 1)
        px, py, pz = axis(state, c.parent, c.parent_frame, 1)
        qx, qy, qz = axis(state, c.parent, c.parent_frame, 2)
        angle = math.atan2(qx * bx + qy * by + qz * bz, px * bx + py * by + pz * bz)
    return angle + TURN * math.floor((c.reference - angle) / TURN + 0.5)


@kernel
def rate(system, c, state):
    """Return q'."""
    ax, ay, az = along(system, c, state)
    if slides(c):
        ux, uy, uz = anchor_speed(c, state)
    else:
        wx, wy, wz = angular_velocity(state, c.child)
        px, py, pz = angular_velocity(state, c.parent)
        ux, uy, uz = wx - px, wy - py, wz - pz
    return ax * ux + ay * uy + az * uz


@kernel
def speed_of_turn(c, state):
    """Return the speed at which the child turns relative to the parent."""
    w, v = angular_velocity(state, c.child), angular_velocity(state, c.parent)
    x, y, z = w[0] - v[0], w[1] - v[1], w[2] - v[2]
    return math.sqrt(x * x + y * y + z * z)


@kernel
def drift(system, c, state, out):
    """Return q'' for bodies without acceleration; `out` is workspace (6,)."""
    ax, ay, az = along(system, c, state)
    if is_on_curve(c):
        lx, ly, lz = relative_bias(c, state)
        return -(ax * lx + ay * ly + az * lz)
    if c.kind == PRISMATIC:
        acceleration_bias(c, state, out)
        return -(ax * out[3] + ay * out[4] + az * out[5])
    wx, wy, wz = angular_velocity(state, c.child)
    px, py, pz = angular_velocity(state, c.parent)
    if c.kind >= ROTATION:
        return drift_of_ball(c, state, (wx, wy, wz), (px, py, pz))
    tx, ty, tz = cross(px, py, pz, ax, ay, az)
    return tx * (wx - px) + ty * (wy - py) + tz * (wz - pz)


@kernel
def push(system, c, state, force, work):
    """Add the wrenches of a force [N] or torque [N m] along the coordinate to both bodies."""
    ax, ay, az = along(system, c, state)
    fx, fy, fz = force * ax, force * ay, force * az
    if slides(c):
        rx, ry, rz = child_arm(c, state)
        add_force(work, c.child, (rx, ry, rz), (fx, fy, fz))
        rx, ry, rz = parent_arm(c, state)
        add_force(work, c.parent, (rx, ry, rz), (-fx, -fy, -fz))
        return
    for side in range(2):
        b, s = (c.child, 1.0) if side == 0 else (c.parent, -1.0)
        if b >= 0:
            wrench = work.body[b].wrench
            wrench[3] += s * fx
            wrench[4] += s * fy
            wrench[5] += s * fz


@kernel
def add_rows(system, c, state, factor, child, parent):
    """Add factor times the row of the coordinate to row 0 of `child` and `parent` (rows of the two sides)."""
    ax, ay, az = along(system, c, state)
    ax, ay, az = factor * ax, factor * ay, factor * az
    for side in range(2):
        b, A, s = (c.child, child, 1.0) if side == 0 else (c.parent, parent, -1.0)
        if b < 0:
            continue
        if slides(c):
            rx, ry, rz = child_arm(c, state) if side == 0 else parent_arm(c, state)
            tx, ty, tz = cross(rx, ry, rz, ax, ay, az)
            A[0, 0] += s * ax
            A[0, 1] += s * ay
            A[0, 2] += s * az
        else:
            tx, ty, tz = ax, ay, az
        A[0, 3] += s * tx
        A[0, 4] += s * ty
        A[0, 5] += s * tz


@kernel
def motion_along(system, c, state, work):
    """Return the change of q' by the motions that the last solve wrote."""
    ax, ay, az = along(system, c, state)
    total = 0.0
    for side in range(2):
        b, s = (c.child, 1.0) if side == 0 else (c.parent, -1.0)
        if b < 0:
            continue
        m = work.body[b].motion
        if slides(c):
            rx, ry, rz = child_arm(c, state) if side == 0 else parent_arm(c, state)
            ux, uy, uz = cross(m[3], m[4], m[5], rx, ry, rz)
            ux, uy, uz = ux + m[0], uy + m[1], uz + m[2]
        else:
            ux, uy, uz = m[3], m[4], m[5]
        total += s * (ax * ux + ay * uy + az * uz)
    return total


@kernel
def speeds_of(system, c, state):
    """Return a bound of the speeds of both sides, whose difference is q'."""
    total = 0.0
    for side in range(2):
        b = c.child if side == 0 else c.parent
        if b >= 0:
            v, w, size = state[b].v, state[b].w, system.bodies[b].extent
            speed = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
            spin = math.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
            total += speed + size * spin if slides(c) else spin + speed / size
    return total
