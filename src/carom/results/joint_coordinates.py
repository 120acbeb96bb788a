"""Coordinates of joints: the motion of the child relative to the parent, at one time or at many.

Vectors and quaternions are tuples of components: numbers at one time, because arrays would take ten times as
long in a control loop, and arrays (T,) for the times of a run.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, cast

import numpy as np

from carom import checks
from carom.geometry import quaternion
from carom.scene import joints as j
from carom.scene.joints import Joint

DEGREES = 180.0 / math.pi
ON_CURVE = (j.PointOnCurve, j.CurveOnPoint)
Vector = tuple[Any, Any, Any]
Quaternion = tuple[Any, Any, Any, Any]


class Side(NamedTuple):
    """A side of a joint: a vector e of its definition is turn e turn* in its body, the anchor at `anchor`."""

    body: int  # -1 for the ground
    turn: Quaternion
    anchor: Vector


class Sides(NamedTuple):
    """A joint of a scene, prepared."""

    definition: j.JointDefinition
    parent: Side
    child: Side
    axes: list[Vector]  # of its coordinates, in the definition
    point: Vector  # the anchor in the definition


def sides_of(joint: Joint) -> Sides:
    """Return a prepared joint. It is defined in the world at the start, or in frames of both bodies."""
    d = joint.definition
    points = (joint.anchor(),) * 2
    if isinstance(d, j.Distance):
        points = d.anchor_parent, d.anchor_child
    frames = (None, None) if joint.frames is None else joint.frames
    parts = zip((joint.parent, joint.child), frames, points)
    axes = [_numbers(d.coordinate_frame(k)[:, 0]) for k in range(len(d.coordinates))]
    parent, child = (side_of(*part) for part in parts)
    return Sides(d, parent, child, axes, _numbers(joint.anchor()))


def side_of(body, frame, point) -> Side:
    """Return the side of a body: in its `frame`, or None: of axes and a `point` in the world at the start."""
    if frame is not None:
        offset, turn = (_numbers(part) for part in frame)
    elif body.index < 0:
        offset, turn = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)
    else:
        turn = conjugate(_numbers(body.orientation))
        x, y, z = rotate(turn, _numbers(body.position))
        offset = -x, -y, -z
    return Side(body.index, turn, add(rotate(turn, _numbers(point)), offset))


def _numbers(array) -> tuple:
    return tuple(np.asarray(array, dtype=float).tolist())


def coordinates(
    joint: Sides, states, t: np.ndarray | None = None, turns=None
) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates and rates of a joint, (T, n) at times t, or (n,) of one time.

    `states` have position, orientation, velocity and angular velocity (T, N, ...), or (N, ...) of one time.
    `turns` are the coordinates by their index, with the turns that the run has counted. What it does not
    have is from minus to plus half a turn at one time, and counted by the rates between several.
    """
    d, atan2 = joint.definition, math.atan2 if t is None else np.arctan2
    p, c = (placed(side, states) for side in (joint.parent, joint.child))
    relative, spin = multiply(conjugate(p.turn), c.turn), subtract(c.spin, p.spin)
    if isinstance(d, j.Spherical):
        turned = quaternion.log(np.array(relative).T)
        return turned, np.array(rotate(conjugate(p.turn), spin)).T
    gap = subtract(add(c.position, c.arm), add(p.position, p.arm))
    speed = subtract(add(c.velocity, cross(c.spin, c.arm)), add(p.velocity, cross(p.spin, p.arm)))
    if d.guide == "curve":
        pairs = [_along_curve(joint, p, c)]
    elif isinstance(d, j.Distance):
        length = np.sqrt(dot(gap, gap))
        pairs = [(length, dot(gap, speed) / length)]
    elif isinstance(d, j.Universal):
        pairs = _of_cross(d, relative, (p.turn, c.turn), spin, atan2)
    else:
        speed = subtract(speed, cross(p.spin, gap))  # relative to the rotating parent
        pairs = []
        for kind, axis in zip(d.coordinates, joint.axes):
            along = rotate(p.turn, axis)
            if kind == "turn":
                angle = 2.0 * atan2(dot(relative[1:], axis), relative[0])
                pairs.append((angle, dot(along, spin)))
            else:
                pairs.append((dot(along, gap), dot(along, speed)))
    for k in range(len(d.coordinates)):
        whole = d.period(k)
        if whole > 0.0:
            (q, rate), near = pairs[k], None if turns is None else turns.get(k)
            if near is not None or t is None:
                q = q + whole * np.round(((0.0 if near is None else near) - q) / whole)
            else:
                q = unwrapped(q, rate, t, whole)
            pairs[k] = q, rate
    if isinstance(d, j.Screw):  # the displacement gives the angle with all whole turns
        pairs[0] = pairs[1][0] / d.scale(), pairs[0][1]
    none = np.zeros((0,) if t is None else (len(t), 0))
    q, rates = (np.array(column).T for column in zip(*pairs)) if pairs else (none, none.copy())
    return q, rates


