"""Points of bodies, their velocities, and the wrench of a force at a point; body -1 is the ground."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross
from carom.kinematics.joints import arm


@kernel
def point(state, b, local):
    """Return the arm from the centre of body b (-1: ground) to `local`, and the point (world)."""
    rx, ry, rz = arm(state, b, local)
    if b < 0:
        return rx, ry, rz, rx, ry, rz
    x = state[b].x
    return rx, ry, rz, rx + x[0], ry + x[1], rz + x[2]


@kernel
def point_velocity(state, b, rx, ry, rz):
    """Return the velocity of the point at arm r of body b (-1: ground)."""
    if b < 0:
        return 0.0, 0.0, 0.0
    v, w = state[b].v, state[b].w
    ux, uy, uz = cross(w[0], w[1], w[2], rx, ry, rz)
    return ux + v[0], uy + v[1], uz + v[2]


@kernel
def add_force(work, b, r, f):
    """Add the force f at arm r to the wrench on body b (-1: ground)."""
    if b < 0:
        return
    wrench = work.body[b].wrench
    torque = cross(r[0], r[1], r[2], f[0], f[1], f[2])
    for k in range(3):
        wrench[k] += f[k]
        wrench[3 + k] += torque[k]
