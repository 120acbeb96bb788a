"""Angles: whole turns, and the speeds of a rotation."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel

TURN = 2.0 * math.pi


@kernel
def turn_of(system, c):
    """Return what a run keeps of a coordinate: `reference`, its value at the start of the trial step."""
    return system.relations.memory.coordinates[c.index]


@kernel
def with_turns(system, c, angle):
    """Return the angle nearest to the reference of a coordinate."""
    return angle + TURN * math.floor((turn_of(system, c).reference - angle) / TURN + 0.5)


@kernel
def angular_velocity(state, b):
    """Return the angular velocity of body b (-1: the ground)."""
    if b < 0:
        return 0.0, 0.0, 0.0
    w = state[b].w
    return w[0], w[1], w[2]


@kernel
def speed_of_turn(c, state):
    """Return the speed at which the child turns relative to the parent."""
    w, v = angular_velocity(state, c.child), angular_velocity(state, c.parent)
    x, y, z = w[0] - v[0], w[1] - v[1], w[2] - v[2]
    return math.sqrt(x * x + y * y + z * z)
