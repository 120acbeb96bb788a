"""Back end for coordinates of the user's own: a dense metric M(q), and rows A of constraints.

    M a = f + A^T lam,   A a = target;   K lam = target - A M^-1 f,   K = A M^-1 A^T

Forces and results are the first components of wrenches and motions of the bodies that stand for the
coordinates (`carom.model.chart`). Rows that depend on others are left out (`carom.friction.ldl`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.element_operations import row_target
from carom.dynamics.thresholds import METRIC_PIVOT
from carom.friction import ldl
from carom.kinematics.chart import find_constraints, find_inertia, find_loads
from carom.model.chart import ROWS_OF_ELEMENT
from carom.model.parts_of_system import has_metric


@kernel
def factor(system, state):
    """Factor M and K in the position of `state`, unless they are those of it; NaN if M is singular."""
    chart = system.chart
    n, known = chart.n, True
    for j in range(n):
        known = known and chart.pose[j] == state[j].x[0]
    if known:
        return
    find_inertia(system.chart, state, False)
    for i in range(n):
        chart.pose[i] = state[i].x[0]
        for j in range(n):
            chart.L[i, j] = chart.M[i, j]
    ldl.factor(n, METRIC_PIVOT, chart.L)
    regular, total = True, 0.0
    for i in range(n):
        regular = regular and 0.0 < chart.L[i, i] < math.inf
        for j in range(n):
            total += chart.M[i, j]
    if regular or math.isfinite(total):
        chart.singular[0] = 0.0 if regular else 1.0
    if not regular:
        chart.L[0, 0] = math.nan
    if chart.rows > 0:
        factor_rows(system, state)


@kernel
def factor_rows(system, state):
    """Write Z = M^-1 A and factor K = A Z^T."""
    chart = system.chart
    n, k = chart.n, chart.rows
    find_constraints(system.chart, state, False)
    for r in range(k):
        for j in range(n):
            chart.Z[r, j] = chart.A[r, j]
        ldl.substitute(n, chart.L, chart.Z[r])
        for s in range(r + 1):
            total = 0.0
            for j in range(n):
                total += chart.A[r, j] * chart.Z[s, j]
            chart.K[r, s] = chart.K[s, r] = total
    ldl.factor(k, chart.drop, chart.K)


@unit
def solve_metric(system, state, biased, near, work):
    """Write the first component of the motion of all bodies, and the multipliers of the constraints."""
    chart = system.chart
    n, a = chart.n, chart.a
    if not near:
        factor(system, state)
        find_constraints(system.chart, state, False)  # another state may have been looked at since
    for j in range(n):
        a[j] = work.body[j].wrench[0]
    ldl.substitute(n, chart.L, a)
    if not chart.L[0, 0] > 0.0:  # the metric is singular
        a[0] = math.nan
    if chart.rows > 0:
        react(system, state, biased, work)
    for j in range(n):
        motion = work.body[j].motion
        motion[0] = a[j]
        for k in range(1, 6):
            motion[k] = 0.0


@kernel
def react(system, state, biased, work):
    """Add to `a` the reactions that give the rows their targets, which are 0 if not `biased`."""
    chart = system.chart
    n, k, lam = chart.n, chart.rows, chart.multiplier
    for e in range(system.joints.shape[0]):
        first, target = ROWS_OF_ELEMENT * e, work.joint[e].target
        if biased:
            row_target(system, e, state, work.joint[e].bias, target)
        for r in range(system.joints[e].rows):
            lam[first + r] = target[r] if biased else 0.0
    for r in range(k):
        for j in range(n):
            lam[r] -= chart.A[r, j] * chart.a[j]
    ldl.substitute(k, chart.K, lam)
    for r in range(k):
        for j in range(n):
            chart.a[j] += lam[r] * chart.Z[r, j]
    for e in range(system.joints.shape[0]):
        for r in range(system.joints[e].rows):
            work.joint[e].reaction[r] = lam[ROWS_OF_ELEMENT * e + r]


@unit(where=has_metric, otherwise=0.0)
def metric_energy(system, state) -> float:
    """Return the kinetic energy v M v/2 [J]."""
    chart, total = system.chart, 0.0
    find_inertia(system.chart, state, False)
    for i in range(chart.n):
        for j in range(chart.n):
            total += state[i].v[0] * chart.M[i, j] * state[j].v[0]
    return 0.5 * total


@unit(where=has_metric, otherwise=0.0)
def add_loads(system, state, moving, work) -> float:
    """Add Q - dV and, if `moving`, -Gamma(v, v) to the wrenches; return the power Q.v."""
    chart = system.chart
    find_loads(system.chart, state, work.moment[0].time)
    for j in range(chart.n):
        work.body[j].wrench[0] += chart.load[j]
    if moving:
        find_inertia(system.chart, state, True)
        for j in range(chart.n):
            work.body[j].wrench[0] -= chart.c[j]
    return chart.loads[chart.n + 1]


@unit(where=has_metric, otherwise=0.0)
def chart_potential(system, state, t) -> float:
    """Return the potential V [J]."""
    find_loads(system.chart, state, t)
    return system.chart.loads[0]
