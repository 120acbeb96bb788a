"""The functions of a system in coordinates of the user's own, called once for each state.

What each returns is kept in `system.own` with the state that it belongs to (`carom.model.own_coordinates`).
"""

from __future__ import annotations

from carom._compiled.call_address import call_function
from carom._compiled.decorators import kernel
from carom.kinematics.differences import evaluate_parts
from carom.model.own_coordinates import CALL_CONTACTS, CALL_INERTIA, CALL_LOADS, CALL_ROWS


@kernel
def is_known(seen, n, state, t, moving):
    """Return whether results belong to the coordinates of a state; if `moving`, also to rates and time."""
    for j in range(n):
        if seen[j] != state[j].x[0]:
            return False
    if moving:
        for j in range(n):
            if seen[n + j] != state[j].v[0]:
                return False
        return seen[2 * n] == t
    return True


@kernel
def is_new(own, which, state, t, moving):
    """Return whether a function must be called; if so, note that its results are those of a state."""
    n, seen, x = own.n, own.seen[which], own.x
    if is_known(seen, n, state, t, moving):
        return False
    for j in range(n):
        seen[j], seen[n + j] = state[j].x[0], state[j].v[0]
        x[j], x[n + j] = own.scale[j] * seen[j], own.scale[j] * seen[n + j]
    seen[2 * n] = t
    return True


@kernel
def measure(rows, scale):
    """Multiply rows (k, n) by the sizes of the coordinates."""
    for r in range(rows.shape[0]):
        for j in range(scale.size):
            rows[r, j] *= scale[j]


@kernel
def call(own, which, t, out):
    """Call a function at the state `own.x`, in the units of the user; its results are views of `out`."""
    if own.functions[which].address != 0:
        call_function(own.functions[which].address, t, own.x, out)
    else:
        evaluate_parts(own, which, t)


@kernel
def last_time(own):
    """Return the time of the last loads, about the present one, for messages about functions that fail."""
    t = own.seen[CALL_LOADS, 2 * own.n]
    return t if t == t else 0.0


@kernel
def find_inertia(own, state, moving):
    """Find M and, if `moving`, Gamma(v, v) of a state."""
    if is_new(own, CALL_INERTIA, state, 0.0, moving):
        call(own, CALL_INERTIA, last_time(own), own.inertia)
        measure(own.M, own.scale)
        for i in range(own.n):
            own.c[i] *= own.scale[i]
            for j in range(own.n):
                own.M[i, j] *= own.scale[i]


@kernel
def find_loads(own, state, t):
    """Find V, Q - dV and Q.v of a state."""
    if is_new(own, CALL_LOADS, state, t, True):
        call(own, CALL_LOADS, t, own.loads)
        for j in range(own.n):
            own.load[j] *= own.scale[j]


@kernel
def find_constraints(own, state, moving):
    """Find phi and A and, if `moving`, (dA/dt) v of a state."""
    if is_new(own, CALL_ROWS, state, 0.0, moving):
        call(own, CALL_ROWS, last_time(own), own.constraints)
        measure(own.A, own.scale)


@kernel
def find_gaps(own, state, moving):
    """Find gaps and G and, if `moving`, (dG/dt) v of a state."""
    if is_new(own, CALL_CONTACTS, state, 0.0, moving):
        call(own, CALL_CONTACTS, last_time(own), own.touching)
        for c in range(own.contacts):
            measure(own.G[c], own.scale)
