"""Back end for forests of joints: articulated-body elimination in world axes, O(N).

One solve gives the accelerations (or velocity changes, or displacements) A of all bodies for which

    M A = wrench + reactions,      relative motion of each joint - bias  in its freedoms S,

for the given wrench of each body and bias of each joint. With forces and centripetal terms it is the
equation of motion; with an impulse and no bias it is P G^T; with no wrench and minus an error of
position or velocity it is the correction that is shortest in the kinetic metric. (Featherstone 1983, in
absolute coordinates; freedoms are eliminated one at a time, rank one each.)

It has two parts. `articulate` depends only on the pose: from the leaves to the roots it computes the inertia I
of a body and of all bodies that it carries, U = I S, D = S.U, and adds the rest, I - U U^T/D, to the parent.
`respond` computes the motion from wrenches and biases: it splits A = A' + B, where B is the motion with all
freedoms locked (the biases summed from the root); then A' follows from the same elimination, of wrench - M B
without a bias:

    p = M B - wrench,   u = -S.p,   p + U u/D to the parent;    A' = X A'_parent + S (u - U.(X A'_parent))/D.

A row of workspace contains for each body: 0-6 the pose that it was articulated in, 7-12 its own inertia about
its centre, world axes; 13-15 arm of the child, 16-18 centre of the child from the parent's; 19-39 the
articulated inertia (19-24 M, 25-33 H, 34-39 I: f = M a + H alpha, t = H^T a + I alpha); 40-45 B; 46-51 p; then
14 for each freedom: S (6), U (6), 1/D, u.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.geometry.rotation import cross, matrix, spin_tensor
from carom.kinematics.joints import axis, child_arm, parent_arm
from carom.kinematics.pose import keep_pose, same_pose
from carom.model.arrays import ALONG, BALL, HEAD, REVOLUTE, SCREW, TURNING, UNIVERSAL, WIDTH, WITHIN


@kernel
def dot(a, b):
    """Return a.b, summed in pairs: along a chain each sum waits for the one before; latency sets the time."""
    return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]) + (a[4] * b[4] + a[5] * b[5])


@kernel
def six(row, k):
    """Return six numbers of a row, from place k on."""
    return row[k], row[k + 1], row[k + 2], row[k + 3], row[k + 4], row[k + 5]


@kernel
def own_inertia(body, state, row):
    """Start the row of a body: its pose, and its own inertia in world axes."""
    keep_pose(state, row)
    q, m, i = state.Q, body.mass, body.inertia
    R = matrix(q)
    xx, xy, xz, yy, yz, zz = spin_tensor(R, (i[0], i[1], i[2]))
    row[7], row[8], row[9], row[10], row[11], row[12] = xx, xy, xz, yy, yz, zz
    row[19], row[20], row[21], row[22], row[23], row[24] = m, 0.0, 0.0, m, 0.0, m
    for k in range(25, 34):
        row[k] = 0.0
    row[34], row[35], row[36], row[37], row[38], row[39] = xx, xy, xz, yy, yz, zz


@kernel
def turn(row, f, ax, ay, az):
    """Write S of a turn about an axis at the anchor: it moves the centre by r_c x a (r_c: centre to anchor)."""
    row[f], row[f + 1], row[f + 2] = cross(row[13], row[14], row[15], ax, ay, az)
    row[f + 3], row[f + 4], row[f + 5] = ax, ay, az


@kernel
def freedoms(joint, state, row):
    """Write S of each freedom of a joint at the centre of the child."""
    kind = joint.kind
    c, p = joint.child, joint.parent
    if kind == REVOLUTE:  # first, because most joints are of this kind
        ax, ay, az = axis(state, p, joint.parent_frame, 0)
        turn(row, HEAD, ax, ay, az)
        return
    f = HEAD
    for k in range(3):  # slides
        if (k == 0 and kind in ALONG and kind != SCREW) or (k > 0 and kind in WITHIN):
            row[f], row[f + 1], row[f + 2] = axis(state, p, joint.parent_frame, k)
            row[f + 3], row[f + 4], row[f + 5] = 0.0, 0.0, 0.0
            f += WIDTH
    for k in range(3):  # turns
        if kind in BALL or (kind == UNIVERSAL and k == 1):
            ax, ay, az = axis(state, c, joint.child_frame, k)
        elif k == 0 and (kind in TURNING or kind == UNIVERSAL):
            ax, ay, az = axis(state, p, joint.parent_frame, 0)
        else:
            continue
        turn(row, f, ax, ay, az)
        if kind == SCREW:
            row[f] += joint.length * ax
            row[f + 1] += joint.length * ay
            row[f + 2] += joint.length * az
        f += WIDTH


@kernel
def eliminate(row, count, rotor):
    """Eliminate the freedoms of a body, whose S are written; return the remaining inertia (21).

    An inertia I_a along a freedom is added to D: S.U q'' + I_a q'' = u.
    """
    m0, m1, m2, m3, m4, m5 = row[19], row[20], row[21], row[22], row[23], row[24]
    h0, h1, h2, h3, h4 = row[25], row[26], row[27], row[28], row[29]
    h5, h6, h7, h8 = row[30], row[31], row[32], row[33]
    i0, i1, i2, i3, i4, i5 = row[34], row[35], row[36], row[37], row[38], row[39]
    for k in range(count):
        f = HEAD + WIDTH * k
        s = six(row, f)
        u0 = dot((m0, m1, m2, h0, h1, h2), s)
        u1 = dot((m1, m3, m4, h3, h4, h5), s)
        u2 = dot((m2, m4, m5, h6, h7, h8), s)
        u3 = dot((h0, h3, h6, i0, i1, i2), s)
        u4 = dot((h1, h4, h7, i1, i3, i4), s)
        u5 = dot((h2, h5, h8, i2, i4, i5), s)
        g = 1.0 / (dot(s, (u0, u1, u2, u3, u4, u5)) + rotor[k])
        row[f + 6], row[f + 7], row[f + 8] = u0, u1, u2
        row[f + 9], row[f + 10], row[f + 11] = u3, u4, u5
        row[f + 12] = g
        a0, a1, a2, a3, a4, a5 = g * u0, g * u1, g * u2, g * u3, g * u4, g * u5
        m0, m1, m2 = m0 - a0 * u0, m1 - a0 * u1, m2 - a0 * u2
        m3, m4, m5 = m3 - a1 * u1, m4 - a1 * u2, m5 - a2 * u2
        h0, h1, h2 = h0 - a0 * u3, h1 - a0 * u4, h2 - a0 * u5
        h3, h4, h5 = h3 - a1 * u3, h4 - a1 * u4, h5 - a1 * u5
        h6, h7, h8 = h6 - a2 * u3, h7 - a2 * u4, h8 - a2 * u5
        i0, i1, i2 = i0 - a3 * u3, i1 - a3 * u4, i2 - a3 * u5
        i3, i4, i5 = i3 - a4 * u4, i4 - a4 * u5, i5 - a5 * u5
    return (
        m0, m1, m2, m3, m4, m5, h0, h1, h2, h3, h4, h5, h6, h7, h8, i0, i1, i2, i3, i4, i5,
    )  # fmt: skip


@kernel
def shift_to_parent(left, row, above):
    """Add the remaining inertia of a child to its parent's row `above`.

    With d from the parent's centre to the child's: H' = H - M hat(d), I' = I - H^T hat(d) + hat(d) H'.
    """
    m0, m1, m2, m3, m4, m5, h0, h1, h2, h3, h4, h5, h6, h7, h8, i0, i1, i2, i3, i4, i5 = left
    dx, dy, dz = row[16], row[17], row[18]
    g0, g1, g2 = h0 - (m1 * dz - m2 * dy), h1 - (m2 * dx - m0 * dz), h2 - (m0 * dy - m1 * dx)
    g3, g4, g5 = h3 - (m3 * dz - m4 * dy), h4 - (m4 * dx - m1 * dz), h5 - (m1 * dy - m3 * dx)
    g6, g7, g8 = h6 - (m4 * dz - m5 * dy), h7 - (m5 * dx - m2 * dz), h8 - (m2 * dy - m4 * dx)
    above[19] += m0
    above[20] += m1
    above[21] += m2
    above[22] += m3
    above[23] += m4
    above[24] += m5
    above[25] += g0
    above[26] += g1
    above[27] += g2
    above[28] += g3
    above[29] += g4
    above[30] += g5
    above[31] += g6
    above[32] += g7
    above[33] += g8
    above[34] += i0 - (h3 * dz - h6 * dy) + (dy * g6 - dz * g3)
    above[35] += i1 - (h6 * dx - h0 * dz) + (dy * g7 - dz * g4)
    above[36] += i2 - (h0 * dy - h3 * dx) + (dy * g8 - dz * g5)
    above[37] += i3 - (h7 * dx - h1 * dz) + (dz * g1 - dx * g7)
    above[38] += i4 - (h1 * dy - h4 * dx) + (dz * g2 - dx * g8)
    above[39] += i5 - (h2 * dy - h5 * dx) + (dx * g5 - dy * g2)


@kernel
def articulate(system, state):
    """Eliminate the freedoms of all joints from the inertias, leaves first."""
    links, workspace, joints = system.solver.links, system.solver.workspace, system.joints
    for i in range(links.shape[0]):
        b = links[i].order
        row, j = workspace[b], links[b].joint
        own_inertia(system.bodies[b], state[b], row)
        if j >= 0:
            joint = joints[j]
            rx, ry, rz = child_arm(joint, state)
            px, py, pz = parent_arm(joint, state)
            row[13], row[14], row[15] = rx, ry, rz
            row[16], row[17], row[18] = px - rx, py - ry, pz - rz
            freedoms(joint, state, row)
        elif links[b].has_child == 1:  # a floating body has six
            for k in range(36):
                row[HEAD + WIDTH * (k // 6) + k % 6] = 1.0 if k // 6 == k % 6 else 0.0
    for i in range(links.shape[0] - 1, -1, -1):
        b = links[i].order
        link, row = links[b], workspace[b]
        if link.joint >= 0 or link.has_child == 1:
            left = eliminate(row, link.freedoms, system.solver.rotor[b])
            if link.parent >= 0:
                shift_to_parent(left, row, workspace[link.parent])


@kernel
def lock(system, biased, work):
    """Write B of each body, its motion with all freedoms locked, and p = M B - wrench."""
    links, workspace = system.solver.links, system.solver.workspace
    for i in range(links.shape[0]):
        b = links[i].order
        link, row, wrench = links[b], workspace[b], work.body[b].wrench
        p0, p1, p2, p3, p4, p5 = (
            -wrench[0], -wrench[1], -wrench[2], -wrench[3], -wrench[4], -wrench[5],
        )  # fmt: skip
        if biased:
            l0, l1, l2, a0, a1, a2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            if link.joint >= 0:
                bias = work.joint[link.joint].bias
                a0, a1, a2 = bias[0], bias[1], bias[2]
                tx, ty, tz = cross(row[13], row[14], row[15], a0, a1, a2)
                l0, l1, l2 = bias[3] + tx, bias[4] + ty, bias[5] + tz
                if link.parent >= 0:
                    up = workspace[link.parent]
                    w0, w1, w2 = up[43], up[44], up[45]
                    tx, ty, tz = cross(w0, w1, w2, row[16], row[17], row[18])
                    l0, l1, l2 = l0 + up[40] + tx, l1 + up[41] + ty, l2 + up[42] + tz
                    a0, a1, a2 = a0 + w0, a1 + w1, a2 + w2
            row[40], row[41], row[42], row[43], row[44], row[45] = l0, l1, l2, a0, a1, a2
            m = system.bodies[b].mass
            p0, p1, p2 = p0 + m * l0, p1 + m * l1, p2 + m * l2
            p3 += row[7] * a0 + row[8] * a1 + row[9] * a2
            p4 += row[8] * a0 + row[10] * a1 + row[11] * a2
            p5 += row[9] * a0 + row[11] * a1 + row[12] * a2
        row[46], row[47], row[48], row[49], row[50], row[51] = p0, p1, p2, p3, p4, p5


@kernel
def inward(system):
    """Eliminate the freedoms from p, leaves first, and write u of each."""
    links, workspace = system.solver.links, system.solver.workspace
    for i in range(links.shape[0] - 1, -1, -1):
        b = links[i].order
        link, row = links[b], workspace[b]
        if link.joint < 0 and link.has_child == 0:
            continue
        p0, p1, p2, p3, p4, p5 = row[46], row[47], row[48], row[49], row[50], row[51]
        for k in range(link.freedoms):
            f = HEAD + WIDTH * k
            u = dot(six(row, f), (p0, p1, p2, p3, p4, p5))
            row[f + 13] = -u
            u *= -row[f + 12]
            p0, p1, p2 = p0 + row[f + 6] * u, p1 + row[f + 7] * u, p2 + row[f + 8] * u
            p3, p4, p5 = p3 + row[f + 9] * u, p4 + row[f + 10] * u, p5 + row[f + 11] * u
        if link.parent >= 0:
            above = workspace[link.parent]
            tx, ty, tz = cross(row[16], row[17], row[18], p0, p1, p2)
            above[46] += p0
            above[47] += p1
            above[48] += p2
            above[49] += p3 + tx
            above[50] += p4 + ty
            above[51] += p5 + tz


@kernel
def outward(system, biased, work):
    """Find the motion of each body from that of its parent, freedoms in reverse order."""
    links, workspace = system.solver.links, system.solver.workspace
    for i in range(links.shape[0]):
        b = links[i].order
        link, row, out = links[b], workspace[b], work.body[b].motion
        if link.joint < 0 and link.has_child == 0:
            unjoined(system.bodies[b].mass, row, out)
            continue
        a0, a1, a2, a3, a4, a5 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        if link.parent >= 0:  # p is replaced by A' from here on
            up = workspace[link.parent]
            a3, a4, a5 = up[49], up[50], up[51]
            tx, ty, tz = cross(a3, a4, a5, row[16], row[17], row[18])
            a0, a1, a2 = up[46] + tx, up[47] + ty, up[48] + tz
        for k in range(link.freedoms - 1, -1, -1):
            f = HEAD + WIDTH * k
            s = dot(six(row, f + 6), (a0, a1, a2, a3, a4, a5))
            qdd = (row[f + 13] - s) * row[f + 12]
            a0, a1, a2 = a0 + row[f] * qdd, a1 + row[f + 1] * qdd, a2 + row[f + 2] * qdd
            a3, a4, a5 = a3 + row[f + 3] * qdd, a4 + row[f + 4] * qdd, a5 + row[f + 5] * qdd
        row[46], row[47], row[48], row[49], row[50], row[51] = a0, a1, a2, a3, a4, a5
        if biased:
            a0, a1, a2 = a0 + row[40], a1 + row[41], a2 + row[42]
            a3, a4, a5 = a3 + row[43], a4 + row[44], a5 + row[45]
        out[0], out[1], out[2], out[3], out[4], out[5] = a0, a1, a2, a3, a4, a5


@kernel
def unjoined(mass, row, out):
    """Write the motion of a body without joints: f = m a, t = I alpha, the inverse of I by cofactors."""
    g = -1.0 / mass
    out[0], out[1], out[2] = g * row[46], g * row[47], g * row[48]
    xx, xy, xz, yy, yz, zz = row[7], row[8], row[9], row[10], row[11], row[12]
    cx, cy, cz = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    g = -1.0 / (xx * cx + xy * cy + xz * cz)
    tx, ty, tz = row[49], row[50], row[51]
    out[3] = g * (cx * tx + cy * ty + cz * tz)
    out[4] = g * (cy * tx + (xx * zz - xz * xz) * ty + (xy * xz - xx * yz) * tz)
    out[5] = g * (cz * tx + (xy * xz - xx * yz) * ty + (xx * yy - xy * xy) * tz)


@unit
def solve_tree(system, state, biased, near, work):
    """Write the motion of all bodies; articulate the pose first, unless the last pose is the same or `near`."""
    if not near and not same_pose(system.solver.workspace, state):
        articulate(system, state)
    respond(system, biased, work)


@kernel
def respond(system, biased, work):
    """Write the motion of all bodies in the pose that was last articulated."""
    lock(system, biased, work)
    inward(system)
    outward(system, biased, work)


@kernel
def take_rotor_out(row, f, reaction):
    """Remove the force of an inertia along a freedom from the reaction: joints do no work along S."""
    s = dot(six(row, f), six(row, 46))
    ax, ay, az = row[f + 3], row[f + 4], row[f + 5]
    first = 3
    if ax == 0.0 and ay == 0.0 and az == 0.0:  # a slide
        ax, ay, az = row[f], row[f + 1], row[f + 2]
        first = 0
    reaction[first] -= s * ax
    reaction[first + 1] -= s * ay
    reaction[first + 2] -= s * az


@kernel
def joint_wrenches(system, work):
    """Write the wrench of each joint on its child at its anchor: M motion - wrench, summed from the leaves."""
    links, workspace = system.solver.links, system.solver.workspace
    for i in range(links.shape[0]):
        b = links[i].order
        row, a, f = workspace[b], work.body[b].motion, work.body[b].wrench
        m = system.bodies[b].mass
        for k in range(3):
            row[46 + k] = m * a[k] - f[k]
        row[49] = row[7] * a[3] + row[8] * a[4] + row[9] * a[5] - f[3]
        row[50] = row[8] * a[3] + row[10] * a[4] + row[11] * a[5] - f[4]
        row[51] = row[9] * a[3] + row[11] * a[4] + row[12] * a[5] - f[5]
    for i in range(links.shape[0] - 1, -1, -1):
        b = links[i].order
        row, link = workspace[b], links[b]
        if link.joint < 0:
            continue
        fx, fy, fz = row[46], row[47], row[48]
        reaction = work.joint[link.joint].reaction
        tx, ty, tz = cross(row[13], row[14], row[15], fx, fy, fz)
        reaction[0], reaction[1], reaction[2] = fx, fy, fz
        reaction[3], reaction[4], reaction[5] = row[49] - tx, row[50] - ty, row[51] - tz
        for k in range(link.freedoms):
            if system.solver.rotor[b, k] > 0.0:
                take_rotor_out(row, HEAD + WIDTH * k, reaction)
        if link.parent >= 0:
            above = workspace[link.parent]
            tx, ty, tz = cross(row[16], row[17], row[18], fx, fy, fz)
            above[46] += fx
            above[47] += fy
            above[48] += fz
            above[49] += row[49] + tx
            above[50] += row[50] + ty
            above[51] += row[51] + tz
