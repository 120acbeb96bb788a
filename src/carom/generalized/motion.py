"""Accelerations in coordinates: ``M v' = Q - dV - Gamma(v, v) + D^T lam`` with ``R v' = -R' v``.

R are the rows of constraints and of persistent contacts; D = R, except for a contact that slips, whose reaction
is N (G_n - mu e G_t). (Mathematics page, §4.1 and §4.4.) Returns of coordinates to phi = 0, and of velocities
to R v = 0, are solves with the same rows.
"""

from __future__ import annotations

import math

from carom._compiled.call_address import call_function
from carom._compiled.decorators import entry, kernel
from carom.friction import ldl, lu
from carom.generalized import layout as o
from carom.generalized.differences import evaluate_parts
from carom.generalized.linear import add_row, copy_row, dot
from carom.generalized.thresholds import COORDINATE_UNIT, METRIC_PIVOT
from carom.law.friction import bound_of_stick, depends_on_slip, in_slip
from carom.model import actions as a
from carom.status import NOT_FINITE, SINGULAR_METRIC

POSITION, RATE, ACCELERATION = range(3)  # what the rows must give


@kernel
def evaluate(system, which, t, x, out, work):
    """Write the result of one of the four functions of a system into `out`, its array of the workspace."""
    if system.address[which] != 0:
        call_function(system.address[which], t, x, out)
    else:
        evaluate_parts(system, which, t, x, work)


@kernel
def find_metric(system, t, x, work):
    """Compute M, its factor and Gamma(v, v) at the state `x`; return a status."""
    evaluate(system, o.CALL_INERTIA, t, x, work.inertia, work)
    n, total = system.n, 0.0
    for i in range(n):
        copy_row(work.M[i], work.L[i], n)
    ldl.factor(n, METRIC_PIVOT, work.L)
    for i in range(n):
        if not 0.0 < work.L[i, i] < math.inf:
            for k in range(n * n):
                total += work.inertia[k]
            return SINGULAR_METRIC if math.isfinite(total) else NOT_FINITE
    return 0


@kernel
def kinetic_energy(system, x, work):
    """Return v M v / 2 of a state whose metric is in the workspace."""
    n, total = system.n, 0.0
    for i in range(n):
        total += x[n + i] * dot(work.M[i], x[n:], n)
    return 0.5 * total


@kernel
def persists(active):
    """Return whether any contact persists."""
    for c in range(active.shape[0]):
        if active[c].mode != a.MODE_OPEN:
            return True
    return False


@kernel
def find_rows(system, active, t, x, work):
    """Compute constraint rows, and contacts if any persists."""
    if system.rows > 0:
        evaluate(system, o.CALL_ROWS, t, x, work.rows, work)
    if persists(active):
        evaluate(system, o.CALL_CONTACTS, t, x, work.contacts, work)


@kernel
def find_contacts(system, t, x, work):
    """Compute gaps and contact rows, and the size of the terms of each gap."""
    if system.contacts == 0:
        return
    evaluate(system, o.CALL_CONTACTS, t, x, work.contacts, work)
    for c in range(system.contacts):
        size = max(abs(work.gap[c]), terms(work.G[c, 0], x, system.n))
        if math.isfinite(size):
            work.gap_scale[c] = max(work.gap_scale[c], size)


@kernel
def terms(row, x, n):
    """Return sum |row_j x_j|, with coordinates of at least `COORDINATE_UNIT`."""
    total = 0.0
    for j in range(n):
        total += abs(row[j]) * max(abs(x[j]), COORDINATE_UNIT)
    return total


@kernel
def slip_of(system, heading, c, x, work):
    """Return the slip (u_1, u_2) of contact c and its direction; rows must be those of `x`.

    If it would reverse within a stage, it has the direction before.
    """
    n, rows, (e1, e2) = system.n, work.G[c], (heading[0], heading[1])
    u1, u2 = dot(rows[1], x[n:], n), dot(rows[2], x[n:], n)
    size = math.sqrt(u1 * u1 + u2 * u2)
    if size > 0.0 and u1 * e1 + u2 * e2 > 0.0:
        e1, e2 = u1 / size, u2 / size
    return u1, u2, e1, e2


@kernel
def friction_of(system, c, speed):
    """Return mu of contact c that slips at a speed along its direction."""
    if depends_on_slip(system.laws, c):
        return in_slip(system.laws, c, max(0.0, speed))
    return bound_of_stick(system.laws, c)


