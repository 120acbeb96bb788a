"""Buoyancy: the weight of the fluid that a body displaces, against gravity, at the mass centre.

A ball of radius r with its centre at the depth d below the surface has the depth h = r + d of its lowest point:

    displaced volume   V(h) = pi h^2 (3 r - h)/3                  for 0 < h < 2 r
    energy             U(h) = rho g pi (r h^3/3 - h^4/12)         the work to push it down that far

Without a surface the whole volume is displaced everywhere, and U = rho V g . x.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel


@kernel
def strength(system):
    """Return |g|."""
    g = system.gravity
    return math.sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2])


@kernel
def depth_of(system, one, state):
    """Return the depth of the lowest point below the surface, which is at a height along -g."""
    g, x, size = system.gravity, state[one.child].x, strength(system)
    height = -(g[0] * x[0] + g[1] * x[1] + g[2] * x[2]) / size
    return one.radius + one.surface - height


@kernel
def displaced(one, h):
    """Return the volume below the surface."""
    if h <= 0.0:
        return 0.0
    if h >= 2.0 * one.radius:
        return one.volume
    return math.pi * h * h * (3.0 * one.radius - h) / 3.0


@kernel
def add(system, one, state, power, work):
    """Add the force, which has a potential; return `power`."""
    g, wrench, volume = system.gravity, work.body[one.child].wrench, one.volume
    if one.bounded == 1 and strength(system) > 0.0:
        volume = displaced(one, depth_of(system, one, state))
    for k in range(3):
        wrench[k] -= one.density * volume * g[k]
    return power, math.nan, math.nan, math.nan


@kernel
def energy(system, one, state, t):
    """Return the potential energy [J]."""
    g, x, size = system.gravity, state[one.child].x, strength(system)
    if one.bounded == 0:
        return one.density * one.volume * (g[0] * x[0] + g[1] * x[1] + g[2] * x[2])
    if not size > 0.0:
        return 0.0
    h, r = depth_of(system, one, state), one.radius
    inside = min(max(0.0, h), 2.0 * r)
    pushed = math.pi * (r * inside**3 / 3.0 - inside**4 / 12.0)
    return one.density * size * (pushed + one.volume * max(0.0, h - 2.0 * r))


@kernel
def acts_at(system, one, state):
    """Return the arm to the mass centre: 0."""
    return 0.0, 0.0, 0.0
