"""Stops: limits of joint coordinates, with impacts and restitution."""

from __future__ import annotations

from dataclasses import dataclass

from carom import checks
from carom.scene.constraints import coordinate_kind
from carom.scene.joints import Joint
from carom.scene.materials import IMPACT_LAWS
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
    restitution : float
    impact_law : str
    """

    index: int
    name: str
    joint: Joint
    coordinate: int
    lower: float | None
    upper: float | None
    restitution: float
    impact_law: str

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


def make_stop(index, name, joint, lower, upper, restitution, impact_law, coordinate) -> Stop:
    """Return a checked `Stop`; the arguments are those of `Scene.add_stop`."""
    coordinate_kind(joint, coordinate)
    if (lower is None) == (upper is None):
        raise ValueError(
            "lower or upper must be given, and not both (add two stops for two ends), got "
            f"{checks.shown(lower)} and {checks.shown(upper)}"
        )
    lower = None if lower is None else checks.number("lower", lower)
    upper = None if upper is None else checks.number("upper", upper)
    restitution = checks.number("restitution", restitution, least=0.0, most=1.0)
    law = checks.choice("impact_law", impact_law, IMPACT_LAWS)
    return Stop(index, name, joint, int(coordinate), lower, upper, restitution, law)
