"""A gap, or a speed along it, of a contact in coordinates of the user's own: row `number` of the contacts.

The rows (n, t1, t2) of contact c are the coordinates 3 c, 3 c + 1 and 3 c + 2; only the first has a value.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.kinematics.chart import find_gaps


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
    find_gaps(system.chart, state, False)
    gap = system.chart.gap[c.number // 3]
    return gap if gap < math.inf else math.nan


@unit
def rate(system, c, state) -> float:
    """Return G v."""
    return rate_in(system, c, state, state)


@unit
def rate_in(system, c, pose, state) -> float:
    """Return G v with the positions of one state and the velocities of another."""
    chart, total = system.chart, 0.0
    find_gaps(system.chart, pose, False)
    for j in range(chart.n):
        total += chart.G[c.number // 3, c.number % 3, j] * state[j].v[0]
    return total


@unit
def drift(system, c, state, out) -> float:
    """Return (dG/dt) v."""
    find_gaps(system.chart, state, True)
    return system.chart.G_rate[c.number // 3, c.number % 3]


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
    chart = system.chart
    find_gaps(system.chart, state, False)
    for j in range(chart.n):
        work.body[j].wrench[0] += force * chart.G[c.number // 3, c.number % 3, j]


@unit
def motion_along(system, c, state, work) -> float:
    """Return G of the motions that the last solve wrote."""
    chart, total = system.chart, 0.0
    find_gaps(system.chart, state, False)
    for j in range(chart.n):
        total += chart.G[c.number // 3, c.number % 3, j] * work.body[j].motion[0]
    return total


@unit
def acceleration_along(system, c, state, stage) -> float:
    """Return G of the accelerations of a stage."""
    chart, total = system.chart, 0.0
    find_gaps(system.chart, state, False)
    for j in range(chart.n):
        total += chart.G[c.number // 3, c.number % 3, j] * stage[j].rate[0]
    return total


@unit
def speeds_of(system, c, state) -> float:
    """Return the sum of the terms of its rate."""
    chart, total = system.chart, 0.0
    find_gaps(system.chart, state, False)
    for j in range(chart.n):
        total += abs(chart.G[c.number // 3, c.number % 3, j] * state[j].v[0])
    return total
