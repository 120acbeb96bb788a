"""A gap, or a speed along it, of a contact in coordinates of the user's own: row `number` of the contacts.

The rows (n, t1, t2) of contact c are the coordinates 3 c, 3 c + 1 and 3 c + 2; only the first has a value.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.kinematics.own_functions import find_gaps


@kernel
def slides(c):
    """Return True."""
    return True


@kernel
def along(system, c, state):
    """Return any direction: a coordinate has none in space."""
    return 1.0, 0.0, 0.0


@unit
def value(system, c, state) -> float:
    """Return the gap, or no number where its function has no value."""
    find_gaps(system.own, state, False)
    gap = system.own.gap[c.number // 3]
    return gap if gap < math.inf else math.nan


@unit
def rate(system, c, state) -> float:
    """Return G v."""
    return rate_in(system, c, state, state)


@unit
def rate_in(system, c, pose, state) -> float:
    """Return G v with the positions of one state and the velocities of another."""
    own, total = system.own, 0.0
    find_gaps(system.own, pose, False)
    for j in range(own.n):
        total += own.G[c.number // 3, c.number % 3, j] * state[j].v[0]
    return total


@unit
def drift(system, c, state, out) -> float:
    """Return (dG/dt) v."""
    find_gaps(system.own, state, True)
    return system.own.G_rate[c.number // 3, c.number % 3]


@kernel
def counts_turns(c):
    """Return False."""
    return False


@kernel
def turn_within(system, c, start, end, h):
    """Return 0: it has no turns."""
    return 0.0


@unit
def push(system, c, state, force, work):
    """Add G^T force."""
    own = system.own
    find_gaps(system.own, state, False)
    for j in range(own.n):
        work.body[j].wrench[0] += force * own.G[c.number // 3, c.number % 3, j]


@unit
def motion_along(system, c, state, work) -> float:
    """Return G of the motions that the last solve wrote."""
    own, total = system.own, 0.0
    find_gaps(system.own, state, False)
    for j in range(own.n):
        total += own.G[c.number // 3, c.number % 3, j] * work.body[j].motion[0]
    return total


@unit
def acceleration_along(system, c, state, stage) -> float:
    """Return G of the accelerations of a stage."""
    own, total = system.own, 0.0
    find_gaps(system.own, state, False)
    for j in range(own.n):
        total += own.G[c.number // 3, c.number % 3, j] * stage[j].rate[0]
    return total


@unit
def speeds_of(system, c, state) -> float:
    """Return the sum of the terms of its rate."""
    own, total = system.own, 0.0
    find_gaps(system.own, state, False)
    for j in range(own.n):
        total += abs(own.G[c.number // 3, c.number % 3, j] * state[j].v[0])
    return total
