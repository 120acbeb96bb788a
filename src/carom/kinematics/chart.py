"""The functions of a system in coordinates of the user's own, called once for each state.

What each returns is kept in `system.chart` with the state that it belongs to (`carom.model.chart`).
"""

from __future__ import annotations

from carom._compiled.call_address import call_function
from carom._compiled.decorators import kernel
from carom.kinematics.differences import evaluate_parts
from carom.model.chart import CALL_CONTACTS, CALL_INERTIA, CALL_LOADS, CALL_ROWS


@kernel
def is_known(last, n, state, t, moving):
    """Return whether results belong to the coordinates of a state; if `moving`, also to rates and time."""
    for j in range(n):
        if last[j] != state[j].x[0]:
            return False
    if moving:
        for j in range(n):
            if last[n + j] != state[j].v[0]:
                return False
        return last[2 * n] == t
    return True


@kernel
def is_new(chart, which, state, t, moving):
    """Return whether a function must be called; if so, note that its results are those of a state."""
    n, last, x = chart.n, chart.arguments[which], chart.x
    if is_known(last, n, state, t, moving):
        return False
    for j in range(n):
        last[j], last[n + j] = state[j].x[0], state[j].v[0]
        x[j], x[n + j] = chart.scale[j] * last[j], chart.scale[j] * last[n + j]
    last[2 * n] = t
    return True


@kernel
def measure(rows, scale):
    """Multiply rows (k, n) by the sizes of the coordinates."""
    for r in range(rows.shape[0]):
        for j in range(scale.size):
            rows[r, j] *= scale[j]


@kernel
def call(chart, which, t, out):
    """Call a function at the state `chart.x`, in the units of the user; its results are views of `out`."""
    if chart.functions[which].address != 0:
        call_function(chart.functions[which].address, t, chart.x, out)
    else:
        evaluate_parts(chart, which, t)


@kernel
def last_time(chart):
    """Return the time of the last loads, about the present one, for messages about functions that fail."""
    t = chart.arguments[CALL_LOADS, 2 * chart.n]
    return t if t == t else 0.0


@kernel
def find_inertia(chart, state, moving):
    """Find M and, if `moving`, Gamma(v, v) of a state."""
    if is_new(chart, CALL_INERTIA, state, 0.0, moving):
        call(chart, CALL_INERTIA, last_time(chart), chart.inertia)
        measure(chart.M, chart.scale)
        for i in range(chart.n):
            chart.c[i] *= chart.scale[i]
            for j in range(chart.n):
                chart.M[i, j] *= chart.scale[i]


@kernel
def find_loads(chart, state, t):
    """Find V, Q - dV and Q.v of a state."""
    if is_new(chart, CALL_LOADS, state, t, True):
        call(chart, CALL_LOADS, t, chart.loads)
        for j in range(chart.n):
            chart.load[j] *= chart.scale[j]


@kernel
def find_constraints(chart, state, moving):
    """Find phi and A and, if `moving`, (dA/dt) v of a state."""
    if chart.rows > 0 and is_new(chart, CALL_ROWS, state, 0.0, moving):
        call(chart, CALL_ROWS, last_time(chart), chart.constraints)
        measure(chart.A, chart.scale)


@kernel
def find_gaps(chart, state, moving):
    """Find gaps and G and, if `moving`, (dG/dt) v of a state."""
    if is_new(chart, CALL_CONTACTS, state, 0.0, moving):
        call(chart, CALL_CONTACTS, last_time(chart), chart.touching)
        for c in range(chart.contacts):
            measure(chart.G[c], chart.scale)
