"""The contact problem of a crowd: rows in the middle of the step, velocities without impulses, bounds."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.dynamics.acceleration import STICK
from carom.friction.layout import CONE, DISC
from carom.friction.solve import scale_link
from carom.geometry.rotation import cross, rotate, rotate_back
from carom.kinematics.contact_point import contact_velocity

LEAVES = 1e-6  # of what gravity gives in the step: what is slower at the start only trembles


@kernel
def pose(system, active, k, h, fall, start, crowd):
    """Write the problem of k points whose rows are in `crowd.points[0]`; start from the last forces.

    A body that is alone strikes with -p in the cone's law for w + e u, tangents too: p . (w + u)/2 is then
    (p . (w + e u) - (1 - e)/2 p . W p)/(1 + e), which is never positive, and 0 without friction if e = 1.
    """
    alone = start.shape[0] == 1
    for i in range(k):
        spot, point = crowd.spots[i], crowd.points[0][i]
        contact, p = system.contacts[spot.contact], crowd.p
        spot.before[0], spot.before[1], spot.before[2] = contact_velocity(point, start)
        free = contact_velocity(point, crowd.flight)
        set_link(system, point, crowd.flight, crowd.problem, i)
        for r in range(3):
            crowd.c[3 * i + r], p[3 * i + r] = free[r], 0.0
        row = crowd.problem.contact[i]
        if spot.turns > 0:
            row.kind, row.mu = DISC, 1.0
            if spot.active >= 0:
                torque, s = active.points[spot.active].torque, h / point.length
                p[3 * i + 1] = s * (torque[1] if spot.turns == 1 else torque[0])
                p[3 * i + 2] = s * torque[2] if spot.turns == 1 else 0.0
            continue
        set_bound(spot, contact, h, fall)
        crowd.c[3 * i] -= spot.bound
        crowd.c[3 * i + 1] += spot.drift[1]
        crowd.c[3 * i + 2] += spot.drift[2]
        if alone and spot.strikes == 1:
            crowd.c[3 * i + 1] += contact.restitution * spot.before[1]
            crowd.c[3 * i + 2] += contact.restitution * spot.before[2]
        row.kind, row.mu = CONE, contact.friction
        if spot.active >= 0:
            row.mu = contact.friction_held
            for r in range(3):
                p[3 * i + r] = h * active.points[spot.active].force[r]


@kernel
def note_drift(active, k, few, start, crowd):
    """Write what rows that turn give an active point at the start: G_m v_0 - G_0 v_0, tangents where it sticks.

    Of few bodies, whose rows at the start are in `crowd.points[1]`. A point that stays at the end has
    G_1 v_1 = 0, which is G_m v_1 = -(G_m - G_0) v_0 up to terms of the second order, and gains nothing.
    """
    for i in range(k):
        spot = crowd.spots[i]
        spot.drift[0], spot.drift[1], spot.drift[2] = 0.0, 0.0, 0.0
        if not (few and spot.active >= 0 and spot.turns == 0):
            continue
        before = contact_velocity(crowd.points[1][i], start)
        u = contact_velocity(crowd.points[0][i], start)
        for r in range(3 if active.points[spot.active].mode == STICK else 1):
            spot.drift[r] = u[r] - before[r]


@kernel
def set_bound(spot, contact, h, fall):
    """Write the least normal velocity after the step, and whether the point strikes.

    An impact leaves with e times the approach at the start (Moreau 1988), unless all its bounces, which last
    2 e|u|/(g (1 - e)), end within the step: then it stays. What is open at the end without contacts
    may close no faster than its gap allows. What leaves at the start, and is pressed on within the step, comes
    back as fast as it left: (u + w)/2 = 0, so that it gains nothing. All that without what is due to rows that
    turn.
    """
    u, e = spot.before[0] - spot.drift[0], contact.restitution
    spot.bound, spot.strikes = 0.0, 0
    if spot.gap > 0.0 and spot.left > 0.0:
        spot.bound = min(-spot.gap / h, -u)
    elif u > LEAVES * fall * h + contact.still:
        spot.bound = -u
    elif 2.0 * e * -u > (1.0 - e) * fall * h + contact.still:
        spot.bound, spot.strikes = -e * u, 1
    elif -u > 2.0 * fall * h + contact.still:
        spot.strikes = 1
    spot.bound -= spot.drift[0]


@kernel
def set_link(system, point, flight, work, i):
    """Write rows G of a point for both bodies, M^-1 G^T, and their product, scaled."""
    link, contact, E = work.link[i], work.contact[i], point.axes
    link.body[0], link.body[1] = point.a, point.b
    for side in range(2):
        b = link.body[side]
        if b < 0:
            continue
        sign, arm = (1.0, point.arm_a) if side == 0 else (-1.0, point.arm_b)
        body, q, J = system.bodies[b], flight[b].Q, system.bodies[b].inertia
        G, Y = link.rows[side], link.response[side]
        for r in range(3):
            x, y, z, a = row_of(point, sign, r, arm, E)
            G[r, 0], G[r, 1], G[r, 2] = x, y, z
            G[r, 3], G[r, 4], G[r, 5] = a
            Y[0, r], Y[1, r], Y[2, r] = x / body.mass, y / body.mass, z / body.mass
            t = rotate_back(q[0], q[1], q[2], q[3], a[0], a[1], a[2])
            t = rotate(q[0], q[1], q[2], q[3], t[0] / J[0], t[1] / J[1], t[2] / J[2])
            Y[3, r], Y[4, r], Y[5, r] = t
    scale_link(link, contact, 0.0, CONE, (0.0, 0.0))


@kernel
def row_of(point, sign, r, arm, E):
    """Return row r of a point for one body: linear part, angular part.

    Of rolling and pivoting the angular part is a direction times a length, and the normal row is none.
    """
    x, y, z = sign * E[r, 0], sign * E[r, 1], sign * E[r, 2]
    if point.turns == 0:
        return x, y, z, cross(arm[0], arm[1], arm[2], x, y, z)
    s = sign * point.length
    if r == 0 or (point.turns == 2 and r == 2):
        s = 0.0
    t = 0 if point.turns == 2 else r
    return 0.0, 0.0, 0.0, (s * E[t, 0], s * E[t, 1], s * E[t, 2])
