"""Nonholonomic joints: a blade, a rolling sphere and a rolling disc."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments
from carom.checks import number, shown, unit_vector
from carom.scene.joints.definition import JointDefinition
from carom.scene.values import keep, point

PARALLEL = 1e-9  # sine of the angle between two directions below which they count as parallel


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class KnifeEdge(JointDefinition):
    """A blade (nonholonomic): a point of the child cannot move sideways over the ground.

    Parameters
    ----------
    anchor : (3,)
        The point of the child, in the world at the start [m].
    direction : (3,)
        Direction of the blade, in the world at the start; it turns with the child.
    normal : (3,), default (0, 0, 1)
        Normal of the surface, in the world at the start; it turns with the child. Not parallel to `direction`.

    Attributes
    ----------
    lateral : (3,)
        Unit vector along ``normal x direction``: the point has no velocity in this direction.
    """

    guide, turn = "own", "own"
    rows, nonholonomic, in_trees = 1, 1, False

    anchor: np.ndarray
    direction: np.ndarray
    normal: np.ndarray
    lateral: np.ndarray

    def __init__(self, anchor: ArrayLike, direction: ArrayLike, normal: ArrayLike = (0, 0, 1)):
        along, up = unit_vector("direction", direction), unit_vector("normal", normal)
        across = np.cross(up, along)
        if not np.linalg.norm(across) > PARALLEL:
            raise ValueError(
                f"direction must not be parallel to normal, got {shown(direction)} and {shown(normal)}"
            )
        keep(self, anchor=point("anchor", anchor), direction=along, normal=up)
        keep(self, lateral=unit_vector("lateral", across))

    def frame(self, flipped: bool = False) -> np.ndarray:
        """Return axes as columns: along the blade, lateral, and the normal."""
        along = np.cross(self.lateral, self.normal)
        return np.stack([along, self.lateral, self.normal], axis=1)


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class RollingSphere(JointDefinition):
    """A ball that rolls without slip on a plane of the parent and cannot leave it (nonholonomic).

    Parameters
    ----------
    radius : float
        Radius [m], above 0. The centre of the ball is the mass centre of the child.
    normal : (3,), default (0, 0, 1)
        Normal of the plane, towards the ball; it turns with the parent. The plane touches the ball at the
        start.
    """

    guide, turn = "own", "ball"
    rows, nonholonomic = 3, 2

    radius: float
    normal: np.ndarray

    def __init__(self, radius: float, normal: ArrayLike = (0, 0, 1)):
        radius = number("radius", radius, above=0.0, unit="m")
        keep(self, radius=radius, normal=unit_vector("normal", normal))

    def contact(self, centre: ArrayLike) -> np.ndarray:
        """Return the contact point (3,) for a centre at `centre`."""
        return point("centre", centre) - self.radius * self.normal

    def anchors(self, anchor, child) -> tuple[np.ndarray, np.ndarray]:
        """Return the contact point on the plane, and the centre."""
        return self.contact(child), child

    def scale(self) -> float:
        """Return the radius [m]."""
        return self.radius


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class RollingDisc(JointDefinition):
    """A thin disc or wheel that rolls on a plane of the parent without slip (nonholonomic).

    Its lowest point has no velocity relative to the plane; the disc may lean, steer and roll. To model the
    wheel of a vehicle, add a `Revolute` between the wheel and the frame.

    Parameters
    ----------
    radius : float
        Radius [m], above 0. The centre of the disc is the mass centre of the child.
    axis : (3,)
        Axis of the disc, in the world at the start; it turns with the child. Not parallel to `normal`.
    normal : (3,), default (0, 0, 1)
        Normal of the plane, towards the disc; it turns with the parent. The plane touches the disc at the
        start.
    """

    guide, turn = "own", "ball"
    rows, nonholonomic = 3, 2

    radius: float
    axis: np.ndarray
    normal: np.ndarray

    def __init__(self, radius: float, axis: ArrayLike, normal: ArrayLike = (0, 0, 1)):
        radius = number("radius", radius, above=0.0, unit="m")
        along, up = unit_vector("axis", axis), unit_vector("normal", normal)
        if not np.linalg.norm(np.cross(along, up)) > PARALLEL:
            raise ValueError(
                f"axis must not be parallel to normal (a disc that lies flat has no lowest point), got "
                f"{shown(axis)} and {shown(normal)}"
            )
        keep(self, radius=radius, axis=along, normal=up)

    def contact(self, centre: ArrayLike) -> np.ndarray:
        """Return the contact point (3,) for a centre at `centre`."""
        down = self.normal - (self.normal @ self.axis) * self.axis
        return point("centre", centre) - self.radius * down / np.linalg.norm(down)

    def frame(self, flipped: bool = False) -> np.ndarray:
        """Return axes as columns: the normal of the plane, the axis of the disc, and their cross product."""
        return np.stack([self.normal, self.axis, np.cross(self.normal, self.axis)], axis=1)

    def anchors(self, anchor, child) -> tuple[np.ndarray, np.ndarray]:
        """Return the contact point on the plane, and the centre."""
        return self.contact(child), child

    def scale(self) -> float:
        """Return the radius [m]."""
        return self.radius
