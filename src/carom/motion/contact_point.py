"""A point of contact: its velocity, its effective inverse mass W = G P G^T, and what an impulse does.

G maps the velocities of all bodies to u = (u_n, u_t1, u_t2), the velocity of body a relative to body b at
the point; P is the inverse mass with the joints active. (Paper, change of coordinates at contact.)
"""

from __future__ import annotations

from carom.geometry.rotation import cross, rotate
from carom.jit import kernel
from carom.motion.solve import free_body, solve
from carom.motion.wrench import add_force, point_velocity


@kernel
def place(contact, p, state, point):
    """Write the point at which the core point p (body axes) touches the half-space, or would."""
    b, n, r = contact.body, contact.axes, contact.radius
    q, x, core, arm, axes = state[b].Q, state[b].x, point.core, point.arm_a, point.axes
    core[0], core[1], core[2] = rotate(q[0], q[1], q[2], q[3], p[0], p[1], p[2])
    point.a, point.b, point.turns = b, -1, 0
    gap = -contact.offset
    for k in range(3):
        arm[k] = core[k] - r * n[0, k]
        gap += n[0, k] * (x[k] + arm[k])
        for i in range(3):
            axes[i, k] = n[i, k]
    point.gap = gap


@kernel
def copy_point(p, q):
    """Copy a point."""
    q.a, q.b, q.gap, q.turns, q.length = p.a, p.b, p.gap, p.turns, p.length
    for k in range(3):
        q.arm_a[k], q.arm_b[k], q.core[k] = p.arm_a[k], p.arm_b[k], p.core[k]
        for i in range(3):
            q.axes[i, k] = p.axes[i, k]


@kernel
def in_axes(point, x, y, z):
    """Return the components (normal, tangent 1, tangent 2) of a world vector."""
    E = point.axes
    return (
        E[0, 0] * x + E[0, 1] * y + E[0, 2] * z,
        E[1, 0] * x + E[1, 1] * y + E[1, 2] * z,
        E[2, 0] * x + E[2, 1] * y + E[2, 2] * z,
    )


@kernel
def turning_rows(point, x, y, z):
    """Return the rows of a point of rolling or pivoting: relative angular velocity times a length.

    Of a stop that ends a turn that about its axis.
    """
    n, t1, t2 = in_axes(point, x, y, z)
    if point.turns == 3:
        return point.length * n, 0.0, 0.0
    if point.turns == 1:
        return 0.0, point.length * t1, point.length * t2
    return 0.0, point.length * n, 0.0


@kernel
def own_rows(point, u):
    """Return u, the normal component alone of a stop."""
    if point.turns == 4:
        return u[0], 0.0, 0.0
    return u


@kernel
def contact_velocity(point, state):
    """Return u = G v, in contact axes."""
    if 0 < point.turns < 4:
        w, z = state[point.a].w, (0.0, 0.0, 0.0)
        if point.b >= 0:
            z = (state[point.b].w[0], state[point.b].w[1], state[point.b].w[2])
        return turning_rows(point, w[0] - z[0], w[1] - z[1], w[2] - z[2])
    r, s = point.arm_a, point.arm_b
    ux, uy, uz = point_velocity(state, point.a, r[0], r[1], r[2])
    vx, vy, vz = point_velocity(state, point.b, s[0], s[1], s[2])
    return own_rows(point, in_axes(point, ux - vx, uy - vy, uz - vz))


@kernel
def motion_there(motion, r):
    """Return the world velocity at arm r of a motion (linear, angular)."""
    ux, uy, uz = cross(motion[3], motion[4], motion[5], r[0], r[1], r[2])
    return ux + motion[0], uy + motion[1], uz + motion[2]


@kernel
def contact_motion(point, work):
    """Return G of the motions that the last solve wrote, in contact axes."""
    if 0 < point.turns < 4:
        m, z = work.body[point.a].motion, (0.0, 0.0, 0.0)
        if point.b >= 0:
            o = work.body[point.b].motion
            z = (o[3], o[4], o[5])
        return turning_rows(point, m[3] - z[0], m[4] - z[1], m[5] - z[2])
    ux, uy, uz = motion_there(work.body[point.a].motion, point.arm_a)
    if point.b >= 0:
        vx, vy, vz = motion_there(work.body[point.b].motion, point.arm_b)
        ux, uy, uz = ux - vx, uy - vy, uz - vz
    return own_rows(point, in_axes(point, ux, uy, uz))


