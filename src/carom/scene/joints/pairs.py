"""Joints that keep a point on a point, line or plane, and allow all rotations, one axis, or none."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments
from carom.checks import unit_vector
from carom.scene.joints.definition import JointDefinition
from carom.scene.values import keep, optional_point, point


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Revolute(JointDefinition):
    """A hinge: the bodies have the point `anchor` (3,) in common and rotate only about `axis` (3,)."""

    guide, turn = "point", "axis"
    coordinates = ("turn",)

    anchor: np.ndarray
    axis: np.ndarray

    def __init__(self, anchor: ArrayLike, axis: ArrayLike):
        keep(self, anchor=point("anchor", anchor), axis=unit_vector("axis", axis))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Spherical(JointDefinition):
    """A ball joint: the bodies have the point `anchor` (3,) in common and rotate freely about it."""

    guide, turn = "point", "ball"

    anchor: np.ndarray

    def __init__(self, anchor: ArrayLike):
        keep(self, anchor=point("anchor", anchor))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Fixed(JointDefinition):
    """A weld: no relative motion. Reactions are reported at `anchor` (3,)."""

    guide, turn = "point", "rigid"

    anchor: np.ndarray | None

    def __init__(self, anchor: ArrayLike | None = None):
        keep(self, anchor=optional_point("anchor", anchor))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Prismatic(JointDefinition):
    """A slider: the child moves along `axis` (3,), which is fixed in the parent, without rotation."""

    guide, turn = "line", "rigid"
    coordinates = ("slide",)

    axis: np.ndarray
    anchor: np.ndarray | None

    def __init__(self, axis: ArrayLike, anchor: ArrayLike | None = None):
        keep(self, axis=unit_vector("axis", axis), anchor=optional_point("anchor", anchor))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Cylindrical(JointDefinition):
    """A sleeve: the child rotates about, and slides along, the line through `anchor` (3,) along `axis` (3,)."""

    guide, turn = "line", "axis"
    coordinates = ("turn", "slide")

    anchor: np.ndarray
    axis: np.ndarray

    def __init__(self, anchor: ArrayLike, axis: ArrayLike):
        keep(self, anchor=point("anchor", anchor), axis=unit_vector("axis", axis))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Planar(JointDefinition):
    """A plate on a table: the child slides perpendicular to `normal` (3,) and rotates about it.

    The normal is fixed in both bodies.
    """

    guide, turn = "plane", "axis"
    coordinates = ("slide", "slide", "turn")

    normal: np.ndarray
    anchor: np.ndarray | None

    def __init__(self, normal: ArrayLike, anchor: ArrayLike | None = None):
        keep(self, normal=unit_vector("normal", normal), anchor=optional_point("anchor", anchor))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class PointOnLine(JointDefinition):
    """A bead on a wire: the point `anchor` (3,) of the child stays on a line of the parent.

    The line passes through `anchor` along `direction` (3,); the child rotates freely.
    """

    guide, turn = "line", "ball"
    coordinates = ("slide",)

    anchor: np.ndarray
    direction: np.ndarray

    def __init__(self, anchor: ArrayLike, direction: ArrayLike):
        keep(self, anchor=point("anchor", anchor), direction=unit_vector("direction", direction))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class PointOnPlane(JointDefinition):
    """A pin in a slot between two plates: the point `anchor` (3,) of the child stays in a plane of the parent.

    The plane passes through `anchor` perpendicular to `normal` (3,). The point cannot leave it on either side;
    the child rotates freely.
    """

    guide, turn = "plane", "ball"
    coordinates = ("slide", "slide")

    anchor: np.ndarray
    normal: np.ndarray

    def __init__(self, anchor: ArrayLike, normal: ArrayLike):
        keep(self, anchor=point("anchor", anchor), normal=unit_vector("normal", normal))
