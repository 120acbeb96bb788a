"""Back end for coordinates of the user's own: a dense metric M(q), and rows A of constraints.

    M a = f + A^T lam,   A a = target;   K lam = target - A M^-1 f,   K = A M^-1 A^T

Forces and results are the first components of wrenches and motions of the bodies that stand for the
coordinates (`carom.model.own_coordinates`). Rows that depend on others are left out (`carom.friction.ldl`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.element_operations import row_target
from carom.dynamics.thresholds import METRIC_PIVOT
from carom.friction import ldl
from carom.kinematics.own_functions import find_constraints, find_inertia, find_loads
from carom.model.own_coordinates import ROWS_OF_ELEMENT
from carom.model.parts_of_system import has_metric


@kernel
def factor(system, state):
    """Factor M and K in the position of `state`, unless they are those of it; NaN if M is singular."""
    own = system.own
    n, known = own.n, True
    for j in range(n):
        known = known and own.pose[j] == state[j].x[0]
    if known:
        return
    find_inertia(system.own, state, False)
    for i in range(n):
        own.pose[i] = state[i].x[0]
        for j in range(n):
            own.L[i, j] = own.M[i, j]
    ldl.factor(n, METRIC_PIVOT, own.L)
    regular, total = True, 0.0
    for i in range(n):
        regular = regular and 0.0 < own.L[i, i] < math.inf
        for j in range(n):
            total += own.M[i, j]
    if regular or math.isfinite(total):
        own.singular[0] = 0.0 if regular else 1.0
    if not regular:
        own.L[0, 0] = math.nan
    if own.rows > 0:
        factor_rows(system, state)


@kernel
def factor_rows(system, state):
    """Write Z = M^-1 A and factor K = A Z^T."""
    own = system.own
    n, k = own.n, own.rows
    find_constraints(system.own, state, False)
    for r in range(k):
        for j in range(n):
            own.Z[r, j] = own.A[r, j]
        ldl.substitute(n, own.L, own.Z[r])
        for s in range(r + 1):
            total = 0.0
            for j in range(n):
                total += own.A[r, j] * own.Z[s, j]
            own.K[r, s] = own.K[s, r] = total
    ldl.factor(k, own.drop, own.K)


@unit
def solve_metric(system, state, biased, near, work):
    """Write the first component of the motion of all bodies, and the multipliers of the constraints."""
    own = system.own
    n, a = own.n, own.a
    if not near:
        factor(system, state)
    for j in range(n):
        a[j] = work.body[j].wrench[0]
    ldl.substitute(n, own.L, a)
    if not own.L[0, 0] > 0.0:  # the metric is singular
        a[0] = math.nan
    if own.rows > 0:
        react(system, state, biased, work)
    for j in range(n):
        motion = work.body[j].motion
        motion[0] = a[j]
        for k in range(1, 6):
            motion[k] = 0.0


@kernel
def react(system, state, biased, work):
    """Add to `a` the reactions that give the rows their targets, which are 0 if not `biased`."""
    own = system.own
    n, k, lam = own.n, own.rows, own.multiplier
    for e in range(system.joints.shape[0]):
        first, target = ROWS_OF_ELEMENT * e, work.joint[e].target
        if biased:
            row_target(system, e, state, work.joint[e].bias, target)
        for r in range(system.joints[e].rows):
            lam[first + r] = target[r] if biased else 0.0
    for r in range(k):
        for j in range(n):
            lam[r] -= own.A[r, j] * own.a[j]
    ldl.substitute(k, own.K, lam)
    for r in range(k):
        for j in range(n):
            own.a[j] += lam[r] * own.Z[r, j]
    for e in range(system.joints.shape[0]):
        for r in range(system.joints[e].rows):
            work.joint[e].reaction[r] = lam[ROWS_OF_ELEMENT * e + r]


@unit(where=has_metric, otherwise=0.0)
def metric_energy(system, state) -> float:
    """Return the kinetic energy v M v/2 [J]."""
    own, total = system.own, 0.0
    find_inertia(system.own, state, False)
    for i in range(own.n):
        for j in range(own.n):
            total += state[i].v[0] * own.M[i, j] * state[j].v[0]
    return 0.5 * total


@unit(where=has_metric, otherwise=0.0)
def add_loads(system, state, moving, work) -> float:
    """Add Q - dV and, if `moving`, -Gamma(v, v) to the wrenches; return the power Q.v."""
    own = system.own
    find_loads(system.own, state, work.moment[0].time)
    for j in range(own.n):
        work.body[j].wrench[0] += own.load[j]
    if moving:
        find_inertia(system.own, state, True)
        for j in range(own.n):
            work.body[j].wrench[0] -= own.c[j]
    return own.loads[own.n + 1]


@unit(where=has_metric, otherwise=0.0)
def own_potential(system, state, t) -> float:
    """Return the potential V [J]."""
    find_loads(system.own, state, t)
    return system.own.loads[0]