def _of_cross(d: j.Universal, relative: Quaternion, turns, spin: Vector, atan2) -> list[tuple]:
    """Return the angles of Rot(first, q1) Rot(second, q2), the relative rotation of the child."""
    first, second = _numbers(d.axis_parent), _numbers(d.axis_child)
    third = cross(first, second)
    one, two, three = (rotate(relative, axis) for axis in (first, second, third))
    angles = atan2(dot(third, two), dot(second, two)), atan2(dot(first, three), dot(first, one))
    axes = (rotate(turn, axis) for turn, axis in zip(turns, (first, second)))
    return [(angle, dot(axis, spin)) for angle, axis in zip(angles, axes)]


def _along_curve(joint: Sides, p: Placed, c: Placed) -> tuple[Any, Any]:
    """Return arc length and rate of a joint on a curve."""
    d: Any = joint.definition
    s, tangent, velocity, beside = _foot(joint, p, c)
    rate = np.sum(tangent * velocity, axis=1)
    if (
        isinstance(d, j.PointOnCurve) and d.side is not None
    ):  # in flight the foot has a speed of its own
        curve = d.curve if d.plane.any() else d.shadow
        _, slope, bend = curve._at(s)
        ahead = np.sum(slope**2, axis=1) - np.sum(beside * bend, axis=1)
        rate = np.sum(slope * velocity, axis=1) / ahead
    q = s - d.foot(np.array(joint.point))
    return (q, rate) if np.ndim(p.turn[0]) or np.ndim(c.turn[0]) else (float(q[0]), float(rate[0]))


def gaps_of_rail(joint: Joint, states) -> np.ndarray:
    """Return the distances (T,) of a point from a rail that can be left, towards the free side."""
    sides, d = sides_of(joint), cast(Any, joint.definition)
    p, c = (placed(side, states) for side in (sides.parent, sides.child))
    s, _, _, beside = _foot(sides, p, c)
    return np.sum(d.free(joint.anchor(), s) * beside, axis=1)


def _foot(joint: Sides, p: Placed, c: Placed) -> tuple[np.ndarray, ...]:
    """Return arc length (T,), and (T, 3) tangent, velocity and place beside the curve, in its own axes."""
    d: Any = joint.definition
    owner, point = (p, c) if isinstance(d, j.PointOnCurve) else (c, p)
    gap = subtract(add(point.position, point.arm), add(owner.position, owner.arm))
    arm = add(owner.arm, gap)
    speed = subtract(point.velocity, add(owner.velocity, cross(owner.spin, arm)))
    speed = add(speed, cross(point.spin, point.arm))
    back = conjugate(owner.turn)
    place, velocity = (
        np.atleast_2d(np.array(np.broadcast_arrays(*rotate(back, one))).T) for one in (gap, speed)
    )
    place = place + joint.point
    s = d.feet(place, velocity)
    return s, d.curve.tangent(s), velocity, place - d.curve.point(s)


def direction(joint: Sides, states, k: int | str) -> Vector:
    """Return the axis along, or about, which coordinate k changes; it turns with the parent, or the child."""
    d, second = joint.definition, isinstance(joint.definition, j.Universal) and k == 1
    if isinstance(d, ON_CURVE):
        p, c = (placed(side, states) for side in (joint.parent, joint.child))
        tangent = _foot(joint, p, c)[1].T
        tangent = tangent if states.position.ndim == 3 else tangent[:, 0]
        if isinstance(d, j.PointOnCurve):
            return rotate(p.turn, tangent)
        return rotate(c.turn, -tangent)
    if isinstance(k, str):
        return _along_ball(joint, states, k)
    axis = joint.axes[k]
    if isinstance(d, j.Universal):
        axis = _numbers(d.axis_child if second else d.axis_parent)
    return rotate(placed(joint.child if second else joint.parent, states).turn, axis)


def _axes_of_ball(joint: Sides, states) -> list[list[Vector]]:
    """Return the axes of parent and child that agree where the angles of a ball joint are 0."""
    d: Any = joint.definition
    turns = (placed(side, states).turn for side in (joint.parent, joint.child))
    return [
        [rotate(turn, _numbers(axis)) for axis in frame.T]
        for turn, frame in zip(turns, d.frames_of_limits())
    ]


