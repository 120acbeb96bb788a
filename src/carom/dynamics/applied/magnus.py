"""Lift of a body that turns in a flow, F = S w x (v - flow), at the mass centre (Magnus)."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross


@kernel
def add(system, one, state, power, work):
    """Add the force; return `power` with its own, which is 0 in a fluid at rest."""
    v, w, wrench = state[one.child].v, state[one.child].w, work.body[one.child].wrench
    u = (v[0] - one.flow[0], v[1] - one.flow[1], v[2] - one.flow[2])
    f = cross(w[0], w[1], w[2], u[0], u[1], u[2])
    for k in range(3):
        wrench[k] += one.factor * f[k]
        power += one.factor * f[k] * v[k]
    return power, math.nan, math.nan, math.nan


@kernel
def acts_at(system, one, state):
    """Return the arm to the mass centre: 0."""
    return 0.0, 0.0, 0.0
