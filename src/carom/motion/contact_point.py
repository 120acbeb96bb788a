"""A point of contact: its arm, velocity, effective inverse mass W = G P G^T, and what an impulse does.

G maps the velocities of all bodies to u = (u_n, u_t1, u_t2) at the point, P is the inverse mass with the
joints active. (Paper, change of coordinates at contact.)
"""

from __future__ import annotations

from carom.geometry.rotation import cross, rotate
from carom.jit import kernel
from carom.motion.forces import point_velocity
from carom.motion.solve import free_body, solve


@kernel
def contact_arm(contact, state, p):
    """Return the arm of the contact point of the core point p (body axes): R p - radius n."""
    q, n, r = state[contact.body].Q, contact.axes, contact.radius
    rx, ry, rz = rotate(q[0], q[1], q[2], q[3], p[0], p[1], p[2])
    return rx - r * n[0, 0], ry - r * n[0, 1], rz - r * n[0, 2]


@kernel
def in_contact_axes(contact, ax, ay, az):
    """Return the components (normal, tangent 1, tangent 2) of a world vector."""
    E = contact.axes
    return (
        E[0, 0] * ax + E[0, 1] * ay + E[0, 2] * az,
        E[1, 0] * ax + E[1, 1] * ay + E[1, 2] * az,
        E[2, 0] * ax + E[2, 1] * ay + E[2, 2] * az,
    )


@kernel
def contact_velocity(contact, state, rx, ry, rz):
    """Return u = G v of the point at arm r, in contact axes."""
    ux, uy, uz = point_velocity(state, contact.body, rx, ry, rz)
    return in_contact_axes(contact, ux, uy, uz)


@kernel
def motion_of_point(contact, motion, rx, ry, rz):
    """Return G of a motion (linear, angular) of the contact's body, in contact axes."""
    ux, uy, uz = cross(motion[3], motion[4], motion[5], rx, ry, rz)
    return in_contact_axes(contact, ux + motion[0], uy + motion[1], uz + motion[2])


@kernel
def contact_acceleration(contact, state, motion, p, rx, ry, rz):
    """Return du/dt in contact axes: a + alpha x r + w x (w x R p) (the ball around p does not turn r)."""
    q, w = state[contact.body].Q, state[contact.body].w
    cx, cy, cz = rotate(q[0], q[1], q[2], q[3], p[0], p[1], p[2])
    cx, cy, cz = cross(w[0], w[1], w[2], cx, cy, cz)
    cx, cy, cz = cross(w[0], w[1], w[2], cx, cy, cz)
    tx, ty, tz = cross(motion[3], motion[4], motion[5], rx, ry, rz)
    return in_contact_axes(contact, motion[0] + tx + cx, motion[1] + ty + cy, motion[2] + tz + cz)


@kernel
def spread(system, contact, state, rx, ry, rz, ln, l1, l2, work):
    """Write motion = P G^T (ln, l1, l2): of all bodies, or of the own one if nothing is joined to it."""
    b, E = contact.body, contact.axes
    fx = E[0, 0] * ln + E[1, 0] * l1 + E[2, 0] * l2
    fy = E[0, 1] * ln + E[1, 1] * l1 + E[2, 1] * l2
    fz = E[0, 2] * ln + E[1, 2] * l1 + E[2, 2] * l2
    tx, ty, tz = cross(rx, ry, rz, fx, fy, fz)
    alone = system.bodies[b].isolated == 1
    if not alone:
        clear_wrenches(work)
    wrench = work.body[b].wrench
    wrench[0], wrench[1], wrench[2], wrench[3], wrench[4], wrench[5] = fx, fy, fz, tx, ty, tz
    if alone:
        free_body(system.bodies[b], state[b].Q, work.body[b])
    else:
        solve(system, state, False, work)


@kernel
def clear_wrenches(work):
    """Zero the wrench of each body."""
    for b in range(work.body.shape[0]):
        wrench = work.body[b].wrench
        for k in range(6):
            wrench[k] = 0.0


@kernel
def reached(system, contact):
    """Return the range of bodies that an impulse at the contact may move."""
    if system.bodies[contact.body].isolated == 1:
        return contact.body, contact.body + 1
    return 0, system.bodies.shape[0]


@kernel
def effective_inverse_mass(system, contact, state, rx, ry, rz, work, W):
    """Write W = G P G^T (3, 3) of the point at arm r. Columns are answers to unit impulses."""
    for k in range(3):
        e0, e1, e2 = 1.0 if k == 0 else 0.0, 1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0
        spread(system, contact, state, rx, ry, rz, e0, e1, e2, work)
        u = motion_of_point(contact, work.body[contact.body].motion, rx, ry, rz)
        for i in range(3):
            W[i, k] = u[i]
    for i in range(3):
        for k in range(i):
            m = 0.5 * (W[i, k] + W[k, i])
            W[i, k], W[k, i] = m, m


@kernel
def add_velocity(system, contact, work, state):
    """Add the motion that `spread` wrote to the velocities."""
    first, last = reached(system, contact)
    for b in range(first, last):
        v, w, motion = state[b].v, state[b].w, work.body[b].motion
        for k in range(3):
            v[k] += motion[k]
            w[k] += motion[3 + k]
