"""Velocities and forces of the layers of a group: udot = W lambda, ddot = -u_n, Pdot = lambda (§2.1)."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.impact.multiple.discs import friction
from carom.impact.multiple.lanes import blocks
from carom.impact.multiple.law import OPEN, force
from carom.impact.multiple.layout import (
    DISC_C,
    DISC_T,
    DISCS,
    IN_DISC,
    JACOBIAN,
    LANES,
    MASS,
    NOW_P,
    NOW_U,
    RADIUS,
    SCRATCH,
    U0,
)


@kernel
def add_velocity(n, W, impulse, u):
    """Add W times `impulse` to `u` (W is symmetric: its columns are its rows)."""
    for j in range(n):
        q, column = impulse[j], W[j]
        if q != 0.0:
            for i in range(n):
                u[i] += q * column[i]


@kernel
def set_velocity(k, work):
    """Write u = u0 + W P, so that momentum is exact at every step."""
    u, u0 = work.vector[NOW_U], work.vector[U0]
    for i in range(3 * k):
        u[i] = u0[i]
    add_velocity(3 * k, work.matrix[MASS], work.vector[NOW_P], u)


@kernel
def into_lanes(k, work):
    """Copy W of the group, column by column, in the form for the series."""
    W, columns = work.matrix[MASS], work.columns
    width = columns.shape[1] // 3
    for j in range(3 * k):
        for b in range(blocks(k)):
            for r in range(3):
                for l in range(LANES):
                    i = LANES * b + l
                    columns[j, r * width + b, l] = W[j, 3 * i + r] if i < k else 0.0


@kernel
def gather_discs(k, work):
    """List the closed contacts with friction and write their W_tt; return their number."""
    slot, A, W, m = work.index[IN_DISC], work.matrix[DISCS], work.matrix[MASS], 0
    for i in range(k):
        if work.contact[i].mode != OPEN and work.contact[i].mu > 0.0:
            slot[m] = i
            m += 1
    for a in range(m):
        for r in range(2):
            row, out = W[3 * slot[a] + 1 + r], A[2 * a + r]
            for b in range(m):
                j = 3 * slot[b] + 1
                out[2 * b] = row[j]
                out[2 * b + 1] = row[j + 1]
    return m


@kernel
def normal_forces(k, work, d, p, out):
    """Write (N, 0, 0) of each contact at depths `d`; the radii of the discs are mu N."""
    for i in range(k):
        n = 3 * i
        out[n] = force(work.contact[i], d[i], p)
        out[n + 1] = 0.0
        out[n + 2] = 0.0


@kernel
def friction_now(k, m, work, horizon, slow, tolerance, out):
    """Add the friction of this instant to the normal forces `out`; `m` discs are gathered.

    For a contact that slips, T = -mu N u_t/|u_t|; for contacts at rest (slower than `slow`), T is the solution
    of §2.3. Both are limits of the friction for the velocity a time `horizon` ahead, as `horizon` tends to 0.
    `tolerance` is for accelerations.
    """
    if m == 0:
        return
    slot, vector = work.index[IN_DISC], work.vector
    u, c, t = vector[NOW_U], vector[DISC_C], vector[DISC_T]
    radius, a = vector[RADIUS], vector[SCRATCH]
    for i in range(3 * k):
        a[i] = 0.0
    add_velocity(3 * k, work.matrix[MASS], out, a)
    largest, most = 0.0, 0.0
    for s in range(m):
        i = slot[s]
        contact = work.contact[i]
        radius[s] = contact.mu * out[3 * i]
        x, y = u[3 * i + 1], u[3 * i + 2]
        rests = contact.sticks == 1 or not math.sqrt(x * x + y * y) > slow
        f = 0.0 if rests else 1.0 / horizon
        for r in range(2):
            c[2 * s + r] = a[3 * i + 1 + r] + f * u[3 * i + 1 + r]
            largest = max(largest, abs(a[3 * i + 1 + r]))
            most = max(most, abs(c[2 * s + r]))
    tolerance += 1e-13 * (1.0 + largest) + 1e-14 * most
    friction(m, work.matrix[DISCS], work.matrix[JACOBIAN], vector, work.index, tolerance)
    for s in range(m):
        n = 3 * slot[s]
        out[n + 1], out[n + 2] = t[2 * s], t[2 * s + 1]
