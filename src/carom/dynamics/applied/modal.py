"""Modes of flexible bodies: M q'' = -k q - c q' + f for the body that stands for three of them.

Gravity, which acts on all bodies, is taken off: modes about mean axes do not move the mass centre, and the
weight of a body on supports is its load f = weight R^T g.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.vectors import dot
from carom.kinematics.flexible import in_body


@kernel
def add(system, one, state, power, work):
    """Add the forces of three modes; return `power` with that of their dampers."""
    b, g = one.child, system.gravity
    x, v, wrench, mass = state[b].x, state[b].v, work.body[b].wrench, system.bodies[b].mass
    a = in_body(system, one.parent, state, g)
    for k in range(3):
        drag = one.damping[k] * v[k]
        wrench[k] += dot(one.weight[k], a) - one.stiffness[k] * x[k] - drag - mass * g[k]
        power -= drag * v[k]
    return power, math.nan, math.nan, math.nan


@kernel
def acts_at(system, one, state):
    """Return no arm: they act on no point."""
    return 0.0, 0.0, 0.0


@kernel
def energy(system, one, state, t):
    """Return the strain energy, and the potential of gravity with the opposite sign [J]."""
    b, g, total = one.child, system.gravity, 0.0
    x, mass = state[b].x, system.bodies[b].mass
    a = in_body(system, one.parent, state, g)
    for k in range(3):
        total += (0.5 * one.stiffness[k] * x[k] - dot(one.weight[k], a) + mass * g[k]) * x[k]
    return total
