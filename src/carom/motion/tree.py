"""Back end for forests of joints: articulated-body elimination in world axes, O(N).

One solve gives the accelerations (or velocity changes, or displacements) A of all bodies for which

    M A = wrench + reactions,      relative motion of each joint - bias  in its freedoms S,

for the given wrench of each body and bias of each joint. With forces and centripetal terms it is the
equation of motion; with an impulse and no bias it is P G^T; with no wrench and minus an error of
position or velocity it is the correction that is shortest in the kinetic metric. (Featherstone 1983, in
absolute coordinates; freedoms are eliminated one at a time, rank one each.)

A row of scratch holds for each body: 0-5 M, 6-14 H, 15-20 I (articulated inertia
at the mass centre, f = M a + H alpha, t = H^T a + I alpha), 21-26 force bias, 27-29 arm of the child,
30-32 centre of the child from the parent's, 33-38 motion bias at the centre, then 14 for each freedom:
S (6), U (6), 1/D, u.
"""

from __future__ import annotations

from carom.geometry.rotation import cross, matrix, spin_tensor
from carom.jit import kernel, unit
from carom.motion.joints import axis, child_arm, parent_arm
from carom.system.arrays import (
    ALONG,
    BALL,
    FIRST,
    SCREW,
    TURNING,
    UNIVERSAL,
    WIDTH,
    WITHIN,
)


@kernel
def times(row, al, bl, cl, aw, bw, cw):
    """Return the articulated inertia in `row` times the motion (linear, angular)."""
    return (
        row[0] * al + row[1] * bl + row[2] * cl + row[6] * aw + row[7] * bw + row[8] * cw,
        row[1] * al + row[3] * bl + row[4] * cl + row[9] * aw + row[10] * bw + row[11] * cw,
        row[2] * al + row[4] * bl + row[5] * cl + row[12] * aw + row[13] * bw + row[14] * cw,
        row[6] * al + row[9] * bl + row[12] * cl + row[15] * aw + row[16] * bw + row[17] * cw,
        row[7] * al + row[10] * bl + row[13] * cl + row[16] * aw + row[18] * bw + row[19] * cw,
        row[8] * al + row[11] * bl + row[14] * cl + row[17] * aw + row[19] * bw + row[20] * cw,
    )


@kernel
def eliminate(row, k):
    """Eliminate freedom k, whose S is in place: U = I S, D = S.U, u = -S.p; I -= U U^T/D; p += U u/D."""
    f = FIRST + WIDTH * k
    s0, s1, s2, s3, s4, s5 = row[f], row[f + 1], row[f + 2], row[f + 3], row[f + 4], row[f + 5]
    u0, u1, u2, u3, u4, u5 = times(row, s0, s1, s2, s3, s4, s5)
    D = s0 * u0 + s1 * u1 + s2 * u2 + s3 * u3 + s4 * u4 + s5 * u5
    g = 1.0 / D
    u = -(s0 * row[21] + s1 * row[22] + s2 * row[23] + s3 * row[24] + s4 * row[25] + s5 * row[26])
    row[f + 6], row[f + 7], row[f + 8] = u0, u1, u2
    row[f + 9], row[f + 10], row[f + 11] = u3, u4, u5
    row[f + 12], row[f + 13] = g, u
    a0, a1, a2, a3, a4, a5 = g * u0, g * u1, g * u2, g * u3, g * u4, g * u5
    row[0] -= a0 * u0
    row[1] -= a0 * u1
    row[2] -= a0 * u2
    row[3] -= a1 * u1
    row[4] -= a1 * u2
    row[5] -= a2 * u2
    row[6] -= a0 * u3
    row[7] -= a0 * u4
    row[8] -= a0 * u5
    row[9] -= a1 * u3
    row[10] -= a1 * u4
    row[11] -= a1 * u5
    row[12] -= a2 * u3
    row[13] -= a2 * u4
    row[14] -= a2 * u5
    row[15] -= a3 * u3
    row[16] -= a3 * u4
    row[17] -= a3 * u5
    row[18] -= a4 * u4
    row[19] -= a4 * u5
    row[20] -= a5 * u5
    row[21] += a0 * u
    row[22] += a1 * u
    row[23] += a2 * u
    row[24] += a3 * u
    row[25] += a4 * u
    row[26] += a5 * u


@kernel
def own_inertia(body, q, wrench, row):
    """Start the row of a body: its own inertia in world axes, and minus the wrench on it."""
    R = matrix(q[0], q[1], q[2], q[3])
    m = body.mass
    xx, xy, xz, yy, yz, zz = spin_tensor(
        R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8],
        body.inertia[0], body.inertia[1], body.inertia[2],
    )  # fmt: skip
    row[0], row[1], row[2], row[3], row[4], row[5] = m, 0.0, 0.0, m, 0.0, m
    for k in range(6, 15):
        row[k] = 0.0
    row[15], row[16], row[17], row[18], row[19], row[20] = xx, xy, xz, yy, yz, zz
    for k in range(6):
        row[21 + k] = -wrench[k]


