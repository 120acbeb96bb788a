"""Distance of two points, which a tether limits: q = |d|, d from the point of the parent to that of the child.

With e = d/|d| and the velocity u of the one point relative to the other: q' = e . u, and for bodies without
acceleration q'' = e . u' + |u - q' e|^2/|d|. Where the points meet, e has no direction: there it is any.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.vectors import dot
from carom.kinematics.joints import acceleration_bias, anchor_gap, anchor_speed


@kernel
def slides(c):
    """Return True."""
    return True


@kernel
def value(system, c, state):
    """Return the distance [m]."""
    d = anchor_gap(c, state)
    return math.sqrt(dot(d, d))


@kernel
def along(system, c, state):
    """Return the direction from the point of the parent to that of the child."""
    d = anchor_gap(c, state)
    length = math.sqrt(dot(d, d))
    if not length > 0.0:
        return 1.0, 0.0, 0.0
    return d[0] / length, d[1] / length, d[2] / length


@kernel
def drift(system, c, state, out):
    """Return q'' for bodies without acceleration; `out` is workspace (6,)."""
    d, u = anchor_gap(c, state), anchor_speed(c, state)
    length = math.sqrt(dot(d, d))
    if not length > 0.0:
        return 0.0
    acceleration_bias(c, state, out)
    turned, speed = d[0] * out[3] + d[1] * out[4] + d[2] * out[5], dot(d, u) / length
    return (dot(u, u) - speed * speed - turned) / length


@kernel
def turns_with_place(c):
    """Return True."""
    return True


@kernel
def counts_turns(c):
    """Return False."""
    return False


@kernel
def turn_within(system, c, start, end, h):
    """Return 0: a distance has no turns."""
    return 0.0
