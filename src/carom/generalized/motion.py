"""Accelerations in coordinates: ``M v' = Q - dV - Gamma(v, v) + D^T lam`` with ``R v' = -R' v``.

R are the rows of constraints and of persistent contacts; D = R, except for a contact that slips, whose reaction
is N (G_n - mu e G_t). (Mathematics page, §4.1 and §4.4.)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom._compiled.user_functions import call_function
from carom.generalized.layout import (
    ALL_ROWS,
    CALL_CONTACTS,
    CALL_INERTIA,
    CALL_LOADS,
    CALL_ROWS,
    HOLONOMIC,
    TOUCHES,
    N,
)
from carom.generalized.linear import cholesky, factor, solve_metric, substitute
from carom.model.actions import MODE_SLIP, MODE_STICK
from carom.status import NOT_FINITE, SINGULAR_METRIC


@kernel
def find_metric(system, t, x, work):
    """Compute M, its factor and Gamma(v, v) at the state `x`; return a status."""
    call_function(system.address[CALL_INERTIA], t, x, work.inertia)
    n = system.size[N]
    if cholesky(work.M, work.L, n):
        return 0
    total = 0.0
    for i in range(n * n):
        total += work.inertia[i]
    return SINGULAR_METRIC if math.isfinite(total) else NOT_FINITE


@kernel
def find_rows(system, active, t, x, work):
    """Compute constraint rows, and contacts if any is active."""
    if system.size[ALL_ROWS] > 0:
        call_function(system.address[CALL_ROWS], t, x, work.rows)
    if active.count[0] > 0:
        call_function(system.address[CALL_CONTACTS], t, x, work.contacts)


@kernel
def find_contacts(system, t, x, work):
    """Compute gaps and contact rows, and the size of the terms of each gap."""
    if system.size[TOUCHES] == 0:
        return
    call_function(system.address[CALL_CONTACTS], t, x, work.contacts)
    for c in range(system.size[TOUCHES]):
        size = abs(work.gap[c])
        total = 0.0
        for j in range(system.size[N]):
            total += abs(work.G[c, 0, j] * x[j])
        size = max(size, total)
        if math.isfinite(size):
            work.gap_scale[c] = max(work.gap_scale[c], size)


@kernel
def slip_of(system, active, i, x, work):
    """Return the slip (u_1, u_2) of persistent contact i; rows must be those of `x`."""
    n, c = system.size[N], active.contact[i]
    u1, u2 = 0.0, 0.0
    for j in range(n):
        u1 += work.G[c, 1, j] * x[n + j]
        u2 += work.G[c, 2, j] * x[n + j]
    return u1, u2


@kernel
def direction(active, i, u1, u2):
    """Return the direction of slip; if it would reverse within a stage, the direction before."""
    h1, h2 = active.heading[i, 0], active.heading[i, 1]
    size = math.sqrt(u1 * u1 + u2 * u2)
    if size > 0.0 and u1 * h1 + u2 * h2 > 0.0:
        return u1 / size, u2 / size
    return h1, h2


@kernel
def copy_row(row, out, n):
    """Copy n numbers."""
    for j in range(n):
        out[j] = row[j]


@kernel
def gather(system, active, x, work):
    """Write R and D, and the targets -R' v into `rhs`; return the number of rows."""
    n, m = system.size[N], system.size[ALL_ROWS]
    for r in range(m):
        copy_row(work.A[r], work.R[r], n)
        copy_row(work.A[r], work.D[r], n)
        work.rhs[r] = -work.A_rate[r]
    for i in range(active.count[0]):
        c = active.contact[i]
        mu = system.friction[c]
        copy_row(work.G[c, 0], work.R[m], n)
        copy_row(work.G[c, 0], work.D[m], n)
        work.rhs[m] = -work.G_rate[c, 0]
        if active.mode[i] == MODE_SLIP and mu > 0.0:
            u1, u2 = slip_of(system, active, i, x, work)
            e1, e2 = direction(active, i, u1, u2)
            for j in range(n):
                work.D[m, j] -= mu * (e1 * work.G[c, 1, j] + e2 * work.G[c, 2, j])
        m += 1
        if active.mode[i] == MODE_STICK:
            for r in range(1, 3):
                copy_row(work.G[c, r], work.R[m], n)
                copy_row(work.G[c, r], work.D[m], n)
                work.rhs[m] = -work.G_rate[c, r]
                m += 1
    return m


@kernel
def factor_rows(system, m, work):
    """Compute Z = M^-1 D, and factor K = R M^-1 D."""
    n = system.size[N]
    for r in range(m):
        copy_row(work.D[r], work.Z[r], n)
        solve_metric(work.L, work.Z[r], n)
    for r in range(m):
        for s in range(m):
            total = 0.0
            for j in range(n):
                total += work.R[r, j] * work.Z[s, j]
            work.K[r, s] = total
    factor(work.K, work.inverse, m, system.drop)


@kernel
def react(system, m, out, work):
    """Add to `out` (n,) the reactions that give it the rates in `rhs`; these become the multipliers."""
    n = system.size[N]
    for r in range(m):
        for j in range(n):
            work.rhs[r] -= work.R[r, j] * out[j]
    substitute(work.K, work.inverse, work.rhs, m)
    for r in range(m):
        for j in range(n):
            out[j] += work.Z[r, j] * work.rhs[r]


@kernel
def acceleration(system, active, t, x, work, rate):
    """Write x' into `rate` (2n,); return power of loads, of friction, and a status.

    Forces of persistent contacts go to `active.force`.
    """
    n = system.size[N]
    code = find_metric(system, t, x, work)
    if code != 0:
        return 0.0, 0.0, code
    if system.address[CALL_LOADS] != 0:
        call_function(system.address[CALL_LOADS], t, x, work.loads)
    a = work.a
    for j in range(n):
        a[j] = work.loads[1 + j] - work.c[j]
    solve_metric(work.L, a, n)
    friction = 0.0
    if system.size[ALL_ROWS] > 0 or active.count[0] > 0:
        find_rows(system, active, t, x, work)
        m = gather(system, active, x, work)
        factor_rows(system, m, work)
        react(system, m, a, work)
        friction = note_forces(system, active, x, work)
    for j in range(n):
        rate[j], rate[n + j] = x[n + j], a[j]
    return work.loads[n + 1], friction, 0


@kernel
def note_forces(system, active, x, work):
    """Write the forces of persistent contacts from the multipliers; return the power of friction."""
    power, m = 0.0, system.size[ALL_ROWS]
    for i in range(active.count[0]):
        force, mu = active.force[i], system.friction[active.contact[i]]
        force[0] = work.rhs[m]
        active.yields[i] = work.K[m, m]
        if active.mode[i] == MODE_STICK:
            force[1], force[2] = work.rhs[m + 1], work.rhs[m + 2]
            m += 3
        else:
            u1, u2 = slip_of(system, active, i, x, work)
            e1, e2 = direction(active, i, u1, u2)
            force[1], force[2] = -mu * force[0] * e1, -mu * force[0] * e2
            power += force[1] * u1 + force[2] * u2
            m += 1
    return power


@entry
def look(system, active, t, x, work):
    """Compute all quantities at a state, for Python; return a status. The acceleration is in `work.a`."""
    find_contacts(system, t, x, work)
    if system.size[HOLONOMIC] > 0 or system.size[ALL_ROWS] > 0:
        call_function(system.address[CALL_ROWS], t, x, work.rows)
    _, _, code = acceleration(system, active, t, x, work, work.trial)
    return code
