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
def is_new(system, which, state, t, moving):
    """Return whether a function must be called; if so, note that its results are those of a state."""
    own = system.own
    n, seen, x = own.n, own.seen[which], own.x
    if is_known(seen, n, state, t, moving):
        return False
    for j in range(n):
        x[j], x[n + j] = state[j].x[0], state[j].v[0]
        seen[j], seen[n + j] = x[j], x[n + j]
    seen[2 * n] = t
    return True


@kernel
def call(system, which, t, out):
    """Call a function at the state `own.x`; its results are views of `out`."""
    own = system.own
    if own.functions[which].address != 0:
        call_function(own.functions[which].address, t, own.x, out)
    else:
        evaluate_parts(system, which, t)


@kernel
def last_time(own):
    """Return the time of the last loads, about the present one, for messages about functions that fail."""
    t = own.seen[CALL_LOADS, 2 * own.n]
    return t if t == t else 0.0


@kernel
def find_inertia(system, state, moving):
    """Find M and, if `moving`, Gamma(v, v) of a state."""
    if is_new(system, CALL_INERTIA, state, 0.0, moving):
        call(system, CALL_INERTIA, last_time(system.own), system.own.inertia)


@kernel
def find_loads(system, state, t):
    """Find V, Q - dV and Q.v of a state."""
    if is_new(system, CALL_LOADS, state, t, True):
        call(system, CALL_LOADS, t, system.own.loads)


@kernel
def find_constraints(system, state, moving):
    """Find phi and A and, if `moving`, (dA/dt) v of a state."""
    if is_new(system, CALL_ROWS, state, 0.0, moving):
        call(system, CALL_ROWS, last_time(system.own), system.own.constraints)


@kernel
def find_gaps(system, state, moving):
    """Find gaps and G and, if `moving`, (dG/dt) v of a state."""
    if is_new(system, CALL_CONTACTS, state, 0.0, moving):
        call(system, CALL_CONTACTS, last_time(system.own), system.own.touching)
