"""World points and directions at the start, in axes of bodies; and the two sides of a joint."""

from __future__ import annotations

import numpy as np

from carom.geometry import quaternion


class Placement:
    """Points and axes of the scene in the principal axes of a body, or of the ground.

    Parameters
    ----------
    start : (N,) STATE
    to_principal : (N, 4)
        From principal axes to the scene's body axes.
    """

    def __init__(self, start: np.recarray, to_principal: np.ndarray):
        self.start, self.to_principal = start, to_principal

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
