"""Coordinates of joints: an angle about, or a displacement along, an axis of the parent; values and rates.

    q' = t_a . (w_c - w_p) + t_l . (velocity of the child's anchor minus that of the parent at this point)

What is stated here is that of angles; displacements, arc lengths along curves and the angles of a ball joint,
which stops limit, have their forms in the files of `carom.kinematics.coordinates`, by the same names.
An angle is known up to whole turns; the result is the value nearest to `reference`, the value at the start of
the trial step, which is short enough for this (`carom.dynamics.more_forces.turns_round`). Either side may be
the ground (the second angle of a universal joint is measured from the child).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross
from carom.kinematics.coordinates import by_coordinate
from carom.kinematics.coordinates.turns import angular_velocity, with_turns
from carom.kinematics.joints import anchor_speed, axis, child_arm, parent_arm
from carom.kinematics.wrench import add_force


@by_coordinate
def slides(c):
    """Return whether a coordinate is a displacement, not an angle."""
    return False


@by_coordinate
def along(system, c, state):
    """Return the axis along, or about, which a coordinate grows."""
    return axis(state, c.parent, c.parent_frame, 0)


@by_coordinate
def value(system, c, state):
    """Return the coordinate: an angle [rad] or a displacement [m], 0 if the frames of both sides agree."""
    bx, by, bz = axis(state, c.child, c.child_frame, 1)
    px, py, pz = axis(state, c.parent, c.parent_frame, 1)
    qx, qy, qz = axis(state, c.parent, c.parent_frame, 2)
    angle = math.atan2(qx * bx + qy * by + qz * bz, px * bx + py * by + pz * bz)
    return with_turns(system, c, angle)


@by_coordinate
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


@by_coordinate
def drift(system, c, state, out):
    """Return q'' for bodies without acceleration; `out` is workspace (6,)."""
    ax, ay, az = along(system, c, state)
    wx, wy, wz = angular_velocity(state, c.child)
    px, py, pz = angular_velocity(state, c.parent)
    tx, ty, tz = cross(px, py, pz, ax, ay, az)
    return tx * (wx - px) + ty * (wy - py) + tz * (wz - pz)


@by_coordinate
def counts_turns(c):
    """Return whether the value has whole turns, which a run counts."""
    return True


@by_coordinate
def turns_with_place(c):
    """Return whether a displacement turns its direction: a distance from a point or a line."""
    return False


@by_coordinate
def has_face(system, c):
    """Return whether what limits a coordinate touches at a point, which has friction: rails, pins in bushes."""
    return False


@by_coordinate
def place_face(system, contact, c, state, point):
    """Write this point, its axes and its gap."""


@by_coordinate
def face_drift(system, c, state):
    """Return (d/dt G) v of this point."""
    return 0.0, 0.0, 0.0


@by_coordinate
def turn_within(system, c, start, end, h):
    """Return a bound of the angle of a step of length h, for which whole turns and feet must be known."""
    return h * max(abs(rate(system, c, start)), abs(rate(system, c, end)))


@by_coordinate
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


@by_coordinate
def motion_along(system, c, state, work):
    """Return the change of q' by the motions that the last solve wrote."""
    axis, total = along(system, c, state), 0.0
    if c.child >= 0:
        total += of_side(c, 0, axis, six(work.body[c.child].motion), state)
    if c.parent >= 0:
        total += of_side(c, 1, axis, six(work.body[c.parent].motion), state)
    return total


@by_coordinate
def acceleration_along(system, c, state, stage):
    """Return q'' by the accelerations of a stage alone, without its drift."""
    axis, total = along(system, c, state), 0.0
    if c.child >= 0:
        total += of_side(c, 0, axis, six(stage[c.child].rate), state)
    if c.parent >= 0:
        total += of_side(c, 1, axis, six(stage[c.parent].rate), state)
    return total


@by_coordinate
def rate_in(system, c, pose, state):
    """Return q' with the positions of one state and the velocities of another."""
    axis, total = along(system, c, pose), 0.0
    if c.child >= 0:
        total += of_side(c, 0, axis, velocity(state[c.child]), pose)
    if c.parent >= 0:
        total += of_side(c, 1, axis, velocity(state[c.parent]), pose)
    return total


@kernel
def six(motion):
    """Return the six numbers of a motion."""
    return motion[0], motion[1], motion[2], motion[3], motion[4], motion[5]


@kernel
def velocity(body):
    """Return the velocity of a body, linear and angular."""
    v, w = body.v, body.w
    return v[0], v[1], v[2], w[0], w[1], w[2]


@kernel
def of_side(c, side, axis, motion, state):
    """Return the part of q' or q'' that a motion (linear, angular) of the child, or of the parent, has."""
    ux, uy, uz = motion[3], motion[4], motion[5]
    if slides(c):
        rx, ry, rz = child_arm(c, state) if side == 0 else parent_arm(c, state)
        ux, uy, uz = cross(ux, uy, uz, rx, ry, rz)
        ux, uy, uz = ux + motion[0], uy + motion[1], uz + motion[2]
    s = 1.0 if side == 0 else -1.0
    return s * (axis[0] * ux + axis[1] * uy + axis[2] * uz)


@by_coordinate
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