@kernel
def contact_acceleration(point, state, stage):
    """Return du/dt in contact axes: a + alpha x r + w x (w x core) (a ball around the core does not turn).

    That is of a half-space, whose normal stays; of two bodies and of stops G times the accelerations alone.
    """
    if 0 < point.turns < 4:
        m, z = stage[point.a].rate, (0.0, 0.0, 0.0)
        if point.b >= 0:
            o = stage[point.b].rate
            z = (o[3], o[4], o[5])
        return turning_rows(point, m[3] - z[0], m[4] - z[1], m[5] - z[2])
    if point.b >= 0:
        ax, ay, az = motion_there(stage[point.a].rate, point.arm_a)
        bx, by, bz = motion_there(stage[point.b].rate, point.arm_b)
        return own_rows(point, in_axes(point, ax - bx, ay - by, az - bz))
    w, c = state[point.a].w, point.core
    cx, cy, cz = cross(w[0], w[1], w[2], c[0], c[1], c[2])
    cx, cy, cz = cross(w[0], w[1], w[2], cx, cy, cz)
    ux, uy, uz = motion_there(stage[point.a].rate, point.arm_a)
    return own_rows(point, in_axes(point, ux + cx, uy + cy, uz + cz))


@kernel
def alone(system, point):
    """Return whether an impulse at the point moves its own bodies only."""
    b = point.b
    return system.bodies[point.a].isolated == 1 and (b < 0 or system.bodies[b].isolated == 1)


@kernel
def spread(system, point, state, ln, l1, l2, work):
    """Write motion = P G^T (ln, l1, l2): of all bodies, or of the point's own if nothing is joined to them."""
    if not alone(system, point):
        clear_wrenches(work)
        add_impulse(point, ln, l1, l2, work)
        solve(system, state, False, work)
        return
    clear_wrench(work.body[point.a])
    if point.b >= 0:
        clear_wrench(work.body[point.b])
    add_impulse(point, ln, l1, l2, work)
    free_body(system.bodies[point.a], state[point.a].Q, work.body[point.a])
    if point.b >= 0:
        free_body(system.bodies[point.b], state[point.b].Q, work.body[point.b])


@kernel
def add_impulse(point, ln, l1, l2, work):
    """Add G^T (ln, l1, l2) to the wrenches."""
    E, r, s = point.axes, point.arm_a, point.arm_b
    if point.turns == 3:
        for k in range(3):
            torque = point.length * ln * E[0, k]
            work.body[point.a].wrench[3 + k] += torque
            if point.b >= 0:
                work.body[point.b].wrench[3 + k] -= torque
        return
    if point.turns == 4:
        l1, l2 = 0.0, 0.0
    elif point.turns > 0:
        i, j = (1, 2) if point.turns == 1 else (0, 2)
        f1, f2 = point.length * l1, point.length * l2 if point.turns == 1 else 0.0
        for k in range(3):
            torque = f1 * E[i, k] + f2 * E[j, k]
            work.body[point.a].wrench[3 + k] += torque
            if point.b >= 0:
                work.body[point.b].wrench[3 + k] -= torque
        return
    fx = E[0, 0] * ln + E[1, 0] * l1 + E[2, 0] * l2
    fy = E[0, 1] * ln + E[1, 1] * l1 + E[2, 1] * l2
    fz = E[0, 2] * ln + E[1, 2] * l1 + E[2, 2] * l2
    add_force(work, point.a, r[0], r[1], r[2], fx, fy, fz)
    add_force(work, point.b, s[0], s[1], s[2], -fx, -fy, -fz)


@kernel
def clear_wrench(memory):
    """Zero the wrench of one body."""
    for k in range(6):
        memory.wrench[k] = 0.0


@kernel
def clear_wrenches(work):
    """Zero the wrench of each body."""
    for b in range(work.body.shape[0]):
        clear_wrench(work.body[b])


@kernel
def effective_inverse_mass(system, point, state, work, W):
    """Write W = G P G^T (3, 3) of one point. Columns are answers to unit impulses."""
    for k in range(3):
        e0, e1, e2 = 1.0 if k == 0 else 0.0, 1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0
        spread(system, point, state, e0, e1, e2, work)
        W[0, k], W[1, k], W[2, k] = contact_motion(point, work)
    for i in range(3):
        for k in range(i):
            m = 0.5 * (W[i, k] + W[k, i])
            W[i, k], W[k, i] = m, m
    if (
        point.turns >= 3
    ):  # a stop has no tangents; what they are given does not matter, without friction
        W[1, 1], W[2, 2] = W[0, 0], W[0, 0]


@kernel
def add_velocity(system, point, work, state):
    """Add the motion that `spread` wrote to the velocities."""
    if alone(system, point):
        gain(work.body[point.a].motion, state[point.a])
        if point.b >= 0:
            gain(work.body[point.b].motion, state[point.b])
    else:
        for b in range(state.shape[0]):
            gain(work.body[b].motion, state[b])


@kernel
def gain(motion, body):
    """Add a motion to the velocity of a body."""
    for k in range(3):
        body.v[k] += motion[k]
        body.w[k] += motion[3 + k]
