"""Coordinates of joints, from a finished run: what a joint leaves free, measured from parent to child."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom import check
from carom.geometry import quaternion
from carom.scene import joints as j
from carom.scene.joints import Joint
from carom.system.frames import triad


def joint_coordinates(solution, joint) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates and rates (T, n) of a joint; see `Solution.joint_coordinates`."""
    motion = Motion(
        solution.t, solution.position, solution.orientation, solution.velocity,
        solution.angular_velocity,
    )  # fmt: skip
    return coordinates_of(motion, _of_scene(solution.scene, joint))


class Motion(NamedTuple):
    """A motion at T times, orientations of the scene's body axes."""

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
    """Pairs (coordinate, rate) of joints with one direction that is fixed in the parent."""
    d = joint.definition
    if isinstance(d, (j.Fixed, j.KnifeEdge, j.RollingSphere, j.RollingDisc)):
        return []
    if isinstance(d, j.Revolute):
        return [sides.turn(d.axis)]
    anchor = joint.child.position if d.anchor is None else d.anchor
    if isinstance(d, (j.Planar, j.PointOnPlane)):
        slides = [sides.slide(anchor, e) for e in triad(d.normal).T[1:]]
        return [*slides, sides.turn(d.normal)] if isinstance(d, j.Planar) else slides
    along, speed = sides.slide(anchor, d.direction if isinstance(d, j.PointOnLine) else d.axis)
    if isinstance(d, j.Cylindrical):
        return [sides.turn(d.axis), (along, speed)]
    if isinstance(d, j.Screw):  # the slide knows all turns
        advance = d.pitch / (2.0 * np.pi)
        return [(along / advance, sides.turn(d.axis)[1]), (along, speed)]
    return [(along, speed)]


def _of_scene(scene, joint) -> Joint:
    if isinstance(joint, str):
        joint = scene[joint]
    check.instance("joint", joint, (Joint, str))
    if joint.index >= len(scene.joints) or scene.joints[joint.index] is not joint:
        raise ValueError(f"joint must belong to the scene of this solution, got {joint!r}")
    return joint


class _Sides:
    """Both bodies of a joint over the run, by what they did since the start: world axes."""

    def __init__(self, solution, joint):
        self.t = solution.t
        self.parent, self.child = (_motion(solution, b) for b in (joint.parent, joint.child))
        turned = [side[0] for side in (self.parent, self.child)]
        self.relative = quaternion.multiply(quaternion.conjugate(turned[0]), turned[1])
        self.spin = self.child[4] - self.parent[4]

    def across(self, start, end):
        """From a point of the parent to one of the child, given at the start: (T, 3) and its velocity."""
        (_, xp, _, vp, wp), (_, xc, _, vc, wc) = self.parent, self.child
        rp, rc = _arm(self.parent, start), _arm(self.child, end)
        return xc + rc - xp - rp, vc + np.cross(wc, rc) - vp - np.cross(wp, rp)

    def slide(self, anchor, direction):
        e = quaternion.rotate(self.parent[0], direction)
        gap, speed = self.across(anchor, anchor)
        # as seen from the parent, which turns: without w_p x gap
        speed = speed - np.cross(self.parent[4], gap)
        return np.sum(e * gap, axis=1), np.sum(e * speed, axis=1)

    def length(self, start, end):
        gap, speed = self.across(start, end)
        length = np.linalg.norm(gap, axis=1)
        return length, np.sum(gap * speed, axis=1) / length

    def turn(self, axis):
        q, e = self.relative, quaternion.rotate(self.parent[0], axis)
        rate = np.sum(e * self.spin, axis=1)
        return unwrapped(2.0 * np.arctan2(q[:, 1:] @ axis, q[:, 0]), rate, self.t), rate

    def cross(self, first, second):
        """Angles of Rot(first, q1) Rot(second, q2), the child's turn as seen from the parent."""
        frame = np.stack([first, second, np.cross(first, second)], axis=1)
        C = frame.T @ quaternion.matrix(self.relative) @ frame
        angles = np.arctan2(C[:, 2, 1], C[:, 1, 1]), np.arctan2(C[:, 0, 2], C[:, 0, 0])
        axes = quaternion.rotate(self.parent[0], first), quaternion.rotate(self.child[0], second)
        rates = [np.sum(e * self.spin, axis=1) for e in axes]
        return [(unwrapped(a, r, self.t), r) for a, r in zip(angles, rates)]

    def ball(self):
        rate = quaternion.rotate_back(self.parent[0], self.spin)
        return quaternion.log(self.relative), rate


def _motion(solution, body):
    """Turn since the start (T, 4), centre, centre at the start, velocity, angular velocity of a body."""
    k, zero = body.index, np.zeros((len(solution.t), 3))
    if k < 0:
        return np.tile([1.0, 0.0, 0.0, 0.0], (len(zero), 1)), zero, zero[0], zero, zero
    turned = quaternion.multiply(solution.orientation[:, k], quaternion.conjugate(body.orientation))
    x, v, w = solution.position, solution.velocity, solution.angular_velocity
    return turned, x[:, k], body.position, v[:, k], w[:, k]


def _arm(side, point):
    """Arm (T, 3) from the centre to a point of the body that was at `point` at the start."""
    return quaternion.rotate(side[0], point - side[2])


def unwrapped(angle: np.ndarray, rate: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Return angles (T,) with the whole turns that the mean rates between saved times ask for."""
    ahead = 0.5 * (rate[1:] + rate[:-1]) * np.diff(t) - np.diff(angle)
    turns = np.cumsum(np.round(ahead / (2.0 * np.pi)))
    return angle + 2.0 * np.pi * np.concatenate([[0.0], turns])
