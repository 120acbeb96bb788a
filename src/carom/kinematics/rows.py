"""Constraint rows of joints for systems with closed loops: A (rows) and A M^-1.

Row r of joint j takes the part t_r of the joint's relative motion (angular t_a, linear t_l): on the
child [t_l, r_c x t_l + t_a], on the parent minus the same with its own arm.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross, matrix, spin_tensor
from carom.kinematics.joints import anchor_gap, axis, child_arm, parent_arm
from carom.model.arrays import (
    ALONG,
    DISTANCE,
    KNIFE_EDGE,
    RIGID,
    SCREW,
    UNIVERSAL,
    WITHIN,
)


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
            if r == 2:  # along it as the child turns
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
    if kind == UNIVERSAL:  # no turning about the normal of both axes
        ax, ay, az = axis(state, p, joint.parent_frame, 0)
        bx, by, bz = axis(state, joint.child, joint.child_frame, 1)
        ex, ey, ez = cross(ax, ay, az, bx, by, bz)
        return ex, ey, ez, 0.0, 0.0, 0.0
    # where the first axis is shared: no turning about the second and third; else about none
    ex, ey, ez = axis(state, p, joint.parent_frame, r - linear + (0 if kind in RIGID else 1))
    return ex, ey, ez, 0.0, 0.0, 0.0


@kernel
def inverse_inertias(system, state, work):
    """Write the inverse inertia (xx, xy, xz, yy, yz, zz) of each body in world axes."""
    for b in range(system.bodies.shape[0]):
        J, q, inverse = system.bodies[b].inertia, state[b].Q, work.body[b].inverse
        R = matrix(q[0], q[1], q[2], q[3])
        t = spin_tensor(
            R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8],
            1.0 / J[0], 1.0 / J[1], 1.0 / J[2],
        )  # fmt: skip
        for k in range(6):
            inverse[k] = t[k]


@kernel
def times_inverse_mass(mass, i, f0, f1, f2, t0, t1, t2):
    """Return M^-1 of a body (mass, inverse inertia i) times a wrench (force, torque)."""
    g = 1.0 / mass
    return (
        g * f0,
        g * f1,
        g * f2,
        i[0] * t0 + i[1] * t1 + i[2] * t2,
        i[1] * t0 + i[3] * t1 + i[4] * t2,
        i[2] * t0 + i[4] * t1 + i[5] * t2,
    )


@kernel
def joint_rows(system, j, state, work):
    """Write A and A M^-1 of a joint into the solver's arrays."""
    bodies, joint, first = system.bodies, system.joints[j], system.solver.rows[j].first
    c, p = joint.child, joint.parent
    cx, cy, cz = child_arm(joint, state)
    px, py, pz = parent_arm(joint, state)
    for r in range(joint.rows):
        ax, ay, az, lx, ly, lz = direction(joint, r, state)
        tx, ty, tz = cross(cx, cy, cz, lx, ly, lz)
        inverse, side = work.body[c].inverse, system.solver.sides[first]
        write_row(side, bodies[c].mass, inverse, r, lx, ly, lz, tx + ax, ty + ay, tz + az)
        if p >= 0:
            tx, ty, tz = cross(px, py, pz, lx, ly, lz)
            inverse, side = work.body[p].inverse, system.solver.sides[first + 1]
            write_row(side, bodies[p].mass, inverse, r, -lx, -ly, -lz, -tx - ax, -ty - ay, -tz - az)


@kernel
def write_row(side, mass, inverse, r, f0, f1, f2, t0, t1, t2):
    """Store one row for one body, and the row times M^-1."""
    A, Y = side.A, side.Y
    A[r, 0], A[r, 1], A[r, 2] = f0, f1, f2
    A[r, 3], A[r, 4], A[r, 5] = t0, t1, t2
    y = times_inverse_mass(mass, inverse, f0, f1, f2, t0, t1, t2)
    for k in range(6):
        Y[r, k] = y[k]


@kernel
def joint_target(joint, state, relative, out):
    """Write out[r] = t_r . relative (angular, linear): what each row says of a relative motion."""
    for r in range(joint.rows):
        d = direction(joint, r, state)
        s = 0.0
        for k in range(6):
            s += d[k] * relative[k]
        out[r] = s
