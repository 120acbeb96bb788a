"""Accelerations of all bodies: applied forces, joints, and the forces of held contacts.

A held contact answers with lam = (N, T). While it slips, T = -mu N u_t/|u_t| and the normal row of
du/dt vanishes; while it sticks (or rolls) all three rows vanish. Contacts that share a mechanism are
brought together by block Gauss-Seidel.
"""

from __future__ import annotations

import math

from carom.jit import kernel
from carom.motion.contact_point import (
    add_acceleration,
    contact_acceleration,
    contact_arm,
    contact_velocity,
    effective_inverse_mass,
    spread,
)
from carom.motion.forces import applied_wrenches
from carom.motion.joints import acceleration_bias
from carom.motion.solve import solve

OPEN, SLIP, STICK = range(3)


@kernel
def acceleration(system, x, Q, v, w, held, work, acc):
    """Write the accelerations (N, 6); return the powers of loads without potential and of friction."""
    applied = applied_wrenches(system, x, Q, v, w, work.wrench)
    for j in range(system.joints.kind.size):
        acceleration_bias(system.joints, j, x, Q, v, w, work.bias)
    solve(system, x, Q, work.wrench, work.bias, acc, work.reaction)
    friction = 0.0
    count, jointed = 0, 0
    for c in range(held.mode.size):
        if held.mode[c] != OPEN:
            p = held.point[c]
            rx, ry, rz = contact_arm(system, c, Q, p[0], p[1], p[2])
            effective_inverse_mass(system, c, x, Q, rx, ry, rz, work, work.W[c])
            for k in range(3):
                held.force[c, k] = 0.0
            count += 1
            jointed += 1 - system.bodies.isolated[system.contacts.body[c]]
    if count == 0:
        return applied, friction
    for _sweep in range(1 if jointed < 2 and count == 1 else 200):
        change, largest = 0.0, 0.0
        for c in range(held.mode.size):
            if held.mode[c] != OPEN:
                change = max(change, relax(system, c, x, Q, v, w, held, work, acc))
                largest = max(largest, abs(held.force[c, 0]))
        if not (change > 1e-15 * largest):
            break
    for c in range(held.mode.size):
        if held.mode[c] == SLIP:
            p, f = held.point[c], held.force[c]
            rx, ry, rz = contact_arm(system, c, Q, p[0], p[1], p[2])
            u = contact_velocity(system, c, v, w, rx, ry, rz)
            friction += f[1] * u[1] + f[2] * u[2]
    return applied, friction


@kernel
def relax(system, c, x, Q, v, w, held, work, acc):
    """Change the force of held contact c so that its own rows are met; return the change."""
    p, f, W = held.point[c], held.force[c], work.W[c]
    rx, ry, rz = contact_arm(system, c, Q, p[0], p[1], p[2])
    a = contact_acceleration(system, c, Q, w, acc, p[0], p[1], p[2], rx, ry, rz)
    # what the acceleration would be without this contact's own force
    an = a[0] - W[0, 0] * f[0] - W[0, 1] * f[1] - W[0, 2] * f[2]
    a1 = a[1] - W[1, 0] * f[0] - W[1, 1] * f[1] - W[1, 2] * f[2]
    a2 = a[2] - W[2, 0] * f[0] - W[2, 1] * f[1] - W[2, 2] * f[2]
    if held.mode[c] == STICK:
        n, t1, t2 = stick_force(W, an, a1, a2)
    else:
        u = contact_velocity(system, c, v, w, rx, ry, rz)
        n, t1, t2 = slip_force(W, an, a1, a2, u[1], u[2], system.contacts.friction[c])
    spread(system, c, x, Q, rx, ry, rz, n - f[0], t1 - f[1], t2 - f[2], work)
    add_acceleration(system, c, work, acc)
    change = max(abs(n - f[0]), abs(t1 - f[1]), abs(t2 - f[2]))
    f[0], f[1], f[2] = n, t1, t2
    return change


@kernel
def stick_force(W, an, a1, a2):
    """Return lam with W lam = -a. A tangent direction of no compliance (W_ii = 0) gets no force."""
    # symmetric elimination, normal first; a pivot at round-off of its diagonal is left out
    l10, l20 = W[1, 0] / W[0, 0], W[2, 0] / W[0, 0]
    d1 = W[1, 1] - l10 * W[1, 0]
    c21 = W[2, 1] - l20 * W[1, 0]
    y0, y1, y2 = -an, -a1 + l10 * an, -a2 + l20 * an
    free1 = d1 > 1e-13 * W[1, 1]
    l21 = c21 / d1 if free1 else 0.0
    d2 = W[2, 2] - l20 * W[2, 0] - l21 * c21
    y2 -= l21 * y1
    t2 = y2 / d2 if d2 > 1e-13 * W[2, 2] else 0.0
    t1 = y1 / d1 - l21 * t2 if free1 else 0.0
    n = y0 / W[0, 0] - l10 * t1 - l20 * t2
    return n, t1, t2


@kernel
def slip_force(W, an, a1, a2, u1, u2, mu):
    """Return lam = N (1, -mu e) with the normal row at rest; e along the slip, or where slip will start.

    N = -a_n / (W_nn - mu W_nt.e). At u_t = 0 the direction is that of the slip acceleration itself,
    e = (a_t + N (W_tn - mu W_tt e))/|..|, the fixed point from the stick force.
    """
    speed = math.sqrt(u1 * u1 + u2 * u2)
    if speed > 0.0:
        e1, e2 = u1 / speed, u2 / speed
        n = -an / (W[0, 0] - mu * (W[0, 1] * e1 + W[0, 2] * e2))
        return n, -mu * n * e1, -mu * n * e2
    n, t1, t2 = stick_force(W, an, a1, a2)
    size = math.sqrt(t1 * t1 + t2 * t2)
    if size <= mu * n or size == 0.0:
        return n, t1, t2
    e1, e2 = -t1 / size, -t2 / size
    for _ in range(100):
        n = -an / (W[0, 0] - mu * (W[0, 1] * e1 + W[0, 2] * e2))
        d1 = a1 + n * (W[1, 0] - mu * (W[1, 1] * e1 + W[1, 2] * e2))
        d2 = a2 + n * (W[2, 0] - mu * (W[2, 1] * e1 + W[2, 2] * e2))
        size = math.sqrt(d1 * d1 + d2 * d2)
        if size == 0.0:
            break
        change = abs(d1 / size - e1) + abs(d2 / size - e2)
        e1, e2 = d1 / size, d2 / size
        if change < 1e-14:
            break
    return n, -mu * n * e1, -mu * n * e2