@kernel
def freedoms(joint, state, row):
    """Write S of each freedom of a joint at the centre of the child, and return their number.

    An angular freedom a at the anchor moves the centre by r_c x a (r_c: centre to anchor).
    """
    kind = joint.kind
    c, p = joint.child, joint.parent
    n = 0
    for k in range(3):  # slides
        if (k == 0 and kind in ALONG and kind != SCREW) or (k > 0 and kind in WITHIN):
            f = FIRST + WIDTH * n
            row[f], row[f + 1], row[f + 2] = axis(state, p, joint.parent_frame, k)
            row[f + 3], row[f + 4], row[f + 5] = 0.0, 0.0, 0.0
            n += 1
    for k in range(3):  # turns
        if kind in BALL or (kind == UNIVERSAL and k == 1):
            ax, ay, az = axis(state, c, joint.child_frame, k)
        elif k == 0 and (kind in TURNING or kind == UNIVERSAL):
            ax, ay, az = axis(state, p, joint.parent_frame, 0)
        else:
            continue
        f = FIRST + WIDTH * n
        row[f], row[f + 1], row[f + 2] = cross(row[27], row[28], row[29], ax, ay, az)
        row[f + 3], row[f + 4], row[f + 5] = ax, ay, az
        if kind == SCREW:
            row[f] += joint.length * ax
            row[f + 1] += joint.length * ay
            row[f + 2] += joint.length * az
        n += 1
    return n


@kernel
def shift_to_parent(row, above):
    """Add what is left of the inertia and force of a child to its parent's row `above`."""
    dx, dy, dz = row[30], row[31], row[32]
    # H' = H - M hat(d): columns of -M hat(d) are -(M e) x d with rows taken from M
    m0, m1, m2, m3, m4, m5 = row[0], row[1], row[2], row[3], row[4], row[5]
    g0, g1, g2 = (
        row[6] - (m1 * dz - m2 * dy),
        row[7] - (m2 * dx - m0 * dz),
        row[8] - (m0 * dy - m1 * dx),
    )
    g3, g4, g5 = (
        row[9] - (m3 * dz - m4 * dy),
        row[10] - (m4 * dx - m1 * dz),
        row[11] - (m1 * dy - m3 * dx),
    )
    g6, g7, g8 = (
        row[12] - (m4 * dz - m5 * dy),
        row[13] - (m5 * dx - m2 * dz),
        row[14] - (m2 * dy - m4 * dx),
    )
    above[0] += m0
    above[1] += m1
    above[2] += m2
    above[3] += m3
    above[4] += m4
    above[5] += m5
    above[6] += g0
    above[7] += g1
    above[8] += g2
    above[9] += g3
    above[10] += g4
    above[11] += g5
    above[12] += g6
    above[13] += g7
    above[14] += g8
    # I' = I - H^T hat(d) + hat(d) H'
    h0, h1, h2, h3, h4, h5, h6, h7 = (
        row[6], row[7], row[8], row[9], row[10], row[11], row[12], row[13],
    )  # fmt: skip
    above[15] += row[15] - (h3 * dz - h6 * dy) + (dy * g6 - dz * g3)
    above[16] += row[16] - (h6 * dx - h0 * dz) + (dy * g7 - dz * g4)
    above[17] += row[17] - (h0 * dy - h3 * dx) + (dy * g8 - dz * g5)
    above[18] += row[18] - (h7 * dx - h1 * dz) + (dz * g1 - dx * g7)
    above[19] += row[19] - (h1 * dy - h4 * dx) + (dz * g2 - dx * g8)
    above[20] += row[20] - (h2 * dy - h5 * dx) + (dx * g5 - dy * g2)
    c0, c1, c2, c3, c4, c5 = times(row, row[33], row[34], row[35], row[36], row[37], row[38])
    fx, fy, fz = row[21] + c0, row[22] + c1, row[23] + c2
    tx, ty, tz = cross(dx, dy, dz, fx, fy, fz)
    above[21] += fx
    above[22] += fy
    above[23] += fz
    above[24] += row[24] + c3 + tx
    above[25] += row[25] + c4 + ty
    above[26] += row[26] + c5 + tz


