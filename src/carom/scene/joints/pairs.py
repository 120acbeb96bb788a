"""Joints that guide a point along a point, line or plane, and turns freely, about an axis or not at all."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import unit_vector
from carom.scene.joints.definition import JointDefinition
from carom.scene.values import keep, optional_point, point


@dataclass(frozen=True, init=False, eq=False)
class Revolute(JointDefinition):
    """A hinge: the bodies share the point `anchor` (3,) and turn about `axis` (3,) alone."""

    guide, turn = "point", "axis"
    coordinates = ("turn",)

    anchor: np.ndarray
    axis: np.ndarray

    def __init__(self, anchor: ArrayLike, axis: ArrayLike):
        keep(self, anchor=point("anchor", anchor), axis=unit_vector("axis", axis))


@dataclass(frozen=True, init=False, eq=False)
class Spherical(JointDefinition):
    """A ball joint: the bodies share the point `anchor` (3,) and turn freely about it."""

    guide, turn = "point", "ball"

    anchor: np.ndarray

    def __init__(self, anchor: ArrayLike):
        keep(self, anchor=point("anchor", anchor))


@dataclass(frozen=True, init=False, eq=False)
class Fixed(JointDefinition):
    """A weld: no relative motion. Reactions are reported at `anchor` (3,)."""

    guide, turn = "point", "rigid"

    anchor: np.ndarray | None

    def __init__(self, anchor: ArrayLike | None = None):
        keep(self, anchor=optional_point("anchor", anchor))


@dataclass(frozen=True, init=False, eq=False)
class Prismatic(JointDefinition):
    """A slider: the child moves along `axis` (3,), fixed in the parent, without turning."""

    guide, turn = "line", "rigid"
    coordinates = ("slide",)

    axis: np.ndarray
    anchor: np.ndarray | None

    def __init__(self, axis: ArrayLike, anchor: ArrayLike | None = None):
        keep(self, axis=unit_vector("axis", axis), anchor=optional_point("anchor", anchor))


@dataclass(frozen=True, init=False, eq=False)
class Cylindrical(JointDefinition):
    """A sleeve: the child turns about and slides along the line through `anchor` (3,) along `axis` (3,)."""

    guide, turn = "line", "axis"
    coordinates = ("turn", "slide")

    anchor: np.ndarray
    axis: np.ndarray

    def __init__(self, anchor: ArrayLike, axis: ArrayLike):
        keep(self, anchor=point("anchor", anchor), axis=unit_vector("axis", axis))


@dataclass(frozen=True, init=False, eq=False)
class Planar(JointDefinition):
    """A plate on a table: the child slides across `normal` (3,), a direction of both, and turns about it."""

    guide, turn = "plane", "axis"
    coordinates = ("slide", "slide", "turn")

    normal: np.ndarray
    anchor: np.ndarray | None

    def __init__(self, normal: ArrayLike, anchor: ArrayLike | None = None):
        keep(self, normal=unit_vector("normal", normal), anchor=optional_point("anchor", anchor))


@dataclass(frozen=True, init=False, eq=False)
class PointOnLine(JointDefinition):
    """A bead on a wire: the point `anchor` (3,) of the child stays on a line of the parent.

    The line goes through `anchor` along `direction` (3,); the child turns freely.
    """

    guide, turn = "line", "ball"
    coordinates = ("slide",)

    anchor: np.ndarray
    direction: np.ndarray

    def __init__(self, anchor: ArrayLike, direction: ArrayLike):
        keep(self, anchor=point("anchor", anchor), direction=unit_vector("direction", direction))


@dataclass(frozen=True, init=False, eq=False)
class PointOnPlane(JointDefinition):
    """A pin in a slot between two plates: the point `anchor` (3,) of the child stays in a plane of the parent.

    The plane goes through `anchor` across `normal` (3,), on both sides; the child turns freely.
    """

    guide, turn = "plane", "ball"
    coordinates = ("slide", "slide")

    anchor: np.ndarray
    normal: np.ndarray

    def __init__(self, anchor: ArrayLike, normal: ArrayLike):
        keep(self, anchor=point("anchor", anchor), normal=unit_vector("normal", normal))
