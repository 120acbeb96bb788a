"""Coordinates of joints from a finished run: the motion of the child relative to the parent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom import checks
from carom.geometry import quaternion
from carom.scene import joints as j
from carom.scene.joints import Joint


def joint_coordinates(solution, joint) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates and rates (T, n) of a joint; see `Solution.joint_coordinates`."""
    motion = Motion(
        solution.t, solution.position, solution.orientation, solution.velocity,
        solution.angular_velocity,
    )  # fmt: skip
    return coordinates_of(motion, of_scene(solution.scene, joint))


class Motion(NamedTuple):
    """A motion at T times, with the orientations of the scene's body axes."""

    t: np.ndarray
    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray


def coordinates_of(motion: Motion, joint: Joint) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates and rates (T, n) of a joint of the scene in a motion."""
    d, sides = joint.definition, _Sides(motion, joint)
    if isinstance(d, j.Distance):
        columns = [sides.length(d.anchor_parent, d.anchor_child)]
    elif isinstance(d, j.Spherical):
        return sides.ball()
    elif isinstance(d, j.Universal):
        columns = sides.cross(d.axis_parent, d.axis_child)
    else:
        columns = _columns(sides, joint)
    q = np.stack([a for a, _ in columns], axis=1) if columns else np.zeros((len(motion.t), 0))
    return q, np.stack([b for _, b in columns], axis=1) if columns else q.copy()


def _columns(sides, joint):
    """Return pairs (coordinate, rate) of a joint whose axes are fixed in the parent."""
    d, anchor, columns = joint.definition, joint.anchor(), []
    for k, kind in enumerate(d.coordinates):
        axis = d.coordinate_frame(k)[:, 0]
        columns.append(sides.turn(axis) if kind == "turn" else sides.slide(anchor, axis))
    if isinstance(d, j.Screw):  # the displacement gives the angle with all whole turns
        (_, rate), (along, speed) = columns
        return [(along / d.scale(), rate), (along, speed)]
    return columns


def of_scene(scene, joint) -> Joint:
    """Return a joint of the scene; the argument is the joint or its name."""
    if isinstance(joint, str):
        try:
            joint = scene[joint]
        except KeyError as error:
            raise KeyError(f"joint: {error.args[0]}") from None
    checks.instance("joint", joint, (Joint, str))
    if joint.index >= len(scene.joints) or scene.joints[joint.index] is not joint:
        raise ValueError(
            f"joint must belong to the scene of this solution, got {checks.shown(joint)}"
        )
    return joint


class _Side(NamedTuple):
    """One side of a joint at T times: a point p of the joint's definition is at x + R p + offset."""

    turn: np.ndarray  # (T, 4) R as a quaternion, from the axes of the definition to the world
    offset: np.ndarray  # (T, 3)
    position: np.ndarray  # (T, 3) x, the mass centre
    velocity: np.ndarray
    spin: np.ndarray

    def arm(self, point) -> np.ndarray:
        """Return the arm (T, 3) from the centre to a point of the definition."""
        return quaternion.rotate(self.turn, point) + self.offset


def _side(motion, body, frame) -> _Side:
    """Return a side of a joint, which is defined in the world at the start, or in a frame of the body."""
    k, zero = body.index, np.zeros((len(motion.t), 3))
    same = np.tile([1.0, 0.0, 0.0, 0.0], (len(zero), 1))
    Q = same if k < 0 else motion.orientation[:, k]
    x, v, w = (
        zero if k < 0 else a[:, k]
        for a in (motion.position, motion.velocity, motion.angular_velocity)
    )
    if frame is not None:
        position, orientation = frame
        return _Side(
            quaternion.multiply(Q, np.broadcast_to(orientation, Q.shape)),
            quaternion.rotate(Q, position), x, v, w,
        )  # fmt: skip
    if k < 0:
        return _Side(Q, zero, x, v, w)
    turn = quaternion.multiply(Q, quaternion.conjugate(body.orientation))
    return _Side(turn, -quaternion.rotate(turn, body.position), x, v, w)


class _Sides:
    """Both sides of a joint over the run, and their relative rotation, in world axes."""

    def __init__(self, motion, joint):
        self.t = motion.t
        frames = (None, None) if joint.frames is None else joint.frames
        self.parent = _side(motion, joint.parent, frames[0])
        self.child = _side(motion, joint.child, frames[1])
        self.relative = quaternion.multiply(quaternion.conjugate(self.parent.turn), self.child.turn)
        self.spin = self.child.spin - self.parent.spin

    def across(self, start, end):
        """Return the vector (T, 3) from a point of the parent to a point of the child, and its velocity."""
        p, c = self.parent, self.child
        rp, rc = p.arm(start), c.arm(end)
        gap = c.position + rc - p.position - rp
        return gap, c.velocity + np.cross(c.spin, rc) - p.velocity - np.cross(p.spin, rp)

    def slide(self, anchor, direction):
        e = quaternion.rotate(self.parent.turn, direction)
        gap, speed = self.across(anchor, anchor)
        # relative to the rotating parent: without w_p x gap
        speed = speed - np.cross(self.parent.spin, gap)
        return np.sum(e * gap, axis=1), np.sum(e * speed, axis=1)

    def length(self, start, end):
        gap, speed = self.across(start, end)
        length = np.linalg.norm(gap, axis=1)
        return length, np.sum(gap * speed, axis=1) / length

    def turn(self, axis):
        q, e = self.relative, quaternion.rotate(self.parent.turn, axis)
        rate = np.sum(e * self.spin, axis=1)
        return unwrapped(2.0 * np.arctan2(q[:, 1:] @ axis, q[:, 0]), rate, self.t), rate

    def cross(self, first, second):
        """Return the angles of Rot(first, q1) Rot(second, q2), the relative rotation of the child."""
        frame = np.stack([first, second, np.cross(first, second)], axis=1)
        C = frame.T @ quaternion.matrix(self.relative) @ frame
        angles = np.arctan2(C[:, 2, 1], C[:, 1, 1]), np.arctan2(C[:, 0, 2], C[:, 0, 0])
        axes = (
            quaternion.rotate(self.parent.turn, first),
            quaternion.rotate(self.child.turn, second),
        )
        rates = [np.sum(e * self.spin, axis=1) for e in axes]
        return [(unwrapped(a, r, self.t), r) for a, r in zip(angles, rates)]

    def ball(self):
        rate = quaternion.rotate_back(self.parent.turn, self.spin)
        return quaternion.log(self.relative), rate


def unwrapped(angle: np.ndarray, rate: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Return angles (T,) with whole turns, counted with the mean rates between saved times."""
    ahead = 0.5 * (rate[1:] + rate[:-1]) * np.diff(t) - np.diff(angle)
    turns = np.cumsum(np.round(ahead / (2.0 * np.pi)))
    return angle + 2.0 * np.pi * np.concatenate([[0.0], turns])
