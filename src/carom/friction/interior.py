"""The contact problem by an interior point method with one factor of the graph of bodies a step.

Coulomb's law has two conditions of complementarity: that of the normal, and that of the disc of friction, whose
radius is given by the present normal impulse,

    0 <= w_n _|_ p_n >= 0,     (sigma, mu w_t) _|_ (p_n, p_t/mu),  both in the cone of Lorentz,

with w = W p + c. sigma is free, and mu |w_t| in a solution. So nothing is nonlinear but the two products: they
are t on the central path, and t goes to 0. (With de Saxce's one product, |w_t| is in the velocity, and steps on
piles of boxes become short: decisions/many_bodies.md.) A direction is dp = a - K dw for each contact, so

    (I + P G^T K G) dy = P G^T p - y + P G^T a

for the motion y of the bodies, which has an equation of its own: what round-off of a stiff K leaves is made
good in the next step. A predictor is followed by the corrector of Mehrotra (1992). Where friction makes the
matrix almost singular, and steps short, the proximal term of `cone_pair` is made stronger.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction import layout as o
from carom.friction import thresholds as limits
from carom.friction.cone_pair import aim, inside, scale, to_edge, turn_back
from carom.friction.island import add_rates, factor_links, solve_motion, write_motion
from carom.friction.layout import DISC


@unit
def enter_path(work, k, gap):
    """Write a first point inside all cones near the present impulses, with products of about `gap`."""
    p, w, least = work.vector[o.ITERATE], work.vector[o.RESULTING], math.sqrt(gap)
    # the impulses, moved away from the edges
    for i in range(k):
        contact, n = work.contact[i], 3 * i
        z, mu = work.path[i].z, contact.mu
        z[0] = (contact.h1 if contact.kind == DISC else max(0.0, p[n])) + least
        size = math.hypot(p[n + 1], p[n + 2])
        f = min(1.0 / mu, limits.EDGE * z[0] / size) if mu > 0.0 and size > 0.0 else 0.0
        z[1], z[2] = f * p[n + 1], f * p[n + 2]
        write_impulse(contact, z, p[n : n + 3])
    write_motion(work, k, p)
    for b in range(work.body.shape[0]):
        body = work.body[b]
        for j in range(6):
            body.reached[j], body.lack[j] = body.motion[j], 0.0
    write_rates(work, k)
    # the velocities: the inverses of the impulses, in the cone, times the gap, and slip where it is greater
    for i in range(k):
        row, n, mu = work.path[i], 3 * i, work.contact[i].mu
        y, z = row.y, row.z
        row.x = max(gap / z[0], w[n])
        f = gap / inside(z)
        y[0], y[1], y[2] = f * z[0], -f * z[1], -f * z[2]
        slip = mu * math.hypot(w[n + 1], w[n + 2])
        if slip > y[0]:
            y[0], y[1], y[2] = y[0] + slip, y[1] + mu * w[n + 1], y[2] + mu * w[n + 2]


@kernel
def write_impulse(contact, z, p):
    """Write the impulse of a contact; that of a disc has its radius as the normal part."""
    p[0] = contact.h1 if contact.kind == DISC else z[0]
    p[1], p[2] = contact.mu * z[1], contact.mu * z[2]


@unit
def step_along(work, k, eps) -> tuple[float, float]:
    """Make one step; return the mean of the products before it, and the length of the step, at most 1."""
    # the scaling, and the factor
    write_rates(work, k)
    w, gap, count = work.vector[o.RESULTING], 0.0, 0
    for i in range(k):
        contact = work.contact[i]
        normal, disc = scale(
            work.path[i], contact, w[3 * i : 3 * i + 3], work.link[i].stiffness, eps
        )
        gap += normal + disc
        count += (0 if contact.kind == DISC else 1) + (1 if contact.mu > 0.0 else 0)
    gap /= max(1, count)
    factor_links(work, k)
    # the predictor says how far the products may fall, and what the corrector has to make good
    direct(work, k, eps, 0.0, False)
    t = longest(work, k, 1.0)
    part = min(1.0, max(0.0, products(work, k, t) / (count * gap)))
    direct(work, k, eps, part * part * part * gap, True)
    t = longest(work, k, limits.EDGE)
    advance(work, k, t)
    return gap, t


@kernel
def write_rates(work, k):
    """Write the velocities of the contacts in the motion that was reached."""
    w, c = work.vector[o.RESULTING], work.vector[o.BIAS]
    for b in range(work.body.shape[0]):
        body = work.body[b]
        for j in range(6):
            body.motion[j] = body.reached[j]
    for i in range(3 * k):
        w[i] = c[i]
    add_rates(work, k, w)


@kernel
def direct(work, k, eps, wanted, corrects):
    """Write the direction to the products `wanted` of all contacts."""
    a, u = work.vector[o.RHS], work.vector[o.CHANGE]
    for i in range(k):
        n = 3 * i
        a[n], a[n + 1], a[n + 2] = aim(work.path[i], work.contact[i], eps, wanted, corrects)
        if work.contact[i].kind == DISC:
            work.path[i].normal, a[n] = a[n], 0.0
    solve_motion(work, k)
    for i in range(3 * k):
        u[i] = 0.0
    add_rates(work, k, u)
    for i in range(k):
        row, contact, n = work.path[i], work.contact[i], 3 * i
        normal = row.normal if contact.kind == DISC else a[n]
        turn_back(row, contact, eps, normal, u[n : n + 3])


@kernel
def products(work, k, t):
    """Return the sum of the products after a part t of the direction."""
    total = 0.0
    for i in range(k):
        row, contact = work.path[i], work.contact[i]
        if contact.kind != DISC:
            total += (row.x + t * row.dx) * (row.z[0] + t * row.dz[0])
        for j in range(3 if contact.mu > 0.0 else 0):
            total += (row.y[j] + t * row.dy[j]) * (row.z[j] + t * row.dz[j])
    return total


@kernel
def longest(work, k, part):
    """Return the part of the way to the next edge, at most 1."""
    t = 1.0
    for i in range(k):
        row, contact = work.path[i], work.contact[i]
        if contact.kind != DISC:
            if row.dx < 0.0:
                t = min(t, -part * row.x / row.dx)
            if row.dz[0] < 0.0:
                t = min(t, -part * row.z[0] / row.dz[0])
        if contact.mu > 0.0:
            t = min(t, part * to_edge(row.y, row.dy), part * to_edge(row.z, row.dz))
    return t


@kernel
def advance(work, k, t):
    """Go a part t of the direction; write the impulses, and what the motion lacks of theirs."""
    p = work.vector[o.ITERATE]
    for i in range(k):
        row, contact, n = work.path[i], work.contact[i], 3 * i
        row.x += t * row.dx
        for j in range(3):
            row.y[j] += t * row.dy[j]
            row.z[j] += t * row.dz[j]
        write_impulse(contact, row.z, p[n : n + 3])
    for b in range(work.body.shape[0]):
        body = work.body[b]
        for j in range(6):
            body.reached[j] += t * body.motion[j]
    write_motion(work, k, p)
    for b in range(work.body.shape[0]):
        body = work.body[b]
        for j in range(6):
            body.lack[j] = body.motion[j] - body.reached[j]


@kernel
def damped(eps, t):
    """Return the weight of the proximal term for the next step: greater after a short step, else less."""
    if t < limits.SHORT_STEP:
        return min(limits.PATH_DAMPING, max(10.0 * eps, limits.LEAST_DAMPING))
    return max(limits.PATH_PROXIMAL, 0.1 * eps) if t > 0.5 else eps
