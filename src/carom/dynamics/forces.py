"""Applied forces: the wrench on each body at its mass centre, and the power of those without potential."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.bushing import add_bushing, bushing_energy
from carom.dynamics.more_forces import add_more_forces, more_energy, spring_energy, tension
from carom.geometry.rotation import cross, rotate, rotate_back
from carom.kinematics.joints import arm
from carom.kinematics.wrench import add_force, point, point_velocity


@kernel
def add_spring(system, spring, state, work):
    """Add the force of a spring with damper to both ends; return its tension, length and rate of length."""
    p, c = spring.parent, spring.child
    ax, ay, az, px, py, pz = point(state, p, spring.parent_anchor)
    bx, by, bz, qx, qy, qz = point(state, c, spring.child_anchor)
    dx, dy, dz = qx - px, qy - py, qz - pz
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    s = 1.0 / length if length > 0.0 else 0.0
    dx, dy, dz = s * dx, s * dy, s * dz
    ux, uy, uz = point_velocity(state, c, bx, by, bz)
    sx, sy, sz = point_velocity(state, p, ax, ay, az)
    rate = dx * (ux - sx) + dy * (uy - sy) + dz * (uz - sz)
    f = tension(system, spring, length) + spring.damping * rate
    add_force(work, c, (bx, by, bz), (-f * dx, -f * dy, -f * dz))
    add_force(work, p, (ax, ay, az), (f * dx, f * dy, f * dz))
    return f, length, rate


@kernel
def add_load(load, state, work):
    """Add a force and torque, constant in the world or in the axes of a body; return their power."""
    b, w = load.body, state[load.body].w
    f, t = arm(state, load.frame, load.force), arm(state, load.frame, load.torque)
    rx, ry, rz, _px, _py, _pz = point(state, b, load.anchor)
    add_force(work, b, (rx, ry, rz), f)
    ux, uy, uz = point_velocity(state, b, rx, ry, rz)
    power = f[0] * ux + f[1] * uy + f[2] * uz
    wrench = work.body[b].wrench
    for k in range(3):
        wrench[3 + k] += t[k]
        power += t[k] * w[k]
    return power


@kernel
def applied_wrenches(system, state, gyroscopic, work):
    """Write gravity, all applied forces and, if `gyroscopic`, -w x I w.

    Return the power of the forces without potential: dampers and constant loads.
    """
    g = system.gravity
    for b in range(system.bodies.shape[0]):
        body, wrench = system.bodies[b], work.body[b].wrench
        for k in range(3):
            wrench[k] = body.mass * g[k]
            wrench[3 + k] = 0.0
        if gyroscopic and body.isotropic == 0:
            J, q, w = body.inertia, state[b].Q, state[b].w
            W = rotate_back(q, w)
            tx, ty, tz = cross(J[0] * W[0], J[1] * W[1], J[2] * W[2], W[0], W[1], W[2])
            wrench[3], wrench[4], wrench[5] = rotate(q, (tx, ty, tz))
    power = 0.0
    for i in range(system.springs.shape[0]):
        _, _, rate = add_spring(system, system.springs[i], state, work)
        power += -(system.springs[i].damping * rate) * rate
    for i in range(system.loads.shape[0]):
        power += add_load(system.loads[i], state, work)
    for i in range(system.bushings.shape[0]):
        power += add_bushing(system.bushings[i], state, work)
    return power + add_more_forces(system, state, work)


@kernel
def difference_of_loads(system, h, taken, without, work):
    """Write h times the difference of the applied forces in two states; return whether it is not zero."""
    applied_wrenches(system, taken, False, work)
    for b in range(system.bodies.shape[0]):
        wrench, kept = work.body[b].wrench, work.stages[0, b].rate
        for k in range(6):
            kept[k] = wrench[k]
    applied_wrenches(system, without, False, work)
    anything = False
    for b in range(system.bodies.shape[0]):
        wrench, kept = work.body[b].wrench, work.stages[0, b].rate
        for k in range(6):
            wrench[k] = h * (kept[k] - wrench[k])
            anything = anything or wrench[k] != 0.0
    return anything


@kernel
def potential_energy(system, state, t):
    """Return the potential energy of gravity and springs [J]."""
    g, potential = system.gravity, 0.0
    for b in range(system.bodies.shape[0]):
        x = state[b].x
        potential -= system.bodies[b].mass * (x[0] * g[0] + x[1] * g[1] + x[2] * g[2])
    for i in range(system.springs.shape[0]):
        s = system.springs[i]
        _, _, _, px, py, pz = point(state, s.parent, s.parent_anchor)
        _, _, _, qx, qy, qz = point(state, s.child, s.child_anchor)
        dx, dy, dz = qx - px, qy - py, qz - pz
        potential += spring_energy(system, s, math.sqrt(dx * dx + dy * dy + dz * dz))
    for i in range(system.bushings.shape[0]):
        potential += bushing_energy(system.bushings[i], state)
    return potential + more_energy(system, state, t)
