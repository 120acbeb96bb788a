"""The joint `Universal`: a Cardan joint."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments
from carom.checks import shown, unit_vector
from carom.scene.joints.definition import JointDefinition
from carom.scene.values import keep, point

ACROSS = 1e-9  # cosine of an angle below which directions count as perpendicular


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Universal(JointDefinition):
    """A Cardan joint: a common point, and two axes that stay perpendicular, one fixed in each body.

    Parameters
    ----------
    anchor : (3,)
        The common point, in the world at the start [m].
    axis_parent, axis_child : (3,)
        The two axes of the cross, fixed in the parent and in the child. They are perpendicular at the start
        (the cosine of their angle is below 1e-9).
    """

    guide, turn = "point", "cross"
    coordinates = ("turn", "turn")

    anchor: np.ndarray
    axis_parent: np.ndarray
    axis_child: np.ndarray

    def __init__(self, anchor: ArrayLike, axis_parent: ArrayLike, axis_child: ArrayLike):
        first = unit_vector("axis_parent", axis_parent)
        second = unit_vector("axis_child", axis_child)
        cosine = float(first @ second)
        if not abs(cosine) < ACROSS:
            raise ValueError(
                f"axis_child must be perpendicular to axis_parent, got {shown(axis_child)} and "
                f"{shown(axis_parent)}, with an angle of {np.degrees(np.arccos(cosine)):.6g} degrees"
            )
        second = unit_vector("axis_child", second - cosine * first)
        keep(self, anchor=point("anchor", anchor), axis_parent=first, axis_child=second)

    def frame(self, flipped: bool = False) -> np.ndarray:
        """Return axes as columns: that of the body nearer to the root of the tree, the other, their normal."""
        first, second = self.axis_parent, self.axis_child
        if flipped:
            first, second = second, first
        return np.stack([first, second, np.cross(first, second)], axis=1)

    def coordinate_frame(self, coordinate: int) -> np.ndarray:
        """Return the axes of a coordinate; the second coordinate is measured from the child."""
        a, b = self.axis_parent, self.axis_child
        columns = (a, b, np.cross(a, b)) if coordinate == 0 else (-b, a, np.cross(a, b))
        return np.stack(columns, axis=1)
