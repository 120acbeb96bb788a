"""A point of contact: its arm, velocity, effective inverse mass W = G P G^T, and what an impulse does.

G maps the velocities of all bodies to u = (u_n, u_t1, u_t2) at the point, P is the inverse mass with the
joints active. (Paper, change of coordinates at contact.)
"""

from __future__ import annotations

from carom.geometry.rotation import cross, rotate
from carom.jit import kernel
from carom.motion.solve import solve, write_free


@kernel
def contact_arm(system, c, Q, px, py, pz):
    """Return the arm of the contact point of the core point p (body axes): R p - radius n."""
    contacts = system.contacts
    b = contacts.body[c]
    rx, ry, rz = rotate(Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3], px, py, pz)
    r, n = contacts.radius[c], contacts.axes[c]
    return rx - r * n[0, 0], ry - r * n[0, 1], rz - r * n[0, 2]


@kernel
def point_gap(system, c, x, rx, ry, rz):
    """Return the gap of the point at arm r."""
    b, n = system.contacts.body[c], system.contacts.axes[c]
    s = n[0, 0] * (x[b, 0] + rx) + n[0, 1] * (x[b, 1] + ry) + n[0, 2] * (x[b, 2] + rz)
    return s - system.contacts.offset[c]


@kernel
def contact_velocity(system, c, v, w, rx, ry, rz):
    """Return u = G v of the point at arm r, in contact axes."""
    b, E = system.contacts.body[c], system.contacts.axes[c]
    ux, uy, uz = cross(w[b, 0], w[b, 1], w[b, 2], rx, ry, rz)
    ux, uy, uz = ux + v[b, 0], uy + v[b, 1], uz + v[b, 2]
    return (
        E[0, 0] * ux + E[0, 1] * uy + E[0, 2] * uz,
        E[1, 0] * ux + E[1, 1] * uy + E[1, 2] * uz,
        E[2, 0] * ux + E[2, 1] * uy + E[2, 2] * uz,
    )


@kernel
def contact_acceleration(system, c, Q, w, acc, px, py, pz, rx, ry, rz):
    """Return du/dt in contact axes: a + alpha x r + w x (w x R p) (the ball around p does not turn r)."""
    b, E = system.contacts.body[c], system.contacts.axes[c]
    cx, cy, cz = rotate(Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3], px, py, pz)
    cx, cy, cz = cross(w[b, 0], w[b, 1], w[b, 2], cx, cy, cz)
    cx, cy, cz = cross(w[b, 0], w[b, 1], w[b, 2], cx, cy, cz)
    tx, ty, tz = cross(acc[b, 3], acc[b, 4], acc[b, 5], rx, ry, rz)
    ux, uy, uz = acc[b, 0] + tx + cx, acc[b, 1] + ty + cy, acc[b, 2] + tz + cz
    return (
        E[0, 0] * ux + E[0, 1] * uy + E[0, 2] * uz,
        E[1, 0] * ux + E[1, 1] * uy + E[1, 2] * uz,
        E[2, 0] * ux + E[2, 1] * uy + E[2, 2] * uz,
    )


@kernel
def spread(system, c, x, Q, rx, ry, rz, ln, l1, l2, work):
    """Write work.delta = P G^T lam for lam = (ln, l1, l2); only the own body if nothing is joined to it."""
    b, E = system.contacts.body[c], system.contacts.axes[c]
    fx = E[0, 0] * ln + E[1, 0] * l1 + E[2, 0] * l2
    fy = E[0, 1] * ln + E[1, 1] * l1 + E[2, 1] * l2
    fz = E[0, 2] * ln + E[1, 2] * l1 + E[2, 2] * l2
    tx, ty, tz = cross(rx, ry, rz, fx, fy, fz)
    wrench = work.wrench
    if system.bodies.isolated[b] == 0:
        wrench[:] = 0.0
    wrench[b, 0], wrench[b, 1], wrench[b, 2] = fx, fy, fz
    wrench[b, 3], wrench[b, 4], wrench[b, 5] = tx, ty, tz
    if system.bodies.isolated[b] == 1:
        write_free(
            system.bodies.mass[b], system.bodies.inertia[b], Q[b], wrench[b], work.delta[b]
        )
    else:
        solve(system, x, Q, wrench, work.zero, work.delta, work.reaction)


@kernel
def effective_inverse_mass(system, c, x, Q, rx, ry, rz, work, W):
    """Write W = G P G^T (3, 3) of the point at arm r. Columns are answers to unit impulses."""
    b, E = system.contacts.body[c], system.contacts.axes[c]
    for k in range(3):
        one = 1.0
        spread(system, c, x, Q, rx, ry, rz, one if k == 0 else 0.0, one if k == 1 else 0.0,
               one if k == 2 else 0.0, work)  # fmt: skip
        d = work.delta[b]
        ux, uy, uz = cross(d[3], d[4], d[5], rx, ry, rz)
        ux, uy, uz = ux + d[0], uy + d[1], uz + d[2]
        for i in range(3):
            W[i, k] = E[i, 0] * ux + E[i, 1] * uy + E[i, 2] * uz
    for i in range(3):
        for k in range(i):
            m = 0.5 * (W[i, k] + W[k, i])
            W[i, k], W[k, i] = m, m


@kernel
def add_velocity(system, c, work, v, w):
    """Add work.delta to the velocities of all bodies (of the own body if nothing is joined to it)."""
    b = system.contacts.body[c]
    first, last = (b, b + 1) if system.bodies.isolated[b] == 1 else (0, v.shape[0])
    for i in range(first, last):
        for k in range(3):
            v[i, k] += work.delta[i, k]
            w[i, k] += work.delta[i, 3 + k]


@kernel
def add_acceleration(system, c, work, acc):
    """Add work.delta to the accelerations (N, 6), as `add_velocity` does to velocities."""
    b = system.contacts.body[c]
    first, last = (b, b + 1) if system.bodies.isolated[b] == 1 else (0, acc.shape[0])
    for i in range(first, last):
        for k in range(6):
            acc[i, k] += work.delta[i, k]
