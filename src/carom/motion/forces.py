"""Applied forces: the wrench on each body at its mass centre, and the power of those without potential."""

from __future__ import annotations

import math

from carom.geometry.rotation import cross, rotate, rotate_back
from carom.jit import kernel


@kernel
def point(x, Q, b, local, i):
    """Return the arm from the centre of body b (-1: ground) to `local[i]`, and the point (world)."""
    px, py, pz = local[i, 0], local[i, 1], local[i, 2]
    if b < 0:
        return px, py, pz, px, py, pz
    px, py, pz = rotate(Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3], px, py, pz)
    return px, py, pz, px + x[b, 0], py + x[b, 1], pz + x[b, 2]


@kernel
def point_velocity(v, w, b, rx, ry, rz):
    """Return the velocity of the point at arm r of body b (-1: ground)."""
    if b < 0:
        return 0.0, 0.0, 0.0
    ux, uy, uz = cross(w[b, 0], w[b, 1], w[b, 2], rx, ry, rz)
    return ux + v[b, 0], uy + v[b, 1], uz + v[b, 2]


@kernel
def add_force(wrench, b, rx, ry, rz, fx, fy, fz):
    """Add the force f at arm r to the wrench on body b (-1: ground)."""
    if b < 0:
        return
    tx, ty, tz = cross(rx, ry, rz, fx, fy, fz)
    wrench[b, 0] += fx
    wrench[b, 1] += fy
    wrench[b, 2] += fz
    wrench[b, 3] += tx
    wrench[b, 4] += ty
    wrench[b, 5] += tz


@kernel
def spring(forces, i, x, Q, v, w):
    """Return arms, unit vector parent -> child, tension and damper force of spring i (12 numbers)."""
    p, c = forces.spring_parent[i], forces.spring_child[i]
    ax, ay, az, px, py, pz = point(x, Q, p, forces.spring_parent_anchor, i)
    bx, by, bz, qx, qy, qz = point(x, Q, c, forces.spring_child_anchor, i)
    dx, dy, dz = qx - px, qy - py, qz - pz
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    s = 1.0 / length if length > 0.0 else 0.0
    dx, dy, dz = s * dx, s * dy, s * dz
    ux, uy, uz = point_velocity(v, w, c, bx, by, bz)
    sx, sy, sz = point_velocity(v, w, p, ax, ay, az)
    rate = dx * (ux - sx) + dy * (uy - sy) + dz * (uz - sz)
    tension = forces.spring_constants[i, 0] * (length - forces.spring_constants[i, 2])
    return ax, ay, az, bx, by, bz, dx, dy, dz, tension, forces.spring_constants[i, 1] * rate, rate


@kernel
def applied_wrenches(system, x, Q, v, w, wrench):
    """Write gravity, -w x I w and all applied forces; return the power of dampers and constant loads."""
    bodies, forces = system.bodies, system.forces
    g, J = bodies.gravity, bodies.inertia
    for b in range(bodies.mass.size):
        for k in range(3):
            wrench[b, k] = bodies.mass[b] * g[k]
        if bodies.isotropic[b] == 1:
            wrench[b, 3], wrench[b, 4], wrench[b, 5] = 0.0, 0.0, 0.0
            continue
        W = rotate_back(Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3], w[b, 0], w[b, 1], w[b, 2])
        tx, ty, tz = cross(J[b, 0] * W[0], J[b, 1] * W[1], J[b, 2] * W[2], W[0], W[1], W[2])
        tx, ty, tz = rotate(Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3], tx, ty, tz)
        wrench[b, 3], wrench[b, 4], wrench[b, 5] = tx, ty, tz
    power = 0.0
    for i in range(forces.spring_child.size):
        s = spring(forces, i, x, Q, v, w)
        f = s[9] + s[10]
        dx, dy, dz = f * s[6], f * s[7], f * s[8]
        add_force(wrench, forces.spring_child[i], s[3], s[4], s[5], -dx, -dy, -dz)
        add_force(wrench, forces.spring_parent[i], s[0], s[1], s[2], dx, dy, dz)
        power -= s[10] * s[11]
    for i in range(forces.wrench_body.size):
        b = forces.wrench_body[i]
        rx, ry, rz, _px, _py, _pz = point(x, Q, b, forces.wrench_anchor, i)
        f = forces.wrench[i]
        add_force(wrench, b, rx, ry, rz, f[0], f[1], f[2])
        ux, uy, uz = point_velocity(v, w, b, rx, ry, rz)
        power += f[0] * ux + f[1] * uy + f[2] * uz
        for k in range(3):
            wrench[b, 3 + k] += f[3 + k]
            power += f[3 + k] * w[b, k]
    return power


@kernel
def energies(system, x, Q, v, w):
    """Return kinetic energy, and potential energy of gravity and springs [J]."""
    bodies, forces = system.bodies, system.forces
    J, g = bodies.inertia, bodies.gravity
    kinetic, potential = 0.0, 0.0
    for b in range(bodies.mass.size):
        m = bodies.mass[b]
        W = rotate_back(Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3], w[b, 0], w[b, 1], w[b, 2])
        kinetic += 0.5 * m * (v[b, 0] * v[b, 0] + v[b, 1] * v[b, 1] + v[b, 2] * v[b, 2])
        kinetic += 0.5 * (J[b, 0] * W[0] * W[0] + J[b, 1] * W[1] * W[1] + J[b, 2] * W[2] * W[2])
        potential -= m * (x[b, 0] * g[0] + x[b, 1] * g[1] + x[b, 2] * g[2])
    for i in range(forces.spring_child.size):
        k = forces.spring_constants[i, 0]
        if k > 0.0:
            stretch = spring(forces, i, x, Q, v, w)[9] / k
            potential += 0.5 * k * stretch * stretch
    return kinetic, potential
