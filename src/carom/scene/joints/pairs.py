"""Joints that keep a point on a point, line or plane, and allow all rotations, one axis, or none."""

from __future__ import annotations

from dataclasses import dataclass

from carom import arguments, fields
from carom.fields import Vector, VectorOrNone
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
    """A ball joint: the bodies have the point `anchor` (3,) in common and rotate freely about it."""

    guide, turn = "point", "ball"

    anchor: Vector = fields.vector()


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
