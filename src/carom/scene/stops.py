"""Stops: limits of joint coordinates, with impacts and restitution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from carom import fields
from carom.fields import Integer, NumberOrNone, Value, Word, keep
from carom.scene.constraints import acts_along
from carom.scene.joints import Joint
from carom.scene.materials import IMPACT_LAWS
from carom.scene.restitution import restitution as number_or_law
from carom.scene.values import in_scene


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
    coordinate : int
        Index of the coordinate of the joint.
    lower, upper : float or None
        Limit of the coordinate [rad or m], one of the two; the coordinate is 0 at the start.
    restitution : float or Restitution
        The speed of a law is that of the coordinate [rad/s or m/s].
    impact_law : str
    """

    index: int
    name: str
    joint: Joint
    coordinate: Integer = fields.integer(least=0)
    lower: NumberOrNone = fields.number(None)
    upper: NumberOrNone = fields.number(None)
    restitution: Value[Any, Any] = number_or_law(0.0)
    impact_law: Word = fields.word(IMPACT_LAWS, "newton")

    def __post_init__(self):
        acts_along(self.joint, self.coordinate)
        if (self.lower is None) == (self.upper is None):
            raise ValueError(
                "lower or upper must be given, and not both (add two stops for two ends), got "
                f"{self.lower} and {self.upper}"
            )

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
