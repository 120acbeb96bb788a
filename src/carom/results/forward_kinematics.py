"""Forward kinematics: the motion of the child of a joint, from that of the parent and the coordinates."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.scene.bodies import Body
from carom.scene.joints import Joint, JointDefinition, Universal

UNIT = np.array([1.0, 0.0, 0.0, 0.0])


class Motion(NamedTuple):
    """Position, orientation, velocity and angular velocity (N, ...) of all bodies, and the turns of joints."""

    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    turns: np.ndarray | None


class Side(NamedTuple):
    """A side of a joint: a vector e of its definition is turn e turn* in its body, the anchor at `anchor`."""

    body: int  # -1 for the ground
    turn: np.ndarray
    anchor: np.ndarray


class Sides(NamedTuple):
    """A joint of a scene, prepared."""

    definition: JointDefinition
    parent: Side
    child: Side
    axes: list[np.ndarray]  # of its coordinates, in the definition


def sides_of(joint: Joint) -> Sides:
    """Return a prepared joint. It is defined in the world at the start, or in frames of both bodies."""
    d, frames = joint.definition, (None, None) if joint.frames is None else joint.frames
    axes = [d.coordinate_frame(k)[:, 0] for k in range(len(d.coordinates))]
    if isinstance(d, Universal):
        axes = [d.axis_parent, d.axis_child]
    bodies, anchor = (joint.parent, joint.child), joint.anchor()
    parent, child = (_side(body, frame, anchor) for body, frame in zip(bodies, frames))
    return Sides(d, parent, child, axes)


def _side(body, frame, point: np.ndarray) -> Side:
    if frame is not None:
        offset, turn = frame
    elif body.index < 0:
        offset, turn = np.zeros(3), UNIT
    else:
        turn = quaternion.conjugate(body.orientation)
        offset = -quaternion.rotate(turn, body.position)
    return Side(body.index, turn, quaternion.rotate(turn, point) + offset)


def relative(joint: Joint, states) -> np.ndarray:
    """Return C0* P0 P* C for the orientations P of the parent and C of the child: 1 at the start."""
    child = states.orientation[..., joint.child.index, :]
    start = quaternion.conjugate(joint.child.orientation)
    turned = np.broadcast_to(start, child.shape)
    if isinstance(joint.parent, Body):
        turned = quaternion.multiply(turned, np.broadcast_to(joint.parent.orientation, child.shape))
        back = quaternion.conjugate(states.orientation[..., joint.parent.index, :])
        turned = quaternion.multiply(turned, back)
    return quaternion.multiply(turned, child)


def put_ball(joint: Joint, turned: np.ndarray, rates: np.ndarray, moved: Motion) -> None:
    """Write the motion of the child of a ball joint: C = P P0* C0 turned, and its rate in its own axes."""
    P, w = UNIT, np.zeros(3)
    if isinstance(joint.parent, Body):
        P = quaternion.multiply(
            moved.orientation[joint.parent.index], quaternion.conjugate(joint.parent.orientation)
        )
        w = moved.angular_velocity[joint.parent.index]
    C = quaternion.multiply(quaternion.multiply(P, joint.child.orientation), turned)
    _hang(sides_of(joint), C, w + quaternion.rotate(C, rates), np.zeros(3), np.zeros(3), moved)


def put_child(joint: Sides, q: np.ndarray, rates: np.ndarray, moved: Motion) -> None:
    """Write the motion of the child of a joint with coordinates q."""
    P, w = UNIT, np.zeros(3)
    if joint.parent.body >= 0:
        P = moved.orientation[joint.parent.body]
        w = moved.angular_velocity[joint.parent.body]
    P = quaternion.multiply(P, joint.parent.turn)
    turned, spin, shift, speed = UNIT, w.copy(), np.zeros(3), np.zeros(3)
    for axis, kind, own, rate in zip(joint.axes, joint.definition.coordinates, q, rates):
        along = quaternion.rotate(quaternion.multiply(P, turned), axis)
        if kind == "turn":
            spin += rate * along
            turned = quaternion.multiply(turned, quaternion.exp(own * axis))
        else:  # slides come before a turn about another axis, or go along that of the turn
            shift += own * along
            speed += rate * along
    C = quaternion.multiply(quaternion.multiply(P, turned), quaternion.conjugate(joint.child.turn))
    _hang(joint, C, spin, shift, speed + np.cross(w, shift), moved)


def _hang(joint: Sides, C, spin, shift, speed, moved: Motion) -> None:
    """Write the motion of a child with this orientation, whose anchor is shifted from that of the parent."""
    c, p, at, v = joint.child.body, joint.parent.body, joint.parent.anchor, np.zeros(3)
    if p >= 0:
        arm = quaternion.rotate(moved.orientation[p], at)
        at = moved.position[p] + arm
        v = moved.velocity[p] + np.cross(moved.angular_velocity[p], arm)
    arm = quaternion.rotate(C, joint.child.anchor)
    moved.orientation[c], moved.angular_velocity[c] = C, spin
    moved.position[c] = at + shift - arm
    moved.velocity[c] = v + speed - np.cross(spin, arm)
