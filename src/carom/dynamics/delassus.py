"""Several contact points together: velocities, the full W = G P G^T, and the effect of their impulses."""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom.dynamics.contact_impulse import acts, add_impulse, alone, clear_wrenches, spread
from carom.dynamics.solve import free_body, solve
from carom.geometry.rotation import cross, unit_vector
from carom.kinematics.contact_point import (
    contact_acceleration,
    contact_motion,
    contact_velocity,
    in_axes,
)
from carom.kinematics.rows import inverse_inertia, symmetric_times
from carom.model.workspace import MOTION_PIVOT, MOTION_POINT, MOTION_STOP, MOTION_THREE


@kernel
def velocities(system, k, points, state, u):
    """Write u = G v of k points."""
    for i in range(k):
        u[3 * i], u[3 * i + 1], u[3 * i + 2] = contact_velocity(system, points[i], state)


@kernel
def accelerations(system, k, points, state, stage, a):
    """Write du/dt of k points under the accelerations of a stage."""
    for i in range(k):
        a[3 * i], a[3 * i + 1], a[3 * i + 2] = contact_acceleration(system, points[i], state, stage)


@kernel
def still(motion):
    """Zero the motion of one body."""
    for k in range(6):
        motion[k] = 0.0


@kernel
def still_ends(point, work):
    """Zero the motions of the bodies of a point: of a stop of all, since a combination may move any."""
    for b in range(work.body.shape[0] if point.motion > MOTION_PIVOT else 0):
        still(work.body[b].motion)
    still(work.body[point.a].motion)
    if point.b >= 0:
        still(work.body[point.b].motion)


@kernel
def still_all(k, points, work):
    """Zero the motions of the bodies of k points."""
    for i in range(k):
        still_ends(points[i], work)


@kernel
def inverse_masses(system, k, points, state, work, W):
    """Write W (3k, 3k) = G P G^T. Columns are responses to unit impulses; then W is made symmetric."""
    if of_one_body(system, k, points) and not any_turns(k, points):
        inverse_masses_of_one(system.bodies[points[0].a], k, points, state, W)
        return
    still_all(k, points, work)
    for row in range(3 * k):
        W[row, : 3 * k] = 0.0
    for j in range(k):
        free = alone(system, points[j])
        for r in range(3):
            m = 3 * j + r
            if not acts(points[j].motion, r):
                continue
            spread(system, points[j], state, unit_vector(r), work)
            for i in range(k):
                if not (free and no_common_body(points[i], points[j])):
                    W[3 * i, m], W[3 * i + 1, m], W[3 * i + 2, m] = contact_motion(
                        system, points[i], state, work
                    )
        if free:
            still_ends(points[j], work)
        else:  # all joined bodies have a motion, not only those of the point
            still_all(k, points, work)
    for i in range(k):
        for j in range(i + 1):
            if not (alone(system, points[j]) and no_common_body(points[i], points[j])):
                make_symmetric(3 * i, 3 * j, W)
    for i in range(k):
        # a stop has no tangents, a contact in a plane one: any positive values do
        if points[i].motion in (MOTION_STOP, MOTION_THREE):
            for m in (3 * i + 1, 3 * i + 2):
                W[m, m] = W[m, m] if W[m, m] > 0.0 else W[3 * i, 3 * i]


@inlined
def make_symmetric(a, b, W):
    """Give two blocks of W, from row a and column b on and its mirror image, the mean of both."""
    for i in range(a, a + 3):
        for j in range(b, b + 3):
            m = 0.5 * (W[i, j] + W[j, i])
            W[i, j], W[j, i] = m, m


@kernel
def no_common_body(point, other):
    """Return whether two points, the first of which is none of joints, have no body in common."""
    if point.motion > MOTION_PIVOT or point.a in (other.a, other.b):
        return False
    return point.b < 0 or point.b not in (other.a, other.b)


@kernel
def of_one_body(system, k, points):
    """Return whether all points are of one body without joints, on half-spaces or static bodies."""
    for i in range(k):
        if points[i].a != points[0].a or points[i].b >= 0:
            return False
    return system.bodies[points[0].a].isolated == 1


@kernel
def any_turns(k, points):
    """Return whether a point is one of rolling or pivoting, or a stop."""
    for i in range(k):
        if points[i].motion != MOTION_POINT:
            return True
    return False


@kernel
def on_drive(k, points):
    """Return whether one of k points is on a surface with a drive, which works on bodies at rest too."""
    for i in range(k):
        if points[i].moves == 1:
            return True
    return False


@kernel
def inverse_masses_of_one(body, k, points, state, W):
    """Write W of points of one body: e.(d/m + (J^-1 (r x d)) x s) of directions d, e at arms r, s."""
    inverse, g = inverse_inertia(body, state[points[0].a].Q), 1.0 / body.mass
    for j in range(k):
        r, E = points[j].arm_a, points[j].axes
        for a in range(3):
            d = (g * E[a, 0], g * E[a, 1], g * E[a, 2])
            t = cross(r[0], r[1], r[2], E[a, 0], E[a, 1], E[a, 2])
            w = symmetric_times(inverse, t[0], t[1], t[2])
            n = 3 * j + a
            for i in range(j + 1):
                s = points[i].arm_a
                v = cross(w[0], w[1], w[2], s[0], s[1], s[2])
                v = in_axes(points[i], v[0] + d[0], v[1] + d[1], v[2] + d[2])
                for b in range(3):
                    W[3 * i + b, n] = W[n, 3 * i + b] = v[b]


@kernel
def spread_all(system, points, p, member, state, work):
    """Write motion = P G^T p of the bodies of a group, of all its points; return whether joints take part."""
    joined = False
    for m in range(member.shape[0]):
        joined = joined or system.bodies[member[m]].isolated == 0
    clear_wrenches(work)
    for i in range(points.shape[0]):
        add_impulse(system, points[i], state, p[3 * i : 3 * i + 3], work)
    if joined:
        solve(system, state, False, work)
    else:
        for m in range(member.shape[0]):
            b = member[m]
            free_body(system.bodies[b], state[b].Q, work.body[b])
    return joined