@unit
def solve_tree(system, state, biased, work):
    """Write the motion of all bodies and the wrench of each joint on its child at its anchor."""
    solver, joints = system.solver, system.joints
    links, scratch = solver.links, solver.scratch
    for i in range(links.shape[0]):
        b = links[i].order
        row = scratch[b]
        own_inertia(system.bodies[b], state[b].Q, work.body[b].wrench, row)
        j = links[b].joint
        if j < 0:
            continue
        joint = joints[j]
        rx, ry, rz = child_arm(joint, state)
        row[27], row[28], row[29] = rx, ry, rz
        px, py, pz = parent_arm(joint, state)
        row[30], row[31], row[32] = px - rx, py - ry, pz - rz
        for k in range(33, 39):
            row[k] = 0.0
        if biased:
            bias = work.joint[j].bias
            ax, ay, az = bias[0], bias[1], bias[2]
            tx, ty, tz = cross(rx, ry, rz, ax, ay, az)
            row[33], row[34], row[35] = bias[3] + tx, bias[4] + ty, bias[5] + tz
            row[36], row[37], row[38] = ax, ay, az
        freedoms(joint, state, row)
    for i in range(links.shape[0] - 1, -1, -1):
        b = links[i].order
        if links[b].joint < 0:
            continue
        for k in range(links[b].freedoms):
            eliminate(scratch[b], k)
        if links[b].parent >= 0:
            shift_to_parent(scratch[b], scratch[links[b].parent])
    for i in range(links.shape[0]):
        b = links[i].order
        link, row = links[b], scratch[b]
        if link.joint < 0:
            solve_floating(row, link.has_child, work.body[b].motion)
        else:
            outward(link, row, b, work)


@kernel
def outward(link, row, b, work):
    """Find the motion of body b from that of its parent, freedoms in reverse order."""
    p = link.parent
    a0, a1, a2 = row[33], row[34], row[35]
    a3, a4, a5 = row[36], row[37], row[38]
    if p >= 0:
        up = work.body[p].motion
        tx, ty, tz = cross(up[3], up[4], up[5], row[30], row[31], row[32])
        a0, a1, a2 = a0 + up[0] + tx, a1 + up[1] + ty, a2 + up[2] + tz
        a3, a4, a5 = a3 + up[3], a4 + up[4], a5 + up[5]
    f0, f1, f2, f3, f4, f5 = times(row, a0, a1, a2, a3, a4, a5)
    for k in range(link.freedoms - 1, -1, -1):
        f = FIRST + WIDTH * k
        dot = row[f + 6] * a0 + row[f + 7] * a1 + row[f + 8] * a2
        dot += row[f + 9] * a3 + row[f + 10] * a4 + row[f + 11] * a5
        qdd = (row[f + 13] - dot) * row[f + 12]
        a0, a1, a2 = a0 + row[f] * qdd, a1 + row[f + 1] * qdd, a2 + row[f + 2] * qdd
        a3, a4, a5 = a3 + row[f + 3] * qdd, a4 + row[f + 4] * qdd, a5 + row[f + 5] * qdd
    out = work.body[b].motion
    out[0], out[1], out[2], out[3], out[4], out[5] = a0, a1, a2, a3, a4, a5
    # the wrench that passes the joint: what is left of the inertia, on the motion without freedoms
    reaction = work.joint[link.joint].reaction
    f0, f1, f2 = f0 + row[21], f1 + row[22], f2 + row[23]
    tx, ty, tz = cross(row[27], row[28], row[29], f0, f1, f2)
    reaction[0], reaction[1], reaction[2] = f0, f1, f2
    reaction[3] = f3 + row[24] - tx
    reaction[4] = f4 + row[25] - ty
    reaction[5] = f5 + row[26] - tz


@kernel
def solve_floating(row, has_child, out):
    """Solve the 6 x 6 system of a body that no joint carries."""
    if has_child == 0:
        # uncoupled: f = m a, t = I alpha, the inverse of I by cofactors
        g = 1.0 / row[0]
        out[0], out[1], out[2] = -g * row[21], -g * row[22], -g * row[23]
        xx, xy, xz, yy, yz, zz = row[15], row[16], row[17], row[18], row[19], row[20]
        cx, cy, cz = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
        g = -1.0 / (xx * cx + xy * cy + xz * cz)
        tx, ty, tz = row[24], row[25], row[26]
        out[3] = g * (cx * tx + cy * ty + cz * tz)
        out[4] = g * (cy * tx + (xx * zz - xz * xz) * ty + (xy * xz - xx * yz) * tz)
        out[5] = g * (cz * tx + (xy * xz - xx * yz) * ty + (xx * yy - xy * xy) * tz)
        return
    for k in range(6):
        f = FIRST + WIDTH * k
        for i in range(6):
            row[f + i] = 1.0 if i == k else 0.0
        eliminate(row, k)
    for i in range(6):
        out[i] = 0.0
    for k in range(5, -1, -1):
        f = FIRST + WIDTH * k
        dot = 0.0
        for i in range(6):
            dot += row[f + 6 + i] * out[i]
        out[k] += (row[f + 13] - dot) * row[f + 12]
