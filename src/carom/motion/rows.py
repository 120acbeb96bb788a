"""Constraint rows of joints for systems with closed loops: A (rows) and A M^-1.

Row r of joint j takes the part t_r of the joint's relative motion (angular t_a, linear t_l): on the
child [t_l, r_c x t_l + t_a], on the parent minus the same with its own arm.
"""

from __future__ import annotations

import math

from carom.geometry.rotation import cross, matrix, spin_tensor
from carom.jit import kernel
from carom.motion.joints import anchor_gap, arm, axis, parent_arm
from carom.system.arrays import DISTANCE, KNIFE_EDGE, PRISMATIC, REVOLUTE


@kernel
def direction(joints, j, r, x, Q):
    """Return the constrained direction r of joint j in world axes: (t_a, t_l), six numbers."""
    kind = joints.kind[j]
    p = joints.parent[j]
    if kind == KNIFE_EDGE:
        ex, ey, ez = axis(Q, joints.child[j], joints.child_frame, j, 1)
        return 0.0, 0.0, 0.0, ex, ey, ez
    if kind == DISTANCE:
        dx, dy, dz = anchor_gap(joints, j, x, Q)
        s = 1.0 / math.sqrt(dx * dx + dy * dy + dz * dz)
        return 0.0, 0.0, 0.0, s * dx, s * dy, s * dz
    if kind == PRISMATIC:
        if r < 2:
            ex, ey, ez = axis(Q, p, joints.parent_frame, j, 1 + r)
            return 0.0, 0.0, 0.0, ex, ey, ez
        ex, ey, ez = axis(Q, p, joints.parent_frame, j, r - 2)
        return ex, ey, ez, 0.0, 0.0, 0.0
    if r < 3:  # spherical, revolute, fixed: the anchors coincide
        one = 1.0
        return 0.0, 0.0, 0.0, one if r == 0 else 0.0, one if r == 1 else 0.0, one if r == 2 else 0.0
    # revolute: no turning about the second and third axis; fixed: about none
    ex, ey, ez = axis(Q, p, joints.parent_frame, j, r - 2 if kind == REVOLUTE else r - 3)
    return ex, ey, ez, 0.0, 0.0, 0.0


@kernel
def inverse_inertias(system, Q, inverse):
    """Write the inverse inertia (xx, xy, xz, yy, yz, zz) of each body in world axes."""
    inertia = system.bodies.inertia
    for b in range(inertia.shape[0]):
        R = matrix(Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3])
        t = spin_tensor(
            R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8],
            1.0 / inertia[b, 0], 1.0 / inertia[b, 1], 1.0 / inertia[b, 2],
        )  # fmt: skip
        for k in range(6):
            inverse[b, k] = t[k]


@kernel
def times_inverse_mass(mass, inverse, b, f0, f1, f2, t0, t1, t2):
    """Return M_b^-1 times a wrench (force, torque)."""
    g = 1.0 / mass[b]
    i = inverse[b]
    return (
        g * f0,
        g * f1,
        g * f2,
        i[0] * t0 + i[1] * t1 + i[2] * t2,
        i[1] * t0 + i[3] * t1 + i[4] * t2,
        i[2] * t0 + i[4] * t1 + i[5] * t2,
    )


@kernel
def build_rows(system, x, Q):
    """Write A and A M^-1 of all joints into the solver's arrays."""
    solver, joints, mass = system.solver, system.joints, system.bodies.mass
    inverse_inertias(system, Q, solver.inverse)
    for j in range(joints.kind.size):
        c, p = joints.child[j], joints.parent[j]
        cx, cy, cz = arm(Q, c, joints.child_anchor, j)
        px, py, pz = parent_arm(joints, j, x, Q)
        for r in range(joints.rows[j]):
            ax, ay, az, lx, ly, lz = direction(joints, j, r, x, Q)
            tx, ty, tz = cross(cx, cy, cz, lx, ly, lz)
            write_row(solver, mass, j, 0, r, c, lx, ly, lz, tx + ax, ty + ay, tz + az)
            if p >= 0:
                tx, ty, tz = cross(px, py, pz, lx, ly, lz)
                write_row(solver, mass, j, 1, r, p, -lx, -ly, -lz, -tx - ax, -ty - ay, -tz - az)


@kernel
def write_row(solver, mass, j, side, r, b, f0, f1, f2, t0, t1, t2):
    """Store one row for one body, and the row times M^-1."""
    row, scaled = solver.rows[j, side, r], solver.scaled[j, side, r]
    row[0], row[1], row[2], row[3], row[4], row[5] = f0, f1, f2, t0, t1, t2
    y = times_inverse_mass(mass, solver.inverse, b, f0, f1, f2, t0, t1, t2)
    for k in range(6):
        scaled[k] = y[k]


@kernel
def row_targets(system, x, Q, bias, rhs):
    """Write rhs[j, r] = t_r . bias[j], what each row of A times the motion shall be."""
    joints = system.joints
    for j in range(joints.kind.size):
        for r in range(joints.rows[j]):
            d = direction(joints, j, r, x, Q)
            s = 0.0
            for k in range(6):
                s += d[k] * bias[j, k]
            rhs[j, r] = s


