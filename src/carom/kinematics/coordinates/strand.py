"""Length of a strand of rope between two circles in a plane, with its parts of the arcs round both.

The circles have the centres c_1 and c_2 (points of parent and child), and the rope goes round them, by radii of
either sign, in the plane across an axis that is fixed in the world. With d = c_2 - c_1 in this plane,
rho = r_1 - r_2, and psi the angle of the strand,

    length  l = sqrt(d^2 - rho^2),    q = l + rho psi,    q' = e . d',    e = (l d + rho n x d)/d^2
    q'' = e . d'' + (e_2 . d')^2/l,   e_2 = n x e

since where the strand turns, as much of it is laid on one circle as is taken from the other.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.kinematics.coordinates.turns import TURN, turn_of
from carom.kinematics.joints import acceleration_bias, anchor_gap, anchor_speed


@kernel
def in_plane(c, v):
    """Return the components of a vector in the plane."""
    F = c.parent_frame
    x = F[0, 1] * v[0] + F[1, 1] * v[1] + F[2, 1] * v[2]
    y = F[0, 2] * v[0] + F[1, 2] * v[1] + F[2, 2] * v[2]
    return x, y


@kernel
def strand(c, state):
    """Return the length of the strand and its direction (2) in the plane."""
    x, y = in_plane(c, anchor_gap(c, state))
    d2, rho = x * x + y * y, c.length
    if not d2 > rho * rho:  # one circle is inside the other: there is no strand
        return 0.0, 1.0, 0.0
    length = math.sqrt(d2 - rho * rho)
    return length, (length * x - rho * y) / d2, (length * y + rho * x) / d2


@kernel
def angle_of(system, c, begin, state):
    """Return the angle of the strand, with the turns of its value; with no such those nearest to `begin`."""
    length, x, y = strand(c, state)
    if c.length != 0.0:
        return (value(system, c, state) - length) / c.length
    angle = math.atan2(y, x)
    return angle + TURN * math.floor((begin - angle) / TURN + 0.5)


@kernel
def turning_of(c, state):
    """Return the rate of this angle."""
    length, x, y = strand(c, state)
    u, v = in_plane(c, anchor_speed(c, state))
    return (x * v - y * u) / length if length > 0.0 else 0.0


@kernel
def slides(c):
    """Return True."""
    return True


@kernel
def along(system, c, state):
    """Return the direction of the strand."""
    _, x, y = strand(c, state)
    F = c.parent_frame
    return x * F[0, 1] + y * F[0, 2], x * F[1, 1] + y * F[1, 2], x * F[2, 1] + y * F[2, 2]


@kernel
def value(system, c, state):
    """Return the length with its arcs [m], with the turns that are nearest to those of its reference."""
    length, x, y = strand(c, state)
    q, turn = length + c.length * math.atan2(y, x), TURN * c.length
    if turn == 0.0:
        return length
    return q + turn * math.floor((turn_of(system, c).reference - q) / turn + 0.5)


@kernel
def drift(system, c, state, out):
    """Return q'' for bodies without acceleration; `out` is workspace (6,)."""
    length, x, y = strand(c, state)
    if not length > 0.0:
        return 0.0
    acceleration_bias(c, state, out)
    a, b = in_plane(c, (out[3], out[4], out[5]))
    u, v = in_plane(c, anchor_speed(c, state))
    across = x * v - y * u
    return across * across / length - (x * a + y * b)


@kernel
def counts_turns(c):
    """Return False: its arcs follow its reference."""
    return False


@kernel
def turn_within(system, c, start, end, h):
    """Return the angle that a step may lay on a circle."""
    if c.length == 0.0:
        return 0.0
    fastest = 0.0
    for side in range(2):
        u, v = in_plane(c, anchor_speed(c, start if side == 0 else end))
        fastest = max(fastest, math.sqrt(u * u + v * v))
    return h * fastest / abs(c.length)
