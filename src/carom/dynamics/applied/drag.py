"""Quadratic drag in a fluid at rest or that flows: F = -k |u| u, u = v - flow(t, x), at the mass centre."""

from __future__ import annotations

import math

from carom._compiled.call_address import call_function
from carom._compiled.decorators import kernel
from carom.geometry.rotation import norm


@kernel
def flow_at(system, one, state, t):
    """Return the velocity of the fluid at the mass centre."""
    if one.address == 0:
        return one.flow[0], one.flow[1], one.flow[2]
    memory, x = system.relations.memory, state[one.child].x
    for k in range(3):
        memory.read[k] = x[k]
    call_function(one.address, t, memory.read, memory.write)
    return memory.write[0], memory.write[1], memory.write[2]


@kernel
def add(system, one, state, power, work):
    """Add the force; return `power` with its own."""
    v, wrench = state[one.child].v, work.body[one.child].wrench
    w = flow_at(system, one, state, work.moment[0].time)
    u = (v[0] - w[0], v[1] - w[1], v[2] - w[2])
    f = -one.factor * norm(u)
    for k in range(3):
        wrench[k] += f * u[k]
        power += f * u[k] * v[k]
    return power, math.nan, math.nan, math.nan


@kernel
def acts_at(system, one, state):
    """Return the arm to the mass centre: 0."""
    return 0.0, 0.0, 0.0