def _along_ball(joint: Sides, states, which: str) -> Vector:
    """Return the direction in which an angle of a ball joint grows (`carom.kinematics.ball`)."""
    p, c = _axes_of_ball(joint, states)
    if which == "twist":
        total, size = add(p[0], c[0]), 1.0 + dot(p[0], c[0])
    else:
        total = cross(p[0], c[0])
        if which == "rotation":
            total = add(add(total, cross(p[1], c[1])), cross(p[2], c[2]))
        size = np.sqrt(dot(total, total))
    return total[0] / size, total[1] / size, total[2] / size


def limited_angle(joint: Joint, which: str, states) -> Any:
    """Return an angle of a ball joint (T,), or at one time: a twist then from -pi to pi."""
    sides = sides_of(joint)
    p, c = _axes_of_ball(sides, states)
    if which == "twist":
        q = np.arctan2(dot(p[2], c[1]) - dot(p[1], c[2]), dot(p[1], c[1]) + dot(p[2], c[2]))
        if np.ndim(q) == 0:
            return float(q)
        spins = (placed(side, states).spin for side in (sides.child, sides.parent))
        rate = dot(_along_ball(sides, states, which), subtract(*spins))
        return unwrapped(q, rate, states.t, 2.0 * math.pi)
    x, cosine = cross(p[0], c[0]), dot(p[0], c[0])
    if which == "rotation":
        x = add(add(x, cross(p[1], c[1])), cross(p[2], c[2]))
        x, cosine = (
            tuple(0.5 * one for one in x),
            0.5 * (cosine + dot(p[1], c[1]) + dot(p[2], c[2]) - 1.0),
        )
    return np.arctan2(np.sqrt(dot(x, x)), cosine)[()]


def in_degrees(joint: Joint, q: np.ndarray, rate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates and rates with angles in degrees and degrees a second."""
    factors = np.array([DEGREES if unit == "rad" else 1.0 for unit in units(joint)])
    return q * factors, rate * factors


def units(joint: Joint, degrees: bool = False) -> list[str]:
    """Return the units of the coordinates of a joint; none for one without."""
    d, angle = joint.definition, "deg" if degrees else "rad"
    if isinstance(d, j.Distance):
        return ["m"]
    if isinstance(d, j.Spherical):
        return [angle] * 3
    return [angle if kind == "turn" else "m" for kind in d.coordinates]


def child_arm(joint: Sides, p: Placed, c: Placed) -> Vector:
    """Return the arm of the child to where a joint acts: its anchor, or that of the parent on its curve."""
    if isinstance(joint.definition, j.CurveOnPoint):
        return subtract(add(p.position, p.arm), c.position)
    return c.arm


class Placed(NamedTuple):
    """The state of a side, in world axes."""

    turn: Quaternion  # from the axes of the definition
    arm: Vector  # from the mass centre to the anchor
    position: Vector
    velocity: Vector
    spin: Vector


def placed(side: Side, states) -> Placed:
    """Return the state of a side."""
    if side.body < 0:
        none = 0.0, 0.0, 0.0
        return Placed(side.turn, side.anchor, none, none, none)
    moves = states.orientation, states.position, states.velocity, states.angular_velocity
    k = side.body
    Q, x, v, w = (a[k].tolist() if a.ndim == 2 else tuple(a[:, k].T) for a in moves)
    return Placed(multiply(Q, side.turn), rotate(Q, side.anchor), x, v, w)


def of_scene(scene, joint) -> Joint:
    """Return a joint of the scene; the argument is the joint or its name."""
    if isinstance(joint, str):
        try:
            joint = scene[joint]
        except KeyError as error:
            raise KeyError(f"joint: {error.args[0]}") from None
    checks.instance("joint", joint, (Joint, str))
    if joint not in scene:
        raise ValueError(
            f"joint must belong to the scene of this solution, got {checks.shown(joint)}"
        )
    return scene[joint.name]


def turns_of(
    joint: Joint, columns: dict[tuple[int, int], int], turns: np.ndarray
) -> dict[int, Any]:
    """Return the coordinates (...,) of a joint by their own index, of `turns` (..., C) that a run has counted.

    `columns` are as of `carom.scene.constraints.counted`; C is 0 in files of earlier versions.
    """
    own = ((k, columns.get((joint.index, k))) for k in range(len(joint.definition.coordinates)))
    return {k: turns[..., column] for k, column in own if column is not None and turns.shape[-1]}


def unwrapped(q: np.ndarray, rate: np.ndarray, t: np.ndarray, whole: float) -> np.ndarray:
    """Return coordinates (T,) with whole turns or laps, counted with the mean rates between saved times."""
    ahead = 0.5 * (rate[1:] + rate[:-1]) * np.diff(t) - np.diff(q)
    turns = np.cumsum(np.round(ahead / whole))
    return q + whole * np.concatenate([[0.0], turns])


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
