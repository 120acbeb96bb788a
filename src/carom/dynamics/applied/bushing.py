"""Elastic mounts: springs and dampers along and about three axes of the parent.

Let d be the displacement of the child's anchor from the parent's and theta the rotation vector of the child,
both in the axes of the mount in the parent, and u, w the relative velocities. Then

    U = 1/2 d.K d + 1/2 theta.K_t theta,    F = -K d - C u,    T = -J(theta)^-T K_t theta - C_t w,

with the left Jacobian J of the rotation vector, theta' = J^-1 w, so that the elastic part has the potential U
for any rotation below half a turn. F acts on both bodies at the child's anchor.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.thresholds import SERIES_TURN
from carom.geometry.rotation import (
    conjugate,
    cross,
    log,
    multiply,
    rotate,
    rotate_back,
    unit_vector,
)
from carom.kinematics.joints import arm
from carom.kinematics.wrench import add_force, point, point_velocity


@kernel
def attitude(state, b, frame):
    """Return the quaternion from the axes of a mount, given in those of body b (-1: ground), to the world."""
    if b < 0:
        return frame[0], frame[1], frame[2], frame[3]
    return multiply(state[b].Q, frame)


@kernel
def displacement(bushing, state):
    """Return (d, theta), six numbers, in the axes of the mount."""
    p, c = bushing.parent, bushing.child
    a = attitude(state, p, bushing.parent_frame)
    b = attitude(state, c, bushing.child_frame)
    _, _, _, px, py, pz = point(state, p, bushing.parent_anchor)
    _, _, _, qx, qy, qz = point(state, c, bushing.child_anchor)
    d = rotate_back(a, (qx - px, qy - py, qz - pz))
    t = log(multiply(conjugate(a), b))
    return d[0], d[1], d[2], t[0], t[1], t[2]


@kernel
def turn_moment(bushing, x, y, z):
    """Return J(theta)^-T K_t theta = m + theta x m/2 + b theta x (theta x m), b = 1/t^2 - cot(t/2)/(2 t)."""
    K = bushing.turn_stiffness
    m0, m1, m2 = K[0] * x, K[1] * y, K[2] * z
    t2 = x * x + y * y + z * z
    b = 1.0 / 12.0 + t2 / 720.0
    if t2 > SERIES_TURN:
        t = math.sqrt(t2)
        b = 1.0 / t2 - 0.5 / (t * math.tan(0.5 * t))
    c = cross(x, y, z, m0, m1, m2)
    e = cross(x, y, z, c[0], c[1], c[2])
    return m0 + 0.5 * c[0] + b * e[0], m1 + 0.5 * c[1] + b * e[1], m2 + 0.5 * c[2] + b * e[2]


@kernel
def add(system, bushing, state, power, work):
    """Add the wrenches of a mount to both bodies; return `power` with that of its dampers."""
    p, c = bushing.parent, bushing.child
    a = attitude(state, p, bushing.parent_frame)
    d0, d1, d2, t0, t1, t2 = displacement(bushing, state)
    rx, ry, rz, qx, qy, qz = point(state, c, bushing.child_anchor)
    sx, sy, sz = qx, qy, qz  # the same point, from the centre of the parent
    if p >= 0:
        sx, sy, sz = qx - state[p].x[0], qy - state[p].x[1], qz - state[p].x[2]
    ux, uy, uz = point_velocity(state, c, rx, ry, rz)
    vx, vy, vz = point_velocity(state, p, sx, sy, sz)
    wx, wy, wz = state[c].w[0], state[c].w[1], state[c].w[2]
    if p >= 0:
        wx, wy, wz = wx - state[p].w[0], wy - state[p].w[1], wz - state[p].w[2]
    u = rotate_back(a, (ux - vx, uy - vy, uz - vz))
    w = rotate_back(a, (wx, wy, wz))
    K, C, D = bushing.stiffness, bushing.damping, bushing.turn_damping
    m = turn_moment(bushing, t0, t1, t2)
    f = rotate(a, (K[0] * d0 + C[0] * u[0], K[1] * d1 + C[1] * u[1], K[2] * d2 + C[2] * u[2]))
    mx, my, mz = rotate(a, (m[0] + D[0] * w[0], m[1] + D[1] * w[1], m[2] + D[2] * w[2]))
    add_force(work, c, (rx, ry, rz), (-f[0], -f[1], -f[2]))
    add_force(work, p, (sx, sy, sz), f)
    add_torque(work, c, -mx, -my, -mz)
    add_torque(work, p, mx, my, mz)
    lost = 0.0
    for k in range(3):
        lost -= C[k] * u[k] * u[k] + D[k] * w[k] * w[k]
    return power + lost, math.nan, math.nan, math.nan


@kernel
def add_torque(work, b, tx, ty, tz):
    """Add a torque to the wrench on body b (-1: ground)."""
    if b < 0:
        return
    wrench = work.body[b].wrench
    wrench[3] += tx
    wrench[4] += ty
    wrench[5] += tz


@kernel
def acts_at(system, bushing, state):
    """Return the arm of the child to its anchor."""
    return arm(state, bushing.child, bushing.child_anchor)


@kernel
def energy(system, bushing, state, t):
    """Return the elastic energy of a mount [J]."""
    d0, d1, d2, t0, t1, t2 = displacement(bushing, state)
    K, T = bushing.stiffness, bushing.turn_stiffness
    total = K[0] * d0 * d0 + K[1] * d1 * d1 + K[2] * d2 * d2
    total += T[0] * t0 * t0 + T[1] * t1 * t1 + T[2] * t2 * t2
    return 0.5 * total


@kernel
def unit_force(system, one, n, state, work):
    """Add the wrenches of a unit force along, or a unit torque about, an axis of a mount."""
    axes = attitude(state, one.parent, one.parent_frame)
    ex, ey, ez = rotate(axes, unit_vector(n % 3))
    ax, ay, az, px, py, pz = point(state, one.parent, one.parent_anchor)
    bx, by, bz, qx, qy, qz = point(state, one.child, one.child_anchor)
    if n < 3:  # both forces act at the child's anchor
        add_force(work, one.child, (bx, by, bz), (ex, ey, ez))
        add_force(work, one.parent, (ax + qx - px, ay + qy - py, az + qz - pz), (-ex, -ey, -ez))
    else:
        add_torque(work, one.child, ex, ey, ez)
        add_torque(work, one.parent, -ex, -ey, -ez)
    return 0.0, 0.0
