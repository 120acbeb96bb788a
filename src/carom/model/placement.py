"""World points and directions at the start, in axes of bodies; and the two sides of a joint."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from carom.geometry import quaternion


class Placement:
    """Points and axes of the scene in the principal axes of a body, or of the ground.

    Parameters
    ----------
    start : (N,) STATE
    to_principal : (N, 4)
        From principal axes to the scene's body axes.
    placed : mapping
        How joints stand that switches have put in, by name (`pose_of_child`).
    """

    def __init__(self, start: np.recarray, to_principal: np.ndarray, placed: Mapping):
        self.start, self.to_principal, self.placed = start, to_principal, placed

    def point(self, body, point) -> np.ndarray:
        """Return a world point in the axes of a body, from its centre."""
        if body.index < 0:
            return np.array(point, dtype=float)
        q, x = self.start.Q[body.index], self.start.x[body.index]
        return quaternion.rotate_back(q, np.asarray(point) - x)

    def axes(self, body, world: np.ndarray) -> np.ndarray:
        """Return columns of `world` (3, 3) in the axes of a body."""
        if body.index < 0:
            return np.array(world, dtype=float)
        return quaternion.rotate_back(self.start.Q[body.index], world.T).T

    def side(self, joint, which: int) -> Side:
        """Return side 0 (parent) or 1 (child) of a joint of the scene."""
        frame = None if joint.frames is None else joint.frames[which]
        return Side(self, (joint.parent, joint.child)[which], frame)


class Side:
    """One side of a joint: it transforms the geometry of the definition to the axes of the body.

    A definition is given in the world at the start, or in a frame of the body: (position, orientation) in the
    scene's body axes.
    """

    def __init__(self, placement: Placement, body, frame):
        self.placement, self.body, self.frame = placement, body, frame

    def point(self, point) -> np.ndarray:
        """Return a point of the definition in the axes of the body."""
        if self.frame is None:
            return self.placement.point(self.body, point)
        position, orientation = self.frame
        return self._principal(position + quaternion.rotate(orientation, np.asarray(point)))

    def axes(self, columns: np.ndarray) -> np.ndarray:
        """Return columns (3, 3) of the definition in the axes of the body."""
        if self.frame is None:
            return self.placement.axes(self.body, columns)
        turned = quaternion.rotate(self.frame[1], columns.T)
        return np.stack([self._principal(e) for e in turned], axis=1)

    def _principal(self, vector):
        b = self.body.index
        if b < 0:
            return np.array(vector, dtype=float)
        return quaternion.rotate_back(self.placement.to_principal[b], vector)


def pose_of_child(joint, states: np.recarray) -> np.ndarray:
    """Return position and attitude (7,) of the child of a joint from its parent, of their principal axes."""
    child = states[joint.child.index]
    if joint.parent.index < 0:
        return np.append(child["x"], child["Q"])
    parent = states[joint.parent.index]
    away = quaternion.rotate_back(parent["Q"], child["x"] - parent["x"])
    return np.append(away, quaternion.multiply(quaternion.conjugate(parent["Q"]), child["Q"]))


def put_in(joint, pose: np.ndarray, row) -> None:
    """Let a joint, or a coordinate of it, take its child as it stands: its place in the parent stays.

    So both anchors are one point, and both frames one, from then on; a rod has the length between its anchors.

    Parameters
    ----------
    joint : the joint
    pose : (7,) of `pose_of_child`
    row : a record of JOINT or COORDINATE, whose parent may be the child of the joint
    """
    (far, near) = ("parent", "child") if row["child"] == joint.child.index else ("child", "parent")
    if row["length"] > 0.0 and joint.kind == "Distance":
        there = pose[:3] + quaternion.rotate(pose[3:], row[f"{near}_anchor"])
        row["length"] = np.linalg.norm(there - row[f"{far}_anchor"])
        return
    row[f"{near}_anchor"] = quaternion.rotate_back(pose[3:], row[f"{far}_anchor"] - pose[:3])
    row[f"{near}_frame"] = quaternion.rotate_back(pose[3:], row[f"{far}_frame"].T).T
    row["begin"] = 0.0
