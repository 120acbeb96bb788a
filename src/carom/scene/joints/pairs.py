"""Joints that keep a point on a point, line or plane, and allow all rotations, one axis, or none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from carom import arguments, fields
from carom.fields import Value, Vector, VectorOrNone
from carom.geometry import quaternion
from carom.geometry.attitude import attitude
from carom.geometry.frames import triad
from carom.scene.joints.definition import JointDefinition


@arguments.known
@dataclass(frozen=True, eq=False)
class Revolute(JointDefinition):
    """A hinge: the bodies have the point `anchor` (3,) in common and rotate only about `axis` (3,)."""

    guide, turn = "point", "axis"
    coordinates = ("turn",)

    anchor: Vector = fields.vector()
    axis: Vector = fields.direction()


@arguments.known
@dataclass(frozen=True, eq=False)
class Spherical(JointDefinition):
    """A ball joint: the bodies have the point `anchor` (3,) in common and rotate freely about it.

    Stops (`Scene.add_stop`) limit three angles of it: the ``"rotation"`` of the child about any axis, from 0 to
    pi; the ``"swing"`` between the axis of the joint in the parent and in the child, from 0 to pi; and the
    ``"twist"`` about it, which remains after the shortest turn of the one axis to the other.

    Parameters
    ----------
    anchor : (3,)
    axis : (3,), optional
        Axis of swing and twist, fixed in the parent. Default z.
    start : orientation, optional
        Rotation of the child at the start from where its three angles are 0, in the axes of `anchor` and
        `axis`: a quaternion (w, x, y, z), a matrix (3, 3) or a Rotation of SciPy. Default: they are 0 at the
        start.
    """

    guide, turn = "point", "ball"
    measured = ("turn",) * 3
    limits: ClassVar = {"rotation": "turn", "swing": "turn", "twist": "turn"}

    anchor: Vector = fields.vector()
    axis: Vector = fields.direction((0.0, 0.0, 1.0))
    start: Value[np.ndarray, Any] = Value(attitude, (1.0, 0.0, 0.0, 0.0))

    def frame(self, flipped: bool = False) -> np.ndarray:
        """Return axes for the rows, which need none of the joint."""
        return np.eye(3)

    def frames_of_limits(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the axes (3, 3) of parent and child as columns, which agree where the angles are 0."""
        own = triad(self.axis)
        return own, quaternion.rotate(self.start, own.T).T


@arguments.known
@dataclass(frozen=True, eq=False)
class Fixed(JointDefinition):
    """A weld: no relative motion. Reactions are reported at `anchor` (3,)."""

    guide, turn = "point", "rigid"

    anchor: VectorOrNone = fields.vector(None)


@arguments.known
@dataclass(frozen=True, eq=False)
class Prismatic(JointDefinition):
    """A slider: the child moves along `axis` (3,), which is fixed in the parent, without rotation."""

    guide, turn = "line", "rigid"
    coordinates = ("slide",)

    axis: Vector = fields.direction()
    anchor: VectorOrNone = fields.vector(None)


@arguments.known
@dataclass(frozen=True, eq=False)
class Cylindrical(JointDefinition):
    """A sleeve: the child rotates about, and slides along, the line through `anchor` (3,) along `axis` (3,)."""

    guide, turn = "line", "axis"
    coordinates = ("turn", "slide")

    anchor: Vector = fields.vector()
    axis: Vector = fields.direction()


@arguments.known
@dataclass(frozen=True, eq=False)
class Planar(JointDefinition):
    """A plate on a table: the child slides perpendicular to `normal` (3,) and rotates about it.

    The normal is fixed in both bodies.
    """

    guide, turn = "plane", "axis"
    coordinates = ("slide", "slide", "turn")

    normal: Vector = fields.direction()
    anchor: VectorOrNone = fields.vector(None)


@arguments.known
@dataclass(frozen=True, eq=False)
class PointOnLine(JointDefinition):
    """A bead on a wire: the point `anchor` (3,) of the child stays on a line of the parent.

    The line passes through `anchor` along `direction` (3,); the child rotates freely.
    """

    guide, turn = "line", "ball"
    coordinates = ("slide",)

    anchor: Vector = fields.vector()
    direction: Vector = fields.direction()


@arguments.known
@dataclass(frozen=True, eq=False)
class PointOnPlane(JointDefinition):
    """A pin in a slot between two plates: the point `anchor` (3,) of the child stays in a plane of the parent.

    The plane passes through `anchor` perpendicular to `normal` (3,). The point cannot leave it on either side;
    the child rotates freely.
    """

    guide, turn = "plane", "ball"
    coordinates = ("slide", "slide")

    anchor: Vector = fields.vector()
    normal: Vector = fields.direction()
