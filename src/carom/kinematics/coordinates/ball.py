"""Angles of a ball joint that a stop can limit, with the derivatives that a stop needs.

p_k and c_k are the axes of parent and child, which agree where all angles are 0, and w = w_c - w_p:

    rotation   of the child about any axis e:  sin phi e = 1/2 sum_k p_k x c_k,  2 cos phi + 1 = sum_k p_k . c_k
               phi' = e . w,    bias = (w_p x e) . w + 1/2 cot(phi / 2) (w . w - phi'^2)
    swing      between the axes p_0 and c_0:   sin theta n = p_0 x c_0,  cos theta = p_0 . c_0
               theta' = n . w,  bias = ((p_0 x c_0)' . w - cos theta theta'^2) / sin theta
    twist      about these axes, after the shortest turn from p_0 to c_0:
               tan tau = (p_2 . c_1 - p_1 . c_2) / (p_1 . c_1 + p_2 . c_2)
               tau' = g . w,    g = (p_0 + c_0) / (1 + p_0 . c_0),  bias = g' . w

Rotation and swing have no direction where they are 0, and the twist none where the swing is pi: there the
direction is any, and the bias is 0. Stops are elsewhere.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross
from carom.geometry.vectors import dot
from carom.kinematics.coordinates.turns import angular_velocity, speed_of_turn, with_turns
from carom.kinematics.joints import axis
from carom.model.arrays import SWING, TWIST


@kernel
def axes_of(c, state, k):
    """Return axis k of the parent and of the child."""
    return axis(state, c.parent, c.parent_frame, k), axis(state, c.child, c.child_frame, k)


@kernel
def sine_and_cosine(c, state):
    """Return sin(angle) times the axis, (3,), and cos(angle), of a rotation or a swing."""
    p, q = axes_of(c, state, 0)
    x, y, z = cross(p[0], p[1], p[2], q[0], q[1], q[2])
    if c.kind == SWING:
        return x, y, z, dot(p, q)
    total = dot(p, q)
    for k in range(1, 3):
        p, q = axes_of(c, state, k)
        u, v, w = cross(p[0], p[1], p[2], q[0], q[1], q[2])
        x, y, z, total = x + u, y + v, z + w, total + dot(p, q)
    return 0.5 * x, 0.5 * y, 0.5 * z, 0.5 * (total - 1.0)


@kernel
def angle_of(c, state):
    """Return the angle; a twist from -pi to pi."""
    if c.kind == TWIST:
        p1, c1 = axes_of(c, state, 1)
        p2, c2 = axes_of(c, state, 2)
        return math.atan2(dot(p2, c1) - dot(p1, c2), dot(p1, c1) + dot(p2, c2))
    x, y, z, cosine = sine_and_cosine(c, state)
    return math.atan2(math.sqrt(x * x + y * y + z * z), cosine)


@kernel
def along(system, c, state):
    """Return the direction g in which the angle grows: its rate is g . w. That of a twist is longer than 1."""
    p, q = axes_of(c, state, 0)
    if c.kind == TWIST:
        whole = 1.0 + dot(p, q)
        f = 1.0 / whole if whole > 0.0 else 0.0
        return f * (p[0] + q[0]), f * (p[1] + q[1]), f * (p[2] + q[2])
    x, y, z, _ = sine_and_cosine(c, state)
    sine = math.sqrt(x * x + y * y + z * z)
    if not sine > 0.0:
        return axis(state, c.parent, c.parent_frame, 1)
    return x / sine, y / sine, z / sine


@kernel
def value(system, c, state):
    """Return the angle; that of a twist with its whole turns."""
    angle = angle_of(c, state)
    return with_turns(system, c, angle) if c.kind == TWIST else angle


@kernel
def counts_turns(c):
    """Return whether it is a twist."""
    return c.kind == TWIST


@kernel
def turn_within(system, c, start, end, h):
    """Return the angle of the whole rotation: those of a ball joint may turn back within a step."""
    return h * max(speed_of_turn(c, start), speed_of_turn(c, end))


@kernel
def drift(system, c, state, out):
    """Return g' . (w - v), with the angular velocities w of the child and v of the parent."""
    w, v = angular_velocity(state, c.child), angular_velocity(state, c.parent)
    p, q = axes_of(c, state, 0)
    u = (w[0] - v[0], w[1] - v[1], w[2] - v[2])
    dp, dq = cross(v[0], v[1], v[2], p[0], p[1], p[2]), cross(w[0], w[1], w[2], q[0], q[1], q[2])
    if c.kind == TWIST:
        whole = 1.0 + dot(p, q)
        if not whole > 0.0:
            return 0.0
        grown, along = dot(dp, q) + dot(p, dq), dot(p, u) + dot(q, u)
        return (dot(dp, u) + dot(dq, u) - along * grown / whole) / whole
    x, y, z, cosine = sine_and_cosine(c, state)
    sine = math.sqrt(x * x + y * y + z * z)
    if not sine > 0.0:
        return 0.0
    e = (x / sine, y / sine, z / sine)
    rate = dot(e, u)
    if c.kind == SWING:
        one = cross(dp[0], dp[1], dp[2], q[0], q[1], q[2])
        other = cross(p[0], p[1], p[2], dq[0], dq[1], dq[2])
        return (dot(one, u) + dot(other, u) - cosine * rate * rate) / sine
    turned = cross(v[0], v[1], v[2], e[0], e[1], e[2])
    return dot(turned, u) + 0.5 * (1.0 + cosine) / sine * (dot(u, u) - rate * rate)
