"""Coordinates of a joint at one time, for control loops: plain numbers are faster than arrays.

Results are those of `carom.results.joint_coordinates` for turns and slides along axes fixed in the parent.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom.scene.joints import Distance, Joint, Screw, Spherical, Universal

OTHERS = (Distance, Spherical, Universal, Screw)  # joints for which arrays are used
TURN = 2.0 * math.pi
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


class Side(NamedTuple):
    """A side of a joint: a point p of its definition is at x + Q (turn p turn* + offset) of its body."""

    body: int  # -1 for the ground
    turn: Quaternion
    offset: Vector
    anchor: Vector  # turn p turn* + offset for the anchor p


class Quick(NamedTuple):
    """A joint whose coordinates are turns and slides along axes of the parent."""

    parent: Side
    child: Side
    axes: list[tuple[bool, Vector]]  # whether it is a turn, and its axis in the definition


def quick(joint: Joint) -> Quick | None:
    """Return a prepared joint, or None for a joint of another kind."""
    d = joint.definition
    if isinstance(d, OTHERS):
        return None
    frames = (None, None) if joint.frames is None else joint.frames
    anchor = tuple(np.asarray(joint.anchor(), dtype=float).tolist())
    parent, child = _side(joint.parent, frames[0], anchor), _side(joint.child, frames[1], anchor)
    axes = [
        (kind == "turn", tuple(d.coordinate_frame(k)[:, 0].tolist()))
        for k, kind in enumerate(d.coordinates)
    ]
    return Quick(parent, child, axes)


def _side(body, frame, anchor) -> Side:
    """Return a side that is defined in the world at the start, or in a frame of the body."""
    if frame is not None:
        offset, turn = (tuple(np.asarray(part, dtype=float).tolist()) for part in frame)
    elif body.index < 0:
        offset, turn = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)
    else:
        turn = conjugate(tuple(body.orientation.tolist()))
        x, y, z = rotate(turn, tuple(body.position.tolist()))
        offset = -x, -y, -z
    return Side(body.index, turn, offset, add(rotate(turn, anchor), offset))


def coordinates(joint: Quick, state) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates and rates (n,); angles from -pi to pi."""
    p, c = (_placed(side, state) for side in (joint.parent, joint.child))
    relative = multiply(conjugate(p.turn), c.turn)
    spin, q, rates = subtract(c.spin, p.spin), [], []
    gap = subtract(add(c.position, c.arm), add(p.position, p.arm))
    speed = subtract(add(c.velocity, cross(c.spin, c.arm)), add(p.velocity, cross(p.spin, p.arm)))
    speed = subtract(speed, cross(p.spin, gap))  # relative to the rotating parent
    for turns, axis in joint.axes:
        along = rotate(p.turn, axis)
        if turns:
            angle = 2.0 * math.atan2(dot(relative[1:], axis), relative[0])
            q.append(angle - TURN * round(angle / TURN))
            rates.append(dot(along, spin))
        else:
            q.append(dot(along, gap))
            rates.append(dot(along, speed))
    return np.array(q), np.array(rates)


class _Placed(NamedTuple):
    """The present state of a side, in world axes."""

    turn: Quaternion
    arm: Vector  # from the mass centre to the anchor
    position: Vector
    velocity: Vector
    spin: Vector


def _placed(side: Side, state) -> _Placed:
    if side.body < 0:
        none = 0.0, 0.0, 0.0
        return _Placed(side.turn, side.anchor, none, none, none)
    k = side.body
    Q = state.orientation[k].tolist()
    moves = (a[k].tolist() for a in (state.position, state.velocity, state.angular_velocity))
    return _Placed(multiply(Q, side.turn), rotate(Q, side.anchor), *moves)


def add(a, b):
    """Return a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def subtract(a, b):
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def dot(a, b):
    """Return a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    """Return a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def conjugate(q):
    """Return the inverse of a unit quaternion."""
    return q[0], -q[1], -q[2], -q[3]


def multiply(p, q):
    """Return the product of two quaternions."""
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )


def rotate(q, v):
    """Return a vector rotated by a unit quaternion."""
    t = cross(q[1:], v)
    t = 2.0 * t[0], 2.0 * t[1], 2.0 * t[2]
    u = cross(q[1:], t)
    return v[0] + q[0] * t[0] + u[0], v[1] + q[0] * t[1] + u[1], v[2] + q[0] * t[2] + u[2]
