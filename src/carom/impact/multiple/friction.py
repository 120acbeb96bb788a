"""Friction in the layer, where the normal forces are known (mathematics page, §2.3).

*Contacts that stick*: the friction that keeps them at rest is linear in all other forces. W_ZZ T = -a has many
solutions if contacts are redundant (four corners of a box: rank 3 of 8); all have the same effect. The solution
of least |D^-1 T| is used, D = diag(mu N) a moment ahead. It loads contacts according to mu N, so that a contact
leaves its disc only about when no solution fits in the discs.

*All contacts*: min_T T.A T/2 + T.c with |T_i| <= rho_i. A = W_tt is positive semidefinite, and singular if
contacts are redundant: then w = A T + c at the minimum is unique, but T is not. The problem is convex and
always has a solution, so there is no jam. It is the contact problem of `carom.friction` for discs of known
radii.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction import layout as f
from carom.friction.cone import in_disc
from carom.friction.ldl import factor, factor_by_pivots, substitute
from carom.friction.newton import newton
from carom.friction.operators import sweep
from carom.impact import thresholds as limits
from carom.impact.multiple import layout as o
from carom.impact.multiple.layer import set_velocity
from carom.impact.multiple.normal_law import OPEN

# where Newton's iteration stops between stick and slip it begins again after sweeps: how often, and how many
_TURNS, _SWEEPS = 10, 5


@kernel
def gather_stuck(k, work):
    """List the closed contacts that stick and write the matrix of their friction; return their number."""
    z = 0
    for i in range(k):
        c = work.contact[i]
        if c.mode == OPEN:
            c.sticks &= o.HAS_STUCK
        elif c.sticks == 1 and c.mu > 0.0:
            work.stuck[z] = i
            z += 1
    if z > 0:
        find_holding(z, work)
    return z


@kernel
def _bearing(z, work, weight):
    """Write D = mu N of the sticking contacts a moment ahead, relative to the greatest; return the least."""
    d, u, slot = work.now.depth, work.now.velocity, work.stuck
    moment = limits.MOMENT_AHEAD
    for a in range(z):
        i = slot[a]
        c = work.contact[i]
        if u[3 * i] > 0.0:
            moment = min(moment, max(0.0, (d[i] - c.rest) / u[3 * i]))
    for turn in range(2):
        most, now = 0.0, 0.0
        for a in range(z):
            i = slot[a]
            c = work.contact[i]
            force = c.mu * max(0.0, c.slope * (d[i] - c.rest - moment * u[3 * i]))
            weight[a] = force * force
            most = max(most, weight[a])
            now = max(now, c.mu * c.slope * (d[i] - c.rest))
        if most > limits.CLOSED_SQUARE * now * now or turn == 1:
            break
        moment = 0.0  # all open at the same time: use the present forces
    least = 1.0
    for a in range(z):
        weight[a] = math.sqrt(weight[a] / most) if most > 0.0 else 1.0
        least = min(least, weight[a])
    return least


@unit
def find_holding(z, work):
    """Write H in T = -H a: H = D (D W_ZZ D)^+ D."""
    weight, L, full = work.stick.weight, work.stick.L, 0
    if not _bearing(z, work, weight) > limits.LOADED_PART:
        for a in range(z):
            weight[a] = 1.0
        full = _factor(z, work, L)
        _bearing(z, work, weight)
    rank = _factor(z, work, L)
    if rank < full:  # the loaded contacts alone cannot stop all motion
        for a in range(z):
            weight[a] += limits.UNLOADED_WEIGHT
        rank = _factor(z, work, L)
    invert(2 * z, rank, 2, work)


@kernel
def invert(n, rank, rows, work):
    """Write H = D (D A D)^+ D = R R^T, R = D L (L^T L)^-1, by L L^T = D A D with D for `rows` rows each."""
    L, M, hold = work.stick.L, work.stick.gram, work.stick.H
    weight, order = work.stick.weight, work.stick.order
    for p in range(rank):
        for q in range(rank):
            s = 0.0
            for a in range(n):
                s += L[a, p] * L[a, q]
            M[p, q] = s
    factor(rank, 0.0, M)
    for a in range(n):
        for q in range(rank):
            L[a, q] *= weight[order[a] // rows]
        substitute(rank, M, L[a])
    for a in range(n):
        for b in range(a + 1):
            s = 0.0
            for q in range(rank):
                s += L[a, q] * L[b, q]
            hold[order[a], order[b]] = hold[order[b], order[a]] = s


@kernel
def _factor(z, work, L):
    """Write L in D W_ZZ D = L L^T; return the rank."""
    slot, W, weight = work.stuck, work.W, work.stick.weight
    n, largest = 2 * z, 0.0
    for a in range(n):
        row = W[3 * slot[a // 2] + 1 + a % 2]
        for b in range(a + 1):
            L[a, b] = weight[a // 2] * weight[b // 2] * row[3 * slot[b // 2] + 1 + b % 2]
        largest = max(largest, L[a, a])
    return decompose(n, largest, work.stick.order, L)


@kernel
def decompose(n, largest, order, L):
    """Write L in A = L L^T, rows in the order of pivots, over A of the scale `largest`; return its rank."""
    for a in range(n):
        order[a] = a
    # directions that do not move, in a plane, are those of round-off
    rank = factor_by_pivots(n, limits.GROUP_ERROR * largest, order, L)
    for b in range(rank):
        root = math.sqrt(L[b, b])
        for a in range(n):
            L[a, b] = root if a == b else root * L[a, b] if a > b else 0.0
    return rank


@kernel
def halt(k, z, work):
    """Bring the sticking contacts to rest: an impulse removes the rest of their velocity."""
    stick(k, z, work, work.now.impulse, work.now.velocity)
    set_velocity(k, work)
    for b in range(z):
        n = 3 * work.stuck[b]
        work.now.velocity[n + 1], work.now.velocity[n + 2] = 0.0, 0.0


@kernel
def stick(k, z, work, impulse, velocity):
    """Add to `impulse` the friction that keeps `z` contacts at rest, and its effect to `velocity`."""
    hold, slot, t = work.stick.H, work.stuck, work.stick.T
    for a in range(2 * z):
        s, row = 0.0, hold[a]
        for b in range(z):
            n = 3 * slot[b]
            s -= row[2 * b] * velocity[n + 1] + row[2 * b + 1] * velocity[n + 2]
        t[a] = s
    for b in range(z):
        n = 3 * slot[b]
        x, y = t[2 * b], t[2 * b + 1]
        impulse[n + 1] += x
        impulse[n + 2] += y
        row1, row2 = work.W[n + 1], work.W[n + 2]
        for i in range(3 * k):
            velocity[i] += x * row1[i] + y * row2[i]
    for b in range(z):
        n = 3 * slot[b]
        velocity[n + 1], velocity[n + 2] = 0.0, 0.0


@kernel
def slip_of(u, i):
    """Return |u_t| of contact i."""
    return math.sqrt(u[3 * i + 1] * u[3 * i + 1] + u[3 * i + 2] * u[3 * i + 2])


@kernel
def gather_discs(k, work, u, most):
    """List the closed contacts with friction and write their W_tt, scaled; return their number.

    Those that slip by more than `most` are left out.
    """
    slot, cones, m = work.discs, work.cones, 0
    for i in range(k):
        c = work.contact[i]
        if c.mode != OPEN and c.mu > 0.0 and (c.sticks == 1 or slip_of(u, i) <= most):
            slot[m] = i
            c.slip_mu = c.mu
            disc, trace = cones.contact[m], c.grip / c.mu
            disc.kind, disc.mu, disc.h2 = f.DISC, 0.0, 0.0
            disc.scale = math.sqrt(2.0 / trace) if trace > 0.0 else 1.0
            m += 1
    for a in range(3 * m):
        row = cones.W[a]
        given = work.W[3 * slot[a // 3] + a % 3]
        for b in range(3 * m):
            value = given[3 * slot[b // 3] + b % 3] if a % 3 > 0 and b % 3 > 0 else 0.0
            row[b] = cones.contact[a // 3].scale * value * cones.contact[b // 3].scale
    cones.count[f.FACTOR_ROWS] = -1
    return m


@kernel
def solve_discs(m, work, step, force, u, tolerance):
    """Write the friction of `m` discs with which the velocity without it, `u`, ends a time `step`.

    The radii are `slip_mu` times the normal forces of `force`, and `tolerance` is for velocities. Friction of
    the last solve is the first guess.
    """
    slot, cones, last = work.discs, work.cones, work.disc_force
    t, bias, centre = cones.vector[f.ITERATE], cones.vector[f.BIAS], cones.vector[f.CENTRE]
    least, largest = math.inf, 0.0
    for s in range(m):
        n, a, disc = 3 * s, 3 * slot[s], cones.contact[s]
        scale = disc.scale
        disc.h1 = work.contact[slot[s]].slip_mu * force[a] / scale
        t[n], t[n + 1], t[n + 2] = in_disc(disc.h1, last[2 * s] / scale, last[2 * s + 1] / scale)
        bias[n], bias[n + 1], bias[n + 2] = 0.0, scale * u[a + 1] / step, scale * u[a + 2] / step
        for r in range(3):
            centre[n + r] = t[n + r]
            largest = max(largest, abs(bias[n + r]))
        least = min(least, scale)
    cones.mismatch[f.ENOUGH] = least * tolerance / step + limits.LAYER_RESIDUAL * largest
    newton(cones, m, limits.LAYER_PROXIMAL, True)
    for _ in range(_TURNS):
        if cones.mismatch[0] <= cones.mismatch[f.ENOUGH]:
            break
        for i in range(_SWEEPS):
            sweep(cones, m, i % 2 == 1)
        for i in range(3 * m):
            centre[i] = t[i]
        cones.count[f.FACTOR_ROWS] = -1
        newton(cones, m, limits.LAYER_PROXIMAL, True)
    for s in range(m):
        a, scale = 3 * slot[s], cones.contact[s].scale
        _, x, y = in_disc(cones.contact[s].h1, t[3 * s + 1], t[3 * s + 2])
        force[a + 1], force[a + 2] = scale * x, scale * y
        last[2 * s], last[2 * s + 1] = force[a + 1], force[a + 2]


@kernel
def push(sizes, work, step, force, u):
    """Add the effect of the friction of discs within `step` to velocities; `sizes` as in `stages`."""
    slot = work.discs
    for s in range(sizes[1]):
        a = 3 * slot[s] + 1
        x, y = step * force[a], step * force[a + 1]
        row1, row2 = work.W[a], work.W[a + 1]
        for i in range(3 * sizes[0]):
            u[i] += x * row1[i] + y * row2[i]
