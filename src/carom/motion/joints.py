"""Joints as six numbers: the relative motion of the two sides, angular and linear, in world axes.

A joint between a point of the parent (arm r_p from its centre) and one of the child (arm r_c):

    relative angular velocity   w_c - w_p
    relative linear velocity    (v_c + w_c x r_c) - (v_p + w_p x r_p)

A joint leaves some of these six free (its freedoms S) and constrains the others. The constrained
part of (relative acceleration - bias) vanishes; `position_error`, `velocity_error` and
`acceleration_bias` fill the bias for the three levels. Arms are used, never differences of centres, so that all
stays right a little off the manifold (stages of a Runge-Kutta step).
"""

from __future__ import annotations

import math

from carom.geometry.rotation import cross, rotate
from carom.jit import kernel
from carom.system.arrays import DISTANCE, FIXED, KNIFE_EDGE, PRISMATIC, REVOLUTE, SPHERICAL


@kernel
def arm(Q, b, local, j):
    """Return `local[j]`, given in the axes of body b (-1: the ground), in world axes."""
    if b < 0:
        return local[j, 0], local[j, 1], local[j, 2]
    return rotate(Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3], local[j, 0], local[j, 1], local[j, 2])


@kernel
def axis(Q, b, frame, j, k):
    """Return column k of `frame[j]`, given in the axes of body b (-1: the ground), in world axes."""
    if b < 0:
        return frame[j, 0, k], frame[j, 1, k], frame[j, 2, k]
    return rotate(
        Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3], frame[j, 0, k], frame[j, 1, k], frame[j, 2, k]
    )


@kernel
def anchor_gap(joints, j, x, Q):
    """Return the child's anchor minus the parent's anchor (3)."""
    c, p = joints.child[j], joints.parent[j]
    cx, cy, cz = arm(Q, c, joints.child_anchor, j)
    px, py, pz = arm(Q, p, joints.parent_anchor, j)
    if p >= 0:
        px, py, pz = px + x[p, 0], py + x[p, 1], pz + x[p, 2]
    return x[c, 0] + cx - px, x[c, 1] + cy - py, x[c, 2] + cz - pz


@kernel
def parent_arm(joints, j, x, Q):
    """Return the arm r_p of the parent (3), world; from the origin if the parent is the ground.

    Where the joint slides it reaches to the point of the parent that now lies at the child's anchor.
    """
    p = joints.parent[j]
    if joints.kind[j] == PRISMATIC:
        c = joints.child[j]
        rx, ry, rz = arm(Q, c, joints.child_anchor, j)
        rx, ry, rz = rx + x[c, 0], ry + x[c, 1], rz + x[c, 2]
        if p >= 0:
            rx, ry, rz = rx - x[p, 0], ry - x[p, 1], rz - x[p, 2]
        return rx, ry, rz
    return arm(Q, p, joints.parent_anchor, j)


@kernel
def anchor_speed(joints, j, x, Q, v, w):
    """Return the velocity of the child's anchor minus that of the parent's (3)."""
    c, p = joints.child[j], joints.parent[j]
    rx, ry, rz = arm(Q, c, joints.child_anchor, j)
    ux, uy, uz = cross(w[c, 0], w[c, 1], w[c, 2], rx, ry, rz)
    ux, uy, uz = ux + v[c, 0], uy + v[c, 1], uz + v[c, 2]
    if p >= 0:
        rx, ry, rz = parent_arm(joints, j, x, Q)
        sx, sy, sz = cross(w[p, 0], w[p, 1], w[p, 2], rx, ry, rz)
        ux, uy, uz = ux - v[p, 0] - sx, uy - v[p, 1] - sy, uz - v[p, 2] - sz
    return ux, uy, uz


@kernel
def turn_error(joints, j, Q):
    """Return the rotation vector (world) by which the child is turned against the parent, as far as
    the joint forbids it: the sine of the tilt for a revolute joint, all of it for a fixed one."""
    kind = joints.kind[j]
    c, p = joints.child[j], joints.parent[j]
    if kind == REVOLUTE:
        ax, ay, az = axis(Q, p, joints.parent_frame, j, 0)
        bx, by, bz = axis(Q, c, joints.child_frame, j, 0)
        return cross(ax, ay, az, bx, by, bz)
    ex, ey, ez = 0.0, 0.0, 0.0
    if kind == FIXED or kind == PRISMATIC:
        # half the sum of e_p x e_c over the three axes: the rotation vector to first order,
        # zero only where the frames agree (or are half a turn apart, excluded at the start)
        for k in range(3):
            ax, ay, az = axis(Q, p, joints.parent_frame, j, k)
            bx, by, bz = axis(Q, c, joints.child_frame, j, k)
            sx, sy, sz = cross(ax, ay, az, bx, by, bz)
            ex, ey, ez = ex + 0.5 * sx, ey + 0.5 * sy, ez + 0.5 * sz
    return ex, ey, ez