@kernel
def add_row_to(row, target, m, work):
    """Write row number m of R and D, and what it must give; return the number of rows."""
    copy_row(row, work.R[m], row.size)
    copy_row(row, work.D[m], row.size)
    work.rhs[m] = target
    return m + 1


@kernel
def gather(system, active, what, x, work):
    """Write R, D, and into `rhs` what R must give: -phi of coordinates, 0 of rates, -R' v of accelerations.

    Return the number of rows.
    """
    m, n = 0, system.n
    for r in range(system.holonomic if what == POSITION else system.rows):
        target = 0.0 if what == RATE else -work.phi[r] if what == POSITION else -work.A_rate[r]
        m = add_row_to(work.A[r], target, m, work)
    for c in range(system.contacts):
        contact, first = active[c], m
        if contact.mode == a.MODE_OPEN:
            continue
        contact.row = m
        for r in range(3 if contact.mode == a.MODE_STICK and what != POSITION else 1):
            target = (
                0.0 if what == RATE else -work.gap[c] if what == POSITION else -work.G_rate[c, r]
            )
            m = add_row_to(work.G[c, r], target, m, work)
        if (
            what == ACCELERATION
            and contact.mode == a.MODE_SLIP
            and bound_of_stick(system.laws, c) > 0.0
        ):
            u1, u2, e1, e2 = slip_of(system, contact.heading, c, x, work)
            mu = friction_of(system, c, u1 * e1 + u2 * e2)
            add_row(-mu * e1, work.G[c, 1], work.D[first], n)
            add_row(-mu * e2, work.G[c, 2], work.D[first], n)
    return m


@kernel
def react(system, m, out, work):
    """Add to `out` (n,) the reactions that give it `rhs`; these become the multipliers.

    With Z = M^-1 D^T and K = R Z they are the solution of K lam = rhs - R out.
    """
    n = system.n
    for r in range(m):
        copy_row(work.D[r], work.Z[r], n)
        ldl.substitute(n, work.L, work.Z[r])
    for r in range(m):
        for s in range(m):
            work.K[r, s] = dot(work.R[r], work.Z[s], n)
        work.rhs[r] -= dot(work.R[r], out, n)
    lu.factor_in_order(work.K, m, work.inverse, system.drop)
    lu.substitute_in_order(work.K, m, work.inverse, work.rhs)
    for r in range(m):
        add_row(work.rhs[r], work.Z[r], out, n)


@kernel
def acceleration(system, active, t, x, work, rate):
    """Write x' into `rate` (2n,); return power of loads, of friction, and a status.

    Forces of persistent contacts go to their records.
    """
    n, m, a, friction = system.n, 0, work.a, 0.0
    code = find_metric(system, t, x, work)
    if code != 0:
        return 0.0, 0.0, code
    evaluate(system, o.CALL_LOADS, t, x, work.loads, work)
    copy_row(work.load, a, n)
    add_row(-1.0, work.c, a, n)
    ldl.substitute(n, work.L, a)
    if system.rows > 0 or persists(active):
        find_rows(system, active, t, x, work)
        m = gather(system, active, ACCELERATION, x, work)
        react(system, m, a, work)
        friction = note_forces(system, active, x, work)
    for j in range(n):  # of what the reactions do not leave of it, too
        total = abs(a[j])
        for r in range(m):
            total += 2.0 * abs(work.rhs[r] * work.Z[r, j])
        work.sum[j] = max(work.sum[j], total)
    copy_row(x[n:], rate, n)
    copy_row(a, rate[n:], n)
    return work.loads[n + 1], friction, 0


@kernel
def note_forces(system, active, x, work):
    """Write the forces of persistent contacts from the multipliers; return the power of friction."""
    power = 0.0
    for c in range(system.contacts):
        contact, force, m = active[c], active[c].force, active[c].row
        if contact.mode == a.MODE_OPEN:
            continue
        force[0] = work.rhs[m]
        contact.yields = work.K[m, m]
        if contact.mode == a.MODE_STICK:
            force[1], force[2] = work.rhs[m + 1], work.rhs[m + 2]
        else:
            u1, u2, e1, e2 = slip_of(system, contact.heading, c, x, work)
            mu = friction_of(system, c, u1 * e1 + u2 * e2)
            force[1], force[2] = -mu * force[0] * e1, -mu * force[0] * e2
            power += force[1] * u1 + force[2] * u2
    return power


@entry
def look(system, active, t, x, work):
    """Compute all quantities at a state, for Python; return a status. The acceleration is in `work.a`."""
    find_contacts(system, t, x, work)
    _, _, code = acceleration(system, active, t, x, work, work.trial)
    return code
