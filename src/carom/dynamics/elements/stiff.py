"""Springs and dampers that are rows of the implicit step: their stretch s, its rate, and forces.

A spring on a line between two points, or along a coordinate of a joint, has the force mu = -(k s + c s') along
its row J, s' = J v. The implicit step uses the value of mu within the step (`carom.dynamics.implicit`); all
other computations (reactions, active contacts) use the present force.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.geometry.rotation import cross
from carom.kinematics.coordinate import add_rows, motion_along, push, rate, value
from carom.kinematics.rows import mass_row
from carom.kinematics.wrench import add_force, point, point_velocity
from carom.model.parts_of_system import has_relation_rows


@kernel
def line_of(one, state):
    """Return the unit vector from the parent's point to the child's, their distance, and both arms."""
    ax, ay, az, px, py, pz = point(state, one.parent, one.parent_anchor)
    bx, by, bz, qx, qy, qz = point(state, one.child, one.child_anchor)
    dx, dy, dz = qx - px, qy - py, qz - pz
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    s = 1.0 / length if length > 0.0 else 0.0
    return s * dx, s * dy, s * dz, length, ax, ay, az, bx, by, bz


@kernel
def stretch(system, one, state):
    """Return the stretch s of a spring and its rate."""
    if one.coordinate >= 0:
        c = system.relations.coordinates[one.coordinate]
        return value(system, c, state) - one.rest, rate(system, c, state)
    ex, ey, ez, length, ax, ay, az, bx, by, bz = line_of(one, state)
    ux, uy, uz = point_velocity(state, one.child, bx, by, bz)
    vx, vy, vz = point_velocity(state, one.parent, ax, ay, az)
    return length - one.rest, ex * (ux - vx) + ey * (uy - vy) + ez * (uz - vz)


@kernel
def along_row(system, one, state, work):
    """Return J times the motions of the last solve."""
    if one.coordinate >= 0:
        return motion_along(system, system.relations.coordinates[one.coordinate], state, work)
    ex, ey, ez, _, ax, ay, az, bx, by, bz = line_of(one, state)
    total = 0.0
    for side in range(2):
        b, s = (one.child, 1.0) if side == 0 else (one.parent, -1.0)
        if b >= 0:
            m = work.body[b].motion
            rx, ry, rz = (bx, by, bz) if side == 0 else (ax, ay, az)
            tx, ty, tz = cross(m[3], m[4], m[5], rx, ry, rz)
            total += s * (ex * (m[0] + tx) + ey * (m[1] + ty) + ez * (m[2] + tz))
    return total


@unit
def write_rows(system, j, state, work):
    """Write A and A M^-1 of a spring."""
    solver, one = system.solver, system.relations.stiff[system.joints[j].number]
    first, last = solver.rows[j].first, solver.rows[j].last
    for s in range(first, last):
        for k in range(6):
            solver.sides[s].A[0, k] = 0.0
    child = solver.sides[max(0, one.child_side)].A
    parent = solver.sides[max(0, one.parent_side)].A
    if one.coordinate >= 0:
        add_rows(system, system.relations.coordinates[one.coordinate], state, 1.0, child, parent)
    else:
        ex, ey, ez, _, ax, ay, az, bx, by, bz = line_of(one, state)
        for side in range(2):
            b, A, s = (one.child, child, 1.0) if side == 0 else (one.parent, parent, -1.0)
            if b >= 0:
                rx, ry, rz = (bx, by, bz) if side == 0 else (ax, ay, az)
                tx, ty, tz = cross(rx, ry, rz, ex, ey, ez)
                A[0, 0], A[0, 1], A[0, 2] = s * ex, s * ey, s * ez
                A[0, 3], A[0, 4], A[0, 5] = s * tx, s * ty, s * tz
    for s in range(first, last):
        mass_row(system, solver.sides[s], 0, work)


@unit
def acceleration_bias(system, j, state, work):
    """Write 0: outside of the implicit step the row has no part."""
    work.joint[j].bias[0] = 0.0


@unit(where=has_relation_rows, otherwise=0.0)
def add_stiff(system, state, work) -> float:
    """Add the present wrenches of these springs; return the power of their dampers."""
    power = 0.0
    for i in range(system.relations.stiff.shape[0]):
        one = system.relations.stiff[i]
        s, speed = stretch(system, one, state)
        f = -(one.stiffness * s + one.damping * speed)
        power -= one.damping * speed * speed
        if one.coordinate >= 0:
            push(system, system.relations.coordinates[one.coordinate], state, f, work)
            continue
        ex, ey, ez, _, ax, ay, az, bx, by, bz = line_of(one, state)
        add_force(work, one.child, (bx, by, bz), (f * ex, f * ey, f * ez))
        add_force(work, one.parent, (ax, ay, az), (-f * ex, -f * ey, -f * ez))
    return power


@unit(where=has_relation_rows, otherwise=0.0)
def stiff_energy(system, state) -> float:
    """Return the potential energy of these springs [J]."""
    total = 0.0
    for i in range(system.relations.stiff.shape[0]):
        one = system.relations.stiff[i]
        s, _ = stretch(system, one, state)
        total += 0.5 * one.stiffness * s * s
    return total