@kernel
def position_error(joints, j, x, Q, out):
    """Write the error of position: out[j] = (turn error, anchor gap)."""
    out[j, 0], out[j, 1], out[j, 2] = turn_error(joints, j, Q)
    dx, dy, dz = anchor_gap(joints, j, x, Q)
    kind = joints.kind[j]
    if kind == DISTANCE:
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        f = (length - joints.length[j]) / length
        dx, dy, dz = f * dx, f * dy, f * dz
    elif kind == KNIFE_EDGE:
        dx, dy, dz = 0.0, 0.0, 0.0
    out[j, 3], out[j, 4], out[j, 5] = dx, dy, dz


@kernel
def velocity_error(joints, j, x, Q, v, w, out):
    """Write the relative velocity of the two sides: out[j] = (angular, linear)."""
    c, p = joints.child[j], joints.parent[j]
    for k in range(3):
        out[j, k] = w[c, k] - (w[p, k] if p >= 0 else 0.0)
    out[j, 3], out[j, 4], out[j, 5] = anchor_speed(joints, j, x, Q, v, w)


@kernel
def acceleration_bias(joints, j, x, Q, v, w, out):
    """Write the bias of the relative acceleration: out[j] = (angular, linear).

    Angular: an axis that turns with the parent, w_p x (a qd) = w_p x w_c. Linear: centripetal
    accelerations of the two anchors, w_p x (w_p x r_p) - w_c x (w_c x r_c). A distance adds
    -|u_perp|^2/d along the line, a sliding joint 2 w_p x u, the knife edge the turning of its own row.
    """
    c, p = joints.child[j], joints.parent[j]
    kind = joints.kind[j]
    rx, ry, rz = arm(Q, c, joints.child_anchor, j)
    tx, ty, tz = cross(w[c, 0], w[c, 1], w[c, 2], rx, ry, rz)
    sx, sy, sz = cross(w[c, 0], w[c, 1], w[c, 2], tx, ty, tz)
    lx, ly, lz = -sx, -sy, -sz
    ax, ay, az = 0.0, 0.0, 0.0
    wx, wy, wz = 0.0, 0.0, 0.0
    if p >= 0:
        wx, wy, wz = w[p, 0], w[p, 1], w[p, 2]
        rx, ry, rz = parent_arm(joints, j, x, Q)
        tx, ty, tz = cross(wx, wy, wz, rx, ry, rz)
        sx, sy, sz = cross(wx, wy, wz, tx, ty, tz)
        lx, ly, lz = lx + sx, ly + sy, lz + sz
        if kind == REVOLUTE:
            ax, ay, az = cross(wx, wy, wz, w[c, 0], w[c, 1], w[c, 2])
        elif kind == PRISMATIC:
            ux, uy, uz = anchor_speed(joints, j, x, Q, v, w)
            sx, sy, sz = cross(wx, wy, wz, 2.0 * ux, 2.0 * uy, 2.0 * uz)
            lx, ly, lz = lx + sx, ly + sy, lz + sz
    if kind == DISTANCE:
        dx, dy, dz = anchor_gap(joints, j, x, Q)
        ux, uy, uz = anchor_speed(joints, j, x, Q, v, w)
        d2 = dx * dx + dy * dy + dz * dz
        along = (dx * ux + dy * uy + dz * uz) / d2
        # (u.u - (u.d)^2/d^2)/d^2 times d, so that its part along d/|d| is |u_perp|^2/|d|
        f = (ux * ux + uy * uy + uz * uz) / d2 - along * along
        lx, ly, lz = lx - f * dx, ly - f * dy, lz - f * dz
    elif kind == KNIFE_EDGE:
        # row e fixed in the child: e . a + (w x e) . u = 0, written as a linear bias along e
        ex, ey, ez = axis(Q, c, joints.child_frame, j, 1)
        ux, uy, uz = anchor_speed(joints, j, x, Q, v, w)
        tx, ty, tz = cross(w[c, 0], w[c, 1], w[c, 2], ex, ey, ez)
        f = tx * ux + ty * uy + tz * uz
        lx, ly, lz = lx - f * ex, ly - f * ey, lz - f * ez
    out[j, 0], out[j, 1], out[j, 2] = ax, ay, az
    out[j, 3], out[j, 4], out[j, 5] = lx, ly, lz
