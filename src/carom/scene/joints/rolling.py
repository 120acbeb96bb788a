"""Nonholonomic joints: a blade, a rolling sphere and a rolling disc."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, fields
from carom.checks import finite_array, unit_vector
from carom.fields import Number, Vector, keep
from carom.scene.joints.definition import JointDefinition
from carom.scene.values import shown

PARALLEL = 1e-9  # sine of the angle between two directions below which they count as parallel


@arguments.known
@dataclass(frozen=True, eq=False)
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

    anchor: Vector = fields.vector()
    direction: Vector = fields.direction()
    normal: Vector = fields.direction((0, 0, 1))
    lateral: np.ndarray = field(init=False)

    def __post_init__(self):
        across = np.cross(self.normal, self.direction)
        if not np.linalg.norm(across) > PARALLEL:
            raise ValueError(
                f"direction must not be parallel to normal, got {shown(self.direction)} and "
                f"{shown(self.normal)}"
            )
        keep(self, lateral=unit_vector("lateral", across))

    def frame(self, flipped: bool = False) -> np.ndarray:
        """Return axes as columns: along the blade, lateral, and the normal."""
        along = np.cross(self.lateral, self.normal)
        return np.stack([along, self.lateral, self.normal], axis=1)


@arguments.known
@dataclass(frozen=True, eq=False)
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

    radius: Number = fields.number(above=0.0, unit="m")
    normal: Vector = fields.direction((0, 0, 1))

    def contact(self, centre: ArrayLike) -> np.ndarray:
        """Return the contact point (3,) for a centre at `centre`."""
        return finite_array("centre", centre, (3,)) - self.radius * self.normal

    def anchors(self, anchor, child) -> tuple[np.ndarray, np.ndarray]:
        """Return the contact point on the plane, and the centre."""
        return self.contact(child), child

    def scale(self) -> float:
        """Return the radius [m]."""
        return self.radius


@arguments.known
@dataclass(frozen=True, eq=False)
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

    radius: Number = fields.number(above=0.0, unit="m")
    axis: Vector = fields.direction()
    normal: Vector = fields.direction((0, 0, 1))

    def __post_init__(self):
        if not np.linalg.norm(np.cross(self.axis, self.normal)) > PARALLEL:
            raise ValueError(
                "axis must not be parallel to normal (a disc that lies flat has no lowest point), got "
                f"{shown(self.axis)} and {shown(self.normal)}"
            )

    def contact(self, centre: ArrayLike) -> np.ndarray:
        """Return the contact point (3,) for a centre at `centre`."""
        down = self.normal - (self.normal @ self.axis) * self.axis
        return finite_array("centre", centre, (3,)) - self.radius * down / np.linalg.norm(down)

    def frame(self, flipped: bool = False) -> np.ndarray:
        """Return axes as columns: the normal of the plane, the axis of the disc, and their cross product."""
        return np.stack([self.normal, self.axis, np.cross(self.normal, self.axis)], axis=1)

    def anchors(self, anchor, child) -> tuple[np.ndarray, np.ndarray]:
        """Return the contact point on the plane, and the centre."""
        return self.contact(child), child

    def scale(self) -> float:
        """Return the radius [m]."""
        return self.radius
