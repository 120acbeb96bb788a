"""Joints as six numbers: the relative motion of the two sides, angular and linear, in world axes.

A joint between a point of the parent (arm r_p from its centre) and one of the child (arm r_c):

    relative angular velocity   w_c - w_p
    relative linear velocity    (v_c + w_c x r_c) - (v_p + w_p x r_p)

A joint leaves some of these six free (its freedoms S) and constrains the others. The constrained
part of (relative acceleration - bias) vanishes; `position_error`, `velocity_error` and `acceleration_bias`
write the bias for the three levels. Only arms are used, never differences of centres, so that the results are
right also slightly off the manifold (stages of a Runge-Kutta step).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross, rotate
from carom.model.arrays import (
    BALL,
    CURVE_ON_POINT,
    DISTANCE,
    KNIFE_EDGE,
    RIGID,
    ROLLING,
    ROLLING_DISC,
    SCREW,
    SLIDING,
    TURNING,
    UNIVERSAL,
    WITHIN,
)


@kernel
def arm(state, b, local):
    """Return the vector `local`, given in the axes of body b (-1: the ground), in world axes."""
    if b < 0:
        return local[0], local[1], local[2]
    q = state[b].Q
    return rotate(q, local)


@kernel
def axis(state, b, frame, k):
    """Return column k of `frame`, given in the axes of body b (-1: the ground), in world axes."""
    if b < 0:
        return frame[0, k], frame[1, k], frame[2, k]
    q = state[b].Q
    return rotate(q, (frame[0, k], frame[1, k], frame[2, k]))


@kernel
def child_arm(joint, state):
    """Return the arm r_c of the child (3), world; for a rolling body it ends at the point on the plane.

    It is -r n for a sphere, and -r e for a disc, where n is the normal of the plane, a the axis of the disc,
    and e the unit vector along n - (n.a) a. That of a curve ends at the point of the parent.
    """
    if joint.kind == CURVE_ON_POINT:
        c, p = joint.child, joint.parent
        rx, ry, rz = arm(state, p, joint.parent_anchor)
        if p >= 0:
            rx, ry, rz = rx + state[p].x[0], ry + state[p].x[1], rz + state[p].x[2]
        return rx - state[c].x[0], ry - state[c].x[1], rz - state[c].x[2]
    if joint.kind not in ROLLING:
        return arm(state, joint.child, joint.child_anchor)
    nx, ny, nz = axis(state, joint.parent, joint.parent_frame, 0)
    if joint.kind == ROLLING_DISC:
        ax, ay, az = axis(state, joint.child, joint.child_frame, 1)
        f = nx * ax + ny * ay + nz * az
        nx, ny, nz = nx - f * ax, ny - f * ay, nz - f * az
    s = -joint.length / math.sqrt(nx * nx + ny * ny + nz * nz)
    return s * nx, s * ny, s * nz


@kernel
def rolling_bias(joint, state):
    """Return the linear bias from the change of the arms in rolling: w_p x r_p' - w_c x r_c' (3).

    r_c' = -r e', e' = (g' - (g'.e) e)/|g|, g = n - (n.a) a, n' = w_p x n, a' = w_c x a;
    r_p' = v_c + r_c' - v_p.
    """
    c, p = joint.child, joint.parent
    w, v = state[c].w, state[c].v
    px, py, pz = 0.0, 0.0, 0.0
    ux, uy, uz = v[0], v[1], v[2]
    if p >= 0:
        o = state[p].w
        px, py, pz = o[0], o[1], o[2]
        ux, uy, uz = ux - state[p].v[0], uy - state[p].v[1], uz - state[p].v[2]
    nx, ny, nz = axis(state, p, joint.parent_frame, 0)
    hx, hy, hz = cross(px, py, pz, nx, ny, nz)
    if joint.kind == ROLLING_DISC:
        ax, ay, az = axis(state, c, joint.child_frame, 1)
        bx, by, bz = cross(w[0], w[1], w[2], ax, ay, az)
        f = nx * ax + ny * ay + nz * az
        g = hx * ax + hy * ay + hz * az + nx * bx + ny * by + nz * bz
        nx, ny, nz = nx - f * ax, ny - f * ay, nz - f * az
        hx, hy, hz = hx - g * ax - f * bx, hy - g * ay - f * by, hz - g * az - f * bz
    s = 1.0 / math.sqrt(nx * nx + ny * ny + nz * nz)
    nx, ny, nz = s * nx, s * ny, s * nz
    f = hx * nx + hy * ny + hz * nz
    s *= -joint.length
    dx, dy, dz = s * (hx - f * nx), s * (hy - f * ny), s * (hz - f * nz)
    tx, ty, tz = cross(w[0], w[1], w[2], dx, dy, dz)
    sx, sy, sz = cross(px, py, pz, ux + dx, uy + dy, uz + dz)
    return sx - tx, sy - ty, sz - tz


@kernel
def anchor_gap(joint, state):
    """Return the child's anchor minus the parent's anchor (3)."""
    c, p = joint.child, joint.parent
    cx, cy, cz = child_arm(joint, state)
    px, py, pz = arm(state, p, joint.parent_anchor)
    if p >= 0:
        px, py, pz = px + state[p].x[0], py + state[p].x[1], pz + state[p].x[2]
    return state[c].x[0] + cx - px, state[c].x[1] + cy - py, state[c].x[2] + cz - pz


@kernel
def parent_arm(joint, state):
    """Return the arm r_p of the parent (3), world; from the origin if the parent is the ground.

    For a sliding joint it ends at the point of the parent that is now at the child's anchor.
    """
    p = joint.parent
    if joint.kind in SLIDING or joint.kind in ROLLING:
        c = joint.child
        rx, ry, rz = child_arm(joint, state)
        rx, ry, rz = rx + state[c].x[0], ry + state[c].x[1], rz + state[c].x[2]
        if p >= 0:
            rx, ry, rz = rx - state[p].x[0], ry - state[p].x[1], rz - state[p].x[2]
        return rx, ry, rz
    return arm(state, p, joint.parent_anchor)


@kernel
def anchor_speed(joint, state):
    """Return the velocity of the child's anchor minus that of the parent's (3)."""
    c, p = joint.child, joint.parent
    rx, ry, rz = child_arm(joint, state)
    ux, uy, uz = cross(state[c].w[0], state[c].w[1], state[c].w[2], rx, ry, rz)
    ux, uy, uz = ux + state[c].v[0], uy + state[c].v[1], uz + state[c].v[2]
    if p >= 0:
        rx, ry, rz = parent_arm(joint, state)
        sx, sy, sz = cross(state[p].w[0], state[p].w[1], state[p].w[2], rx, ry, rz)
        ux, uy, uz = ux - state[p].v[0] - sx, uy - state[p].v[1] - sy, uz - state[p].v[2] - sz
    return ux, uy, uz


@kernel
def turn_error(joint, state):
    """Return the forbidden part of the rotation vector (world) of the child relative to the parent.

    For a shared axis it is the sine of the tilt, for a rigid joint the whole rotation. For a universal joint it
    is minus a_1 . a_2 about n = a_1 x a_2, with n . (w_c - w_p) as its rate.
    """
    kind = joint.kind
    c, p = joint.child, joint.parent
    if kind in TURNING:
        ax, ay, az = axis(state, p, joint.parent_frame, 0)
        bx, by, bz = axis(state, c, joint.child_frame, 0)
        return cross(ax, ay, az, bx, by, bz)
    if kind == UNIVERSAL:
        ax, ay, az = axis(state, p, joint.parent_frame, 0)
        bx, by, bz = axis(state, c, joint.child_frame, 1)
        nx, ny, nz = cross(ax, ay, az, bx, by, bz)
        f = -(ax * bx + ay * by + az * bz)
        return f * nx, f * ny, f * nz
    ex, ey, ez = 0.0, 0.0, 0.0
    if kind in RIGID:
        # half the sum of e_p x e_c over the three axes: the rotation vector to first order,
        # zero only if the frames agree (or are half a turn apart, which is excluded at the start)
        for k in range(3):
            ax, ay, az = axis(state, p, joint.parent_frame, k)
            bx, by, bz = axis(state, c, joint.child_frame, k)
            sx, sy, sz = cross(ax, ay, az, bx, by, bz)
            ex, ey, ez = ex + 0.5 * sx, ey + 0.5 * sy, ez + 0.5 * sz
    return ex, ey, ez


@kernel
def screw_error(joint, state, slide):
    """Return the error of the slide of a screw [m] for its present turn.

    The turn is known up to whole turns, the slide completely. So the error is k times (slide/k - turn)
    modulo 2 pi, and turns need not be counted.
    """
    c, p = joint.child, joint.parent
    bx, by, bz = axis(state, c, joint.child_frame, 1)
    ax, ay, az = axis(state, p, joint.parent_frame, 1)
    cosine = ax * bx + ay * by + az * bz
    ax, ay, az = axis(state, p, joint.parent_frame, 2)
    sine = ax * bx + ay * by + az * bz
    s, r = math.sin(slide / joint.length), math.cos(slide / joint.length)
    return joint.length * math.atan2(s * cosine - r * sine, r * cosine + s * sine)


@kernel
def position_error(joint, state, out):
    """Write the error of position: out = (turn error, anchor gap)."""
    out[0], out[1], out[2] = turn_error(joint, state)
    dx, dy, dz = anchor_gap(joint, state)
    kind = joint.kind
    if kind == DISTANCE:
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        f = (length - joint.length) / length
        dx, dy, dz = f * dx, f * dy, f * dz
    elif kind in SLIDING:  # sliding is no error
        ax, ay, az = axis(state, joint.parent, joint.parent_frame, 0)
        f = ax * dx + ay * dy + az * dz
        if kind in WITHIN:
            dx, dy, dz = f * ax, f * ay, f * az
        else:
            if kind == SCREW:
                f -= screw_error(joint, state, f)
            dx, dy, dz = dx - f * ax, dy - f * ay, dz - f * az
    elif kind == KNIFE_EDGE:
        dx, dy, dz = 0.0, 0.0, 0.0
    elif kind in ROLLING:  # only the distance from the plane
        ax, ay, az = axis(state, joint.parent, joint.parent_frame, 0)
        f = ax * dx + ay * dy + az * dz
        dx, dy, dz = f * ax, f * ay, f * az
    out[3], out[4], out[5] = dx, dy, dz


@kernel
def velocity_error(joint, state, out):
    """Write the forbidden part of the relative velocity of the two sides: out = (angular, linear)."""
    c, p, kind = joint.child, joint.parent, joint.kind
    wx, wy, wz = state[c].w[0], state[c].w[1], state[c].w[2]
    if p >= 0:
        wx, wy, wz = wx - state[p].w[0], wy - state[p].w[1], wz - state[p].w[2]
    ux, uy, uz = anchor_speed(joint, state)
    ax, ay, az = axis(state, p, joint.parent_frame, 0)
    turn = 0.0
    if kind in BALL:
        wx, wy, wz = 0.0, 0.0, 0.0
    elif kind in TURNING or kind == UNIVERSAL:
        turn = ax * wx + ay * wy + az * wz
        wx, wy, wz = wx - turn * ax, wy - turn * ay, wz - turn * az
        if kind == UNIVERSAL:
            bx, by, bz = axis(state, c, joint.child_frame, 1)
            f = bx * wx + by * wy + bz * wz
            wx, wy, wz = wx - f * bx, wy - f * by, wz - f * bz
    if kind in SLIDING:
        f = ax * ux + ay * uy + az * uz
        if kind in WITHIN:
            ux, uy, uz = f * ax, f * ay, f * az
        else:
            if kind == SCREW:
                f = joint.length * turn
            ux, uy, uz = ux - f * ax, uy - f * ay, uz - f * az
    out[0], out[1], out[2] = wx, wy, wz
    out[3], out[4], out[5] = ux, uy, uz


@kernel
def universal_bias(joint, state, wx, wy, wz):
    """Return the angular bias of a universal joint whose parent turns with w.

    With its axes a of the parent and b of the child, n = a x b, its row is

        n . (w_c - w_p) = 0,    n . alpha + n' . (w_c - w_p) = 0,

    which gives the bias along n, also slightly off the manifold. Perpendicular to n, the bias follows from the
    rotation of the axes: with the rates p and q of the angles, w_c - w_p = p a + q b and
    alpha = p' a + q' b + p w_p x a + q w_c x b.
    """
    ax, ay, az = axis(state, joint.parent, joint.parent_frame, 0)
    bx, by, bz = axis(state, joint.child, joint.child_frame, 1)
    nx, ny, nz = cross(ax, ay, az, bx, by, bz)
    cx, cy, cz = state[joint.child].w[0], state[joint.child].w[1], state[joint.child].w[2]
    ux, uy, uz = cx - wx, cy - wy, cz - wz
    tx, ty, tz = cross(cx, cy, cz, bx, by, bz)
    sx, sy, sz = cross(wx, wy, wz, ax, ay, az)
    p, q = ax * ux + ay * uy + az * uz, bx * ux + by * uy + bz * uz
    ox, oy, oz = p * sx + q * tx, p * sy + q * ty, p * sz + q * tz
    tx, ty, tz = cross(ax, ay, az, tx, ty, tz)
    sx, sy, sz = cross(sx, sy, sz, bx, by, bz)
    f = nx * ox + ny * oy + nz * oz + (sx + tx) * ux + (sy + ty) * uy + (sz + tz) * uz
    f /= nx * nx + ny * ny + nz * nz
    return ox - f * nx, oy - f * ny, oz - f * nz


@kernel
def acceleration_bias(joint, state, out):
    """Write the bias of the relative acceleration: out = (angular, linear).

    The angular bias comes from an axis that turns with the parent, w_p x (a qd) = w_p x w_c. The linear bias
    comes from the centripetal accelerations of the two anchors, w_p x (w_p x r_p) - w_c x (w_c x r_c). A
    distance adds -|u_perp|^2/d along the line, a sliding joint 2 w_p x u, the knife edge and the universal
    joint the rotation of their own row.
    """
    c, p = joint.child, joint.parent
    kind = joint.kind
    if kind in ROLLING:
        out[0], out[1], out[2] = 0.0, 0.0, 0.0
        out[3], out[4], out[5] = rolling_bias(joint, state)
        return
    rx, ry, rz = child_arm(joint, state)
    tx, ty, tz = cross(state[c].w[0], state[c].w[1], state[c].w[2], rx, ry, rz)
    sx, sy, sz = cross(state[c].w[0], state[c].w[1], state[c].w[2], tx, ty, tz)
    lx, ly, lz = -sx, -sy, -sz
    ax, ay, az = 0.0, 0.0, 0.0
    wx, wy, wz = 0.0, 0.0, 0.0
    if p >= 0:
        wx, wy, wz = state[p].w[0], state[p].w[1], state[p].w[2]
        rx, ry, rz = parent_arm(joint, state)
        tx, ty, tz = cross(wx, wy, wz, rx, ry, rz)
        sx, sy, sz = cross(wx, wy, wz, tx, ty, tz)
        lx, ly, lz = lx + sx, ly + sy, lz + sz
        if kind in TURNING:
            ax, ay, az = cross(wx, wy, wz, state[c].w[0], state[c].w[1], state[c].w[2])
        if kind in SLIDING:
            ux, uy, uz = anchor_speed(joint, state)
            sx, sy, sz = cross(wx, wy, wz, 2.0 * ux, 2.0 * uy, 2.0 * uz)
            lx, ly, lz = lx + sx, ly + sy, lz + sz
    if kind == DISTANCE:
        dx, dy, dz = anchor_gap(joint, state)
        ux, uy, uz = anchor_speed(joint, state)
        d2 = dx * dx + dy * dy + dz * dz
        along = (dx * ux + dy * uy + dz * uz) / d2
        # (u.u - (u.d)^2/d^2)/d^2 times d, so that its part along d/|d| is |u_perp|^2/|d|
        f = (ux * ux + uy * uy + uz * uz) / d2 - along * along
        lx, ly, lz = lx - f * dx, ly - f * dy, lz - f * dz
    elif kind == KNIFE_EDGE:
        # row e fixed in the child: e . a + (w x e) . u = 0, written as a linear bias along e
        ex, ey, ez = axis(state, c, joint.child_frame, 1)
        ux, uy, uz = anchor_speed(joint, state)
        tx, ty, tz = cross(state[c].w[0], state[c].w[1], state[c].w[2], ex, ey, ez)
        f = tx * ux + ty * uy + tz * uz
        lx, ly, lz = lx - f * ex, ly - f * ey, lz - f * ez
    elif kind == UNIVERSAL:
        ax, ay, az = universal_bias(joint, state, wx, wy, wz)
    out[0], out[1], out[2] = ax, ay, az
    out[3], out[4], out[5] = lx, ly, lz
