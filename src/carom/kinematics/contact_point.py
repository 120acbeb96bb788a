"""A contact point: its position and its velocity, u = G v.

G maps the velocities of all bodies to u = (u_n, u_t1, u_t2), the velocity of body a relative to body b at
the point. (Paper, change of coordinates at contact.) With anisotropic friction the tangents have lengths
(`carom.kinematics.anisotropy`).
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross, rotate
from carom.kinematics.anisotropy import lay_along_axis
from carom.kinematics.flexible import modal_acceleration, modal_motion, modal_velocity
from carom.kinematics.row_of_coordinate import acceleration_in_row, motion_in_row, rate_in_row
from carom.kinematics.wrench import point_velocity
from carom.model.workspace import MOTION_PIVOT, MOTION_POINT, MOTION_ROLL


@kernel
def place(contact, p, state, point):
    """Write the contact point of the core point p (body axes) on a half-space, touching or not."""
    b, n, r = contact.body, contact.axes, contact.radius
    q, x, core, arm, axes = state[b].Q, state[b].x, point.core, point.arm_a, point.axes
    core[0], core[1], core[2] = rotate(q, p)
    point.a, point.b, point.motion, point.bends = b, -1, MOTION_POINT, 0
    gap = -contact.offset
    for k in range(3):
        arm[k] = core[k] - r * n[0, k]
        gap += n[0, k] * (x[k] + arm[k])
        for i in range(3):
            axes[i, k] = n[i, k]
    point.gap = gap
    if contact.axis_of != 0:
        lay_along_axis(contact, state, point)
    carry_field(contact, point)


@kernel
def carry_field(contact, point):
    """Write whether the surface at a point moves in itself, and its velocity field."""
    point.moves = 0 if contact.moves == 0 else 1
    if point.moves == 1:
        copy_field(contact, point)


@kernel
def copy_field(p, q):
    """Copy the velocity field of a moving surface."""
    for i in range(4):
        for k in range(3):
            q.field[i, k] = p.field[i, k]


@kernel
def copy_point(p, q):
    """Copy a point."""
    q.a, q.b, q.gap, q.motion, q.length = p.a, p.b, p.gap, p.motion, p.length
    q.coordinate, q.grip = p.coordinate, p.grip
    q.owner, q.parts[0], q.parts[1], q.moves = p.owner, p.parts[0], p.parts[1], p.moves
    q.bends = p.bends
    if p.bends == 1:
        for k in range(3):
            q.place_a[k], q.place_b[k] = p.place_a[k], p.place_b[k]
    if p.moves == 1:
        copy_field(p, q)
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
    """Return the rows of a point of rolling or pivoting: relative angular velocity times a length."""
    n, t1, t2 = in_axes(point, x, y, z)
    if point.motion == MOTION_ROLL:
        return 0.0, point.length * t1, point.length * t2
    return 0.0, point.length * n, 0.0


@kernel
def own_field(point, state, i):
    """Return rows of a moving surface at a point, contact axes: velocity (i = 0), rate in one place (i = 2).

    The surface moves in itself: the normal component counts for nothing.
    """
    s, w, x, r = point.field[i], point.field[i + 1], state[point.a].x, point.arm_a
    if point.motion > MOTION_PIVOT:  # the rate of a drive
        return 0.0, s[0], 0.0
    if point.motion != MOTION_POINT:
        return turning_rows(point, w[0], w[1], w[2])
    vx, vy, vz = cross(w[0], w[1], w[2], x[0] + r[0], x[1] + r[1], x[2] + r[2])
    _, t1, t2 = in_axes(point, s[0] + vx, s[1] + vy, s[2] + vz)
    return 0.0, t1, t2


@kernel
def on_surface(point, state, i, u):
    """Return rows u less those of the surface."""
    if point.moves == 0:
        return u
    s = own_field(point, state, i)
    return u[0] - s[0], u[1] - s[1], u[2] - s[2]


@kernel
def field_along(point, p):
    """Return the rate of a velocity field, contact axes, at a place that moves with velocity p."""
    w = point.field[1]
    ax, ay, az = cross(w[0], w[1], w[2], p[0], p[1], p[2])
    _, t1, t2 = in_axes(point, ax, ay, az)
    return 0.0, t1, t2


@kernel
def power_of_surface(point, state, p):
    """Return the power of the drive of a moving surface by a force p at a point, or the work by an impulse."""
    if point.moves == 0:
        return 0.0
    s = own_field(point, state, 0)
    return p[0] * s[0] + p[1] * s[1] + p[2] * s[2]


@kernel
def contact_velocity(system, point, state):
    """Return u = G v, in contact axes; relative to a surface that moves in itself."""
    if point.motion > MOTION_PIVOT:
        return on_surface(point, state, 0, rate_in_row(system, point, state))
    if point.motion != MOTION_POINT:
        w, z = state[point.a].w, (0.0, 0.0, 0.0)
        if point.b >= 0:
            z = (state[point.b].w[0], state[point.b].w[1], state[point.b].w[2])
        u = turning_rows(point, w[0] - z[0], w[1] - z[1], w[2] - z[2])
        return on_surface(point, state, 0, u)
    r, s = point.arm_a, point.arm_b
    ux, uy, uz = point_velocity(state, point.a, r[0], r[1], r[2])
    vx, vy, vz = point_velocity(state, point.b, s[0], s[1], s[2])
    ux, uy, uz = ux - vx, uy - vy, uz - vz
    if point.bends == 1:
        dx, dy, dz = modal_velocity(system, point, state)
        ux, uy, uz = ux + dx, uy + dy, uz + dz
    return on_surface(point, state, 0, in_axes(point, ux, uy, uz))


@kernel
def motion_there(motion, r):
    """Return the world velocity at arm r of a motion (linear, angular)."""
    ux, uy, uz = cross(motion[3], motion[4], motion[5], r[0], r[1], r[2])
    return ux + motion[0], uy + motion[1], uz + motion[2]


@kernel
def contact_motion(system, point, state, work):
    """Return G of the motions that the last solve wrote, in contact axes."""
    if point.motion > MOTION_PIVOT:
        return motion_in_row(system, point, state, work)
    if point.motion != MOTION_POINT:
        m, z = work.body[point.a].motion, (0.0, 0.0, 0.0)
        if point.b >= 0:
            o = work.body[point.b].motion
            z = (o[3], o[4], o[5])
        return turning_rows(point, m[3] - z[0], m[4] - z[1], m[5] - z[2])
    ux, uy, uz = motion_there(work.body[point.a].motion, point.arm_a)
    if point.b >= 0:
        vx, vy, vz = motion_there(work.body[point.b].motion, point.arm_b)
        ux, uy, uz = ux - vx, uy - vy, uz - vz
    if point.bends == 1:
        dx, dy, dz = modal_motion(system, point, state, work)
        ux, uy, uz = ux + dx, uy + dy, uz + dz
    return in_axes(point, ux, uy, uz)


@kernel
def contact_acceleration(system, point, state, stage):
    """Return du/dt in contact axes: a + alpha x r + w x (w x core) (a ball around the core does not turn).

    This is for a half-space, whose normal is constant. For two bodies and for stops the result is only G times
    the accelerations.
    """
    if point.motion > MOTION_PIVOT:
        return on_surface(point, state, 2, acceleration_in_row(system, point, state, stage))
    if point.motion != MOTION_POINT:
        m, z = stage[point.a].rate, (0.0, 0.0, 0.0)
        if point.b >= 0:
            o = stage[point.b].rate
            z = (o[3], o[4], o[5])
        u = turning_rows(point, m[3] - z[0], m[4] - z[1], m[5] - z[2])
        return on_surface(point, state, 2, u)
    dx, dy, dz = 0.0, 0.0, 0.0
    if point.bends == 1:
        dx, dy, dz = modal_acceleration(system, point, state, stage)
    if point.b >= 0:
        ax, ay, az = motion_there(stage[point.a].rate, point.arm_a)
        bx, by, bz = motion_there(stage[point.b].rate, point.arm_b)
        return in_axes(point, ax - bx + dx, ay - by + dy, az - bz + dz)
    v, w, c = state[point.a].v, state[point.a].w, point.core
    px, py, pz = cross(w[0], w[1], w[2], c[0], c[1], c[2])
    cx, cy, cz = cross(w[0], w[1], w[2], px, py, pz)
    ux, uy, uz = motion_there(stage[point.a].rate, point.arm_a)
    u = in_axes(point, ux + cx + dx, uy + cy + dy, uz + cz + dz)
    if point.moves == 0:
        return u
    s = field_along(point, (v[0] + px, v[1] + py, v[2] + pz))
    return on_surface(point, state, 2, (u[0], u[1] - s[1], u[2] - s[2]))
