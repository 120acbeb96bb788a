"""Friction for given normal forces: min_T T.A T/2 + T.c with |T_i| <= rho_i (mathematics page, §2.3).

A = W_tt is positive semidefinite, and singular if contacts are redundant: then w = A T + c at the minimum is
unique, but T is not. The problem is convex and always has a solution, so there is no jam. It is the contact
problem of `carom.friction` for discs of known radii.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction import layout as o
from carom.friction.cone import in_disc
from carom.friction.newton import newton
from carom.friction.strategy import search
from carom.impact.multiple.law import OPEN
from carom.impact.multiple.layout import DISC_T, IN_DISC, MASS

_PROXIMAL = (
    1e-10  # weight of the proximal term where A is singular: w is wrong by less than this part of T
)
_ITERATIONS = 300  # of a search, where Newton's method alone fails


@kernel
def gather_discs(k, work):
    """List the closed contacts with friction and write their W_tt, scaled; return their number."""
    slot, cones, m = work.index[IN_DISC], work.cones, 0
    for i in range(k):
        c = work.contact[i]
        if c.mode != OPEN and c.mu > 0.0:
            slot[m] = i
            disc, trace = cones.contact[m], c.grip / c.mu
            disc.kind, disc.mu, disc.h2 = o.DISC, 0.0, 0.0
            disc.scale = math.sqrt(2.0 / trace) if trace > 0.0 else 1.0
            m += 1
    for a in range(3 * m):
        row = cones.W[a]
        given = work.matrix[MASS, 3 * slot[a // 3] + a % 3]
        for b in range(3 * m):
            value = given[3 * slot[b // 3] + b % 3] if a % 3 > 0 and b % 3 > 0 else 0.0
            row[b] = cones.contact[a // 3].scale * value * cones.contact[b // 3].scale
    cones.count[o.FACTOR_ROWS] = -1
    return m


@kernel
def solve_discs(m, work, step, force, u, tolerance):
    """Write the friction of `m` discs with which the velocity without it, `u`, ends a time `step`.

    The radii are mu times the normal forces of `force`, and `tolerance` is for velocities. Friction of the last
    solve is the first guess.
    """
    slot, cones, last = work.index[IN_DISC], work.cones, work.vector[DISC_T]
    t, bias, centre = cones.vector[o.ITERATE], cones.vector[o.BIAS], cones.vector[o.CENTRE]
    least, largest = math.inf, 0.0
    for s in range(m):
        n, a, disc = 3 * s, 3 * slot[s], cones.contact[s]
        scale = disc.scale
        disc.h1 = work.contact[slot[s]].mu * force[a] / scale
        t[n], t[n + 1], t[n + 2] = in_disc(disc.h1, last[2 * s] / scale, last[2 * s + 1] / scale)
        bias[n], bias[n + 1], bias[n + 2] = 0.0, scale * u[a + 1] / step, scale * u[a + 2] / step
        for r in range(3):
            centre[n + r] = t[n + r]
            largest = max(largest, abs(bias[n + r]))
        least = min(least, scale)
    cones.mismatch[o.ENOUGH] = least * tolerance / step + 1e-14 * largest
    newton(cones, m, _PROXIMAL, True)
    if not cones.mismatch[0] <= cones.mismatch[o.ENOUGH]:
        cones.count[o.BUDGET] = _ITERATIONS
        search(cones, m)
        cones.count[o.FACTOR_ROWS] = -1
    for s in range(m):
        a, scale = 3 * slot[s], cones.contact[s].scale
        _, x, y = in_disc(cones.contact[s].h1, t[3 * s + 1], t[3 * s + 2])
        force[a + 1], force[a + 2] = scale * x, scale * y
        last[2 * s], last[2 * s + 1] = force[a + 1], force[a + 2]
