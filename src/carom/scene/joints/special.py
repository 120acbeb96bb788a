"""Joints with equations of their own: `Distance`, `Universal` and `Screw`."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from carom import arguments, fields
from carom.checks import number, unit_vector
from carom.fields import NumberOrNone, Value, Vector, Word, keep
from carom.scene.joints.definition import JointDefinition
from carom.scene.materials import IMPACT_LAWS
from carom.scene.restitution import restitution
from carom.scene.values import apart, shown

ACROSS = 1e-9  # cosine of an angle below which directions count as perpendicular


@arguments.known
@dataclass(frozen=True, eq=False)
class Distance(JointDefinition):
    """A massless rod between a point of the parent and one of the child, each (3,).

    Its `length` [m] is the distance of the two points at the start, which must not be 0. With limits it is a
    telescope, which pushes at its lower and pulls at its upper end and leaves both bodies free between: then
    `Scene.add_joint` makes stops, with located impacts and persistent contact, in the place of a joint.

    Parameters
    ----------
    anchor_parent, anchor_child : (3,)
        The points, in the world at the start [m].
    lower, upper : float, optional
        Least and greatest distance of the points [m], at least 0; `lower` below `upper`. Default: the rod is
        rigid.
    restitution : float or Restitution
        Of the impacts at the limits, from 0 (default) to 1, or its law: a function of the speed [m/s].
    impact_law : str
        As for `Scene.add_stop`.
    """

    guide, turn = "own", "own"
    rows, in_trees, measured = 1, False, ("slide",)

    anchor_parent: Vector = fields.vector()
    anchor_child: Vector = fields.vector()
    lower: NumberOrNone = fields.number(None, least=0.0)
    upper: NumberOrNone = fields.number(None, above=0.0)
    restitution: Value[Any, Any] = restitution(0.0)
    impact_law: Word = fields.word(IMPACT_LAWS, "newton")
    length: float = field(init=False)  #: distance of the two points at the start [m]

    def __post_init__(self):
        keep(self, length=apart(self, "; for a shared point use Spherical"))
        low, high = self.lower, self.upper
        if low is not None and high is not None and not low < high:
            raise ValueError(f"lower must be below upper, got {low:g} and {high:g}")

    @property
    def limits_of_length(self) -> dict[str, float]:
        """Its limits by their names; empty if it is rigid."""
        pairs = {"lower": self.lower, "upper": self.upper}
        return {name: end for name, end in pairs.items() if end is not None}

    def anchors(self, anchor, child) -> tuple[np.ndarray, np.ndarray]:
        """Return both ends of the rod."""
        return self.anchor_parent, self.anchor_child

    def scale(self) -> float:
        """Return the length of the rod [m]."""
        return self.length


@arguments.known
@dataclass(frozen=True, eq=False)
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

    anchor: Vector = fields.vector()
    axis_parent: Vector = fields.direction()
    axis_child: Vector = fields.direction()

    def __post_init__(self):
        first, second = self.axis_parent, self.axis_child
        cosine = float(first @ second)
        if not abs(cosine) < ACROSS:
            raise ValueError(
                f"axis_child must be perpendicular to axis_parent, got {shown(second)} and "
                f"{shown(first)}, with an angle of {np.degrees(np.arccos(cosine)):.6g} degrees"
            )
        keep(self, axis_child=unit_vector("axis_child", second - cosine * first))

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


def _pitch(name: str, value) -> float:
    pitch = number(name, value, unit="m")
    if pitch == 0.0:
        raise ValueError(f"{name} must not be 0, got {pitch!r}; for no slide use Revolute")
    return pitch


@arguments.known
@dataclass(frozen=True, eq=False)
class Screw(JointDefinition):
    """A nut on a thread: the child rotates about a line and slides along it, in proportion.

    Parameters
    ----------
    anchor, axis : (3,)
        A point of the line and its direction, in the world at the start.
    pitch : float
        Displacement of the child along `axis` in one turn about it by the right-hand rule [m]. Negative for a
        left-hand thread, not 0.
    """

    guide, turn = "line", "axis"
    coordinates = ("turn", "slide")
    rows = 5

    anchor: Vector = fields.vector()
    axis: Vector = fields.direction()
    pitch: Value[float, float] = Value(_pitch)

    def scale(self) -> float:
        """Return the displacement along the axis for a rotation by 1 rad [m]."""
        return self.pitch / (2.0 * np.pi)
