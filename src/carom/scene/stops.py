"""Stops: limits of joint coordinates, with impacts and restitution."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from carom import arguments, checks, fields
from carom.fields import NumberOrNone, Value, Word, keep
from carom.scene.coordinates import (
    Combination,
    Factors,
    Length,
    acts_along,
    joint_or_combination,
    kind_of,
    with_joints,
)
from carom.scene.joints import Joint
from carom.scene.materials import IMPACT_LAWS
from carom.scene.restitution import Restitution
from carom.scene.restitution import restitution as number_or_law
from carom.scene.stiffness import Stiffness
from carom.scene.values import MethodsOfScene, PartOfScene, in_scene


def _index_or_word(name: str, value) -> int | str:
    return value if isinstance(value, str) else checks.integer(name, value, least=0)


def _spring_or_none(name: str, value) -> Stiffness | None:
    return None if value is None else checks.instance(name, value, (Stiffness,))


def _check_coordinate(joint: Joint | Combination | Length, coordinate: int | str) -> None:
    """Refuse a coordinate that the joint does not have."""
    if isinstance(joint, (Combination, Length)):
        acts_along(joint, checks.integer("coordinate", coordinate, least=0))
        return
    limits = joint.definition.limits
    if isinstance(coordinate, str) or limits:
        if coordinate not in limits:
            words = " or ".join(f'"{word}"' for word in limits) or "the index of one of the joint"
            raise ValueError(f"coordinate must be {words}, got {checks.shown(coordinate)}")
        return
    acts_along(joint, coordinate)


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class Stop(PartOfScene):
    """A limit of a joint coordinate: a unilateral constraint. `Scene.add_stop` makes it.

    Attributes
    ----------
    joint : Joint, Combination or Length
        A joint, a sum of joint coordinates times factors, or the distance that a tether limits.
    coordinate : int or str
        Index of the coordinate of the joint, or the word for an angle of a ball joint.
    lower, upper : float or None
        Limit of the coordinate [rad or m], one of the two; the coordinate is 0 at the start.
    restitution : float or Restitution
        The speed of a law is that of the coordinate [rad/s or m/s].
    impact_law : str
    stiffness : Stiffness or None
        From which `Solution.impacts` has force, or torque, and duration; the motion does not depend on it.
    """

    joint: Joint | Combination | Length
    coordinate: Value[Any, Any] = Value(_index_or_word)
    lower: NumberOrNone = fields.number(None)
    upper: NumberOrNone = fields.number(None)
    restitution: Value[Any, Any] = number_or_law(0.0)
    impact_law: Word = fields.word(IMPACT_LAWS, "newton")
    stiffness: Value[Any, Any] = Value(_spring_or_none, None)

    def __post_init__(self):
        _check_coordinate(self.joint, self.coordinate)
        if (self.lower is None) == (self.upper is None):
            raise ValueError(
                "lower or upper must be given, and not both (add two stops for two ends), got "
                f"{self.lower} and {self.upper}"
            )

        if self.coordinate in ("rotation", "swing"):
            checks.number("upper", self.upper, above=0.0, below=math.pi, unit="rad")

    @property
    def turns(self) -> bool:
        """Whether it limits an angle."""
        return kind_of(self.joint, self.coordinate) == "turn"

    @property
    def side(self) -> float:
        """1 for a lower limit, -1 for an upper limit: gap = side (q - end)."""
        return 1.0 if self.upper is None else -1.0

    @property
    def end(self) -> float:
        """The limit of the coordinate [rad or m]: `lower` or `upper`."""
        return self.lower if self.upper is None else self.upper  # pyright: ignore[reportReturnType]

    @property
    def friction(self) -> Any:
        """Friction of its face: that of a pin in its bush, else none."""
        return getattr(self.joint, "friction", 0.0)

    @property
    def tangential_restitution(self) -> float:
        """None."""
        return 0.0

    def __repr__(self) -> str:
        which = "upper" if self.lower is None else "lower"
        where = f"{which}={self.end:g}, restitution={self.restitution:g}"
        return f"Stop({self.name!r}, {self.joint.name!r}, {where})"


class RailContact(Stop):
    """The contact of a point with a rail that can be left, which the joint states."""

    def __init__(self, index: int, joint: Joint):
        d: Any = joint.definition
        keep(self, index=index, name=f"{joint.child.name}-{joint.name}", joint=joint, coordinate=0)
        keep(self, lower=0.0, upper=None, restitution=d.restitution)
        keep(self, impact_law=d.impact_law, stiffness=None)

    @property
    def friction(self) -> Any:
        """Friction of the rail."""
        return self.joint.definition.friction  # pyright: ignore[reportAttributeAccessIssue]

    def __repr__(self) -> str:
        return f"RailContact({self.name!r}, restitution={self.restitution:g})"


class SceneStops(MethodsOfScene):
    """The methods of `Scene` for stops."""

    @arguments.known
    def add_stop(
        self,
        joint: Joint | str | Factors,
        *,
        lower: float | None = None,
        upper: float | None = None,
        restitution: float | Restitution = 0.0,
        impact_law: str = "newton",
        stiffness: Stiffness | None = None,
        coordinate: int | str = 0,
        name: str | None = None,
        replace: bool = False,
    ) -> Stop:
        """Add a stop: a limit of a joint coordinate, with impacts and restitution.

        A stop is a unilateral constraint on a coordinate of the joint. Its impacts pass the same boundary layer
        as those of contacts, and their impulses act on the whole mechanism. In `Solution.impacts` the `contact`
        of a stop is the number of contacts of bodies plus the index of the stop. Its impulse has only a normal
        component; for an angle, impulses are in [N m s] and speeds in [rad/s].

        Parameters
        ----------
        joint
            A joint of the scene that has coordinates, or its name; or a mapping from joints to factors, which
            states a sum of their coordinates: ``{"first": 1.0, ("second", 1): 2.5}`` (see `add_play`).
        lower, upper
            Exactly one of the two: the lower or the upper limit of the coordinate [rad or m]. The coordinate is
            0 at the start. For two limits add two stops.
        restitution
            Coefficient of restitution, from 0 (default) to 1, or its law: a function of the speed of the
            coordinate [rad/s or m/s].
        impact_law
            ``"newton"`` (default), ``"poisson"``, ``"stronge"`` or ``"moreau"``. A stop has no friction, so the
            laws differ only in multiple impacts.
        stiffness
            ``carom.Stiffness(k, exponent)`` of the stop [N/m^exponent], of an angle [N m/rad^exponent]. Then
            `Solution.impacts` has the greatest force, or torque, and the duration of its impacts; the motion
            stays as it is. Default None.
        coordinate
            Index of the coordinate of the joint. Default 0. Of a ball joint (`carom.joints.Spherical`) one of
            ``"rotation"``, ``"swing"`` (a cone) and ``"twist"``. Rotation and swing have upper limits, from 0
            to pi. The twist has no value where the swing is pi, so it needs a limit of the swing.
        name
            Name in the scene. Default ``"stop1"``, ``"stop2"``, ...
        """
        of = self._joint_or_combination(joint)
        return self._parts.make(
            Stop, "stop", name, replace, joint=of, coordinate=coordinate, lower=lower, upper=upper,
            restitution=restitution, impact_law=impact_law, stiffness=stiffness,
        )  # fmt: skip

    def _joint_or_combination(self, joint) -> Joint | Combination:
        given = joint_or_combination("joint", joint)
        if isinstance(given, Combination):
            return with_joints(given, self._parts.member, "each joint")
        return self._parts.member("joint", given, (Joint,))

    @property
    def stops(self) -> tuple[Stop, ...]:
        """Stops of joints, in the order in which they were added, then contacts of rails that can be left."""
        added = self._parts.parts(Stop)
        rails = (joint for joint in self._parts.parts(Joint) if joint.can_be_left)
        return (*added, *(RailContact(k, joint) for k, joint in enumerate(rails, len(added))))
