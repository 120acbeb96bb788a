"""Stops: limits of joint coordinates, with impacts and restitution."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from carom import checks, fields
from carom.fields import NumberOrNone, Value, Word, keep
from carom.scene.constraints import acts_along, coordinate_kind
from carom.scene.joints import Joint
from carom.scene.materials import IMPACT_LAWS
from carom.scene.restitution import restitution as number_or_law
from carom.scene.values import in_scene


def _index_or_word(name: str, value) -> int | str:
    return value if isinstance(value, str) else checks.integer(name, value, least=0)


def _check_coordinate(joint: Joint, coordinate: int | str) -> None:
    """Refuse a coordinate that the joint does not have."""
    limits = joint.definition.limits
    if isinstance(coordinate, str) or limits:
        if coordinate not in limits:
            words = " or ".join(f'"{word}"' for word in limits) or "the index of one of the joint"
            raise ValueError(f"coordinate must be {words}, got {checks.shown(coordinate)}")
        return
    acts_along(joint, coordinate)


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class Stop:
    """A limit of a joint coordinate: a unilateral constraint. `Scene.add_stop` makes it.

    Attributes
    ----------
    index : int
        Its index in `Scene.stops`.
    name : str
    joint : Joint
    coordinate : int or str
        Index of the coordinate of the joint, or the word for an angle of a ball joint.
    lower, upper : float or None
        Limit of the coordinate [rad or m], one of the two; the coordinate is 0 at the start.
    restitution : float or Restitution
        The speed of a law is that of the coordinate [rad/s or m/s].
    impact_law : str
    """

    index: int
    name: str
    joint: Joint
    coordinate: Value[Any, Any] = Value(_index_or_word)
    lower: NumberOrNone = fields.number(None)
    upper: NumberOrNone = fields.number(None)
    restitution: Value[Any, Any] = number_or_law(0.0)
    impact_law: Word = fields.word(IMPACT_LAWS, "newton")

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
        k = self.coordinate
        return isinstance(k, str) or coordinate_kind(self.joint, k) == "turn"

    @property
    def side(self) -> float:
        """1 for a lower limit, -1 for an upper limit: gap = side (q - end)."""
        return 1.0 if self.upper is None else -1.0

    @property
    def end(self) -> float:
        """The limit of the coordinate [rad or m]: `lower` or `upper`."""
        return self.lower if self.upper is None else self.upper  # pyright: ignore[reportReturnType]

    def __repr__(self) -> str:
        which = "upper" if self.lower is None else "lower"
        where = f"{which}={self.end:g}, restitution={self.restitution:g}"
        return f"Stop({self.name!r}, {self.joint.name!r}, {where})"


class RailContact(Stop):
    """The contact of a point with a rail that can be left, which the joint states."""

    def __init__(self, index: int, joint: Joint):
        d: Any = joint.definition
        keep(self, index=index, name=f"{joint.child.name}-{joint.name}", joint=joint, coordinate=0)
        keep(self, lower=0.0, upper=None, restitution=d.restitution, impact_law=d.impact_law)

    def __repr__(self) -> str:
        return f"RailContact({self.name!r}, restitution={self.restitution:g})"
