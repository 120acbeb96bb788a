"""How bodies answer impulses at the points of a crowd: each by its own mass, or with the joints between them.

Without joints the Delassus operator W = G M^-1 G^T is never formed: rows and responses stand with each point
(`BY_BODIES`). With joints it is G P G^T with the inverse mass P that these leave, whole (`DENSE`), and its
columns are answers of the back end to unit impulses.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.contact_impulse import add_impulse, clear_wrenches
from carom.dynamics.several_points import inverse_masses
from carom.dynamics.solve import solve
from carom.friction import layout as o
from carom.friction.island import impart
from carom.friction.layout import BY_BODIES, CONE
from carom.friction.solve import inverse_mass_of, scale_link
from carom.geometry.rotation import cross, rotate, rotate_back


@kernel
def write_responses(system, k, crowd, work):
    """Write W of the k points in `crowd.points[0]`, with the masses at the end of the flight, scaled."""
    problem, points = crowd.problem, crowd.points[0]
    if problem.kind == BY_BODIES:
        for i in range(k):
            set_link(system, points[i], crowd.flight, problem, i)
        return
    W = problem.matrix
    inverse_masses(system, k, points, crowd.flight, work, W)
    for i in range(k):
        n = 3 * i
        trace = W[n, n] + W[n + 1, n + 1] + W[n + 2, n + 2]
        problem.contact[i].scale = math.sqrt(3.0 / trace) if trace > 0.0 else 1.0
    for i in range(3 * k):
        s, row, out = problem.contact[i // 3].scale, W[i], problem.W[i]
        for j in range(3 * k):
            out[j] = s * row[j] * problem.contact[j // 3].scale


@kernel
def answer(system, k, gamma, crowd, work):
    """Write the impulses `crowd.p` of the scaled ones at hand, and the motion of all bodies that they cause."""
    problem = crowd.problem
    for i in range(3 * k):
        crowd.p[i] = gamma * problem.contact[i // 3].scale * problem.vector[o.P, i]
    if problem.kind == BY_BODIES:
        impart(problem, k)
        for b in range(work.body.shape[0]):
            for j in range(6):
                work.body[b].motion[j] = gamma * problem.body[b].motion[j]
        return
    spread_impulses(system, k, crowd, work)


@kernel
def spread_impulses(system, k, crowd, work):
    """Write the motion of all bodies that the impulses `crowd.p` cause, with the joints between them."""
    clear_wrenches(work)
    for i in range(k):
        p = crowd.p
        add_impulse(crowd.points[0][i], p[3 * i], p[3 * i + 1], p[3 * i + 2], work)
    solve(system, crowd.flight, False, work)


@kernel
def block_of_point(problem, i, W):
    """Write the block W (3, 3) of one point."""
    if problem.kind == BY_BODIES:
        inverse_mass_of(problem.link[i], problem.contact[i], W)
        return
    s = problem.contact[i].scale
    for a in range(3):
        for b in range(3):
            W[a, b] = problem.W[3 * i + a, 3 * i + b] / (s * s)


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
