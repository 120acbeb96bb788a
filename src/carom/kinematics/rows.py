"""Constraint rows of joints for systems with closed loops: A (rows) and A M^-1.

Row r of joint j is the component of the relative motion along t_r (angular t_a, linear t_l). It is
[t_l, r_c x t_l + t_a] for the child, and minus the same with its own arm for the parent.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross, matrix, spin_tensor
from carom.kinematics.joints import anchor_gap, axis, child_arm, parent_arm
from carom.model.arrays import ALONG, DISTANCE, KNIFE_EDGE, RIGID, SCREW, UNIVERSAL, WITHIN


@kernel
def direction(joint, r, state):
    """Return the constrained direction r of a joint in world axes: (t_a, t_l), six numbers."""
    kind = joint.kind
    p = joint.parent
    if kind == KNIFE_EDGE:
        ex, ey, ez = axis(state, joint.child, joint.child_frame, 1)
        return 0.0, 0.0, 0.0, ex, ey, ez
    if kind == DISTANCE:
        dx, dy, dz = anchor_gap(joint, state)
        s = 1.0 / math.sqrt(dx * dx + dy * dy + dz * dz)
        return 0.0, 0.0, 0.0, s * dx, s * dy, s * dz
    if kind in ALONG:  # no sliding across the first axis
        linear = 2
        if r < 2:
            ex, ey, ez = axis(state, p, joint.parent_frame, 1 + r)
            return 0.0, 0.0, 0.0, ex, ey, ez
        if kind == SCREW:
            linear, k = 3, -joint.length
            if r == 2:  # along the axis as the child turns
                ex, ey, ez = axis(state, p, joint.parent_frame, 0)
                return k * ex, k * ey, k * ez, ex, ey, ez
    elif kind in WITHIN:
        linear = 1
        if r == 0:
            ex, ey, ez = axis(state, p, joint.parent_frame, 0)
            return 0.0, 0.0, 0.0, ex, ey, ez
    else:  # the anchors coincide
        linear = 3
        if r < 3:
            e0, e1, e2 = 1.0 if r == 0 else 0.0, 1.0 if r == 1 else 0.0, 1.0 if r == 2 else 0.0
            return 0.0, 0.0, 0.0, e0, e1, e2
    if kind == UNIVERSAL:  # no rotation about the normal of both axes
        ax, ay, az = axis(state, p, joint.parent_frame, 0)
        bx, by, bz = axis(state, joint.child, joint.child_frame, 1)
        ex, ey, ez = cross(ax, ay, az, bx, by, bz)
        return ex, ey, ez, 0.0, 0.0, 0.0
    # with a shared first axis, no rotation about the second and third; in a rigid joint, about any
    ex, ey, ez = axis(state, p, joint.parent_frame, r - linear + (0 if kind in RIGID else 1))
    return ex, ey, ez, 0.0, 0.0, 0.0


@kernel
def inverse_inertias(system, state, work):
    """Write the inverse inertia (xx, xy, xz, yy, yz, zz) of each body in world axes."""
    for b in range(system.bodies.shape[0]):
        inverse, t = work.body[b].inverse, inverse_inertia(system.bodies[b], state[b].Q)
        inverse[0], inverse[1], inverse[2], inverse[3], inverse[4], inverse[5] = t


@kernel
def inverse_inertia(body, q):
    """Return the inverse inertia (xx, xy, xz, yy, yz, zz) of a body in world axes."""
    J = body.inertia
    i = (1.0 / J[0], 1.0 / J[1], 1.0 / J[2])
    return spin_tensor(matrix(q), i)


@kernel
def symmetric_times(i, x, y, z):
    """Return the product of a symmetric matrix (xx, xy, xz, yy, yz, zz) with a vector."""
    return (
        i[0] * x + i[1] * y + i[2] * z,
        i[1] * x + i[3] * y + i[4] * z,
        i[2] * x + i[4] * y + i[5] * z,
    )


@kernel
def times_inverse_mass(mass, i, f, out):
    """Write M^-1 of a body (mass, inverse inertia i) times a wrench f (force, torque)."""
    g = 1.0 / mass
    out[0], out[1], out[2] = g * f[0], g * f[1], g * f[2]
    out[3], out[4], out[5] = symmetric_times(i, f[3], f[4], f[5])


@kernel
def joint_rows(system, j, state, work):
    """Write A and A M^-1 of a joint into the solver's arrays."""
    joint, sides, first = system.joints[j], system.solver.sides, system.solver.rows[j].first
    cx, cy, cz = child_arm(joint, state)
    px, py, pz = parent_arm(joint, state)
    for r in range(joint.rows):
        ax, ay, az, lx, ly, lz = direction(joint, r, state)
        tx, ty, tz = cross(cx, cy, cz, lx, ly, lz)
        write_row(system, sides[first], r, (lx, ly, lz, tx + ax, ty + ay, tz + az), work)
        if joint.parent >= 0:
            tx, ty, tz = cross(px, py, pz, lx, ly, lz)
            row = (-lx, -ly, -lz, -tx - ax, -ty - ay, -tz - az)
            write_row(system, sides[first + 1], r, row, work)


@kernel
def write_row(system, side, r, row, work):
    """Store one row for one body, and the row times M^-1."""
    A = side.A
    A[r, 0], A[r, 1], A[r, 2], A[r, 3], A[r, 4], A[r, 5] = row
    mass_row(system, side, r, work)


@kernel
def mass_row(system, side, r, work):
    """Write the product of a stored row and M^-1."""
    b = side.body
    times_inverse_mass(system.bodies[b].mass, work.body[b].inverse, side.A[r], side.Y[r])


@kernel
def joint_target(joint, state, relative, out):
    """Write out[r] = t_r . relative (angular, linear): the component of a relative motion along each row."""
    for r in range(joint.rows):
        d = direction(joint, r, state)
        s = 0.0
        for k in range(6):
            s += d[k] * relative[k]
        out[r] = s
