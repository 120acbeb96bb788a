"""`Switch`: parts that a run takes out of the motion, or puts into it, and when."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from carom import checks, fields
from carom.fields import Flag, FunctionOrNone, NumberOrNone, Value
from carom.scene.values import PartOfScene, in_scene

#: what may break a part, with its unit
LIMITS = {"force": "N", "torque": "N m", "impulse": "N s"}


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class Switch(PartOfScene):
    """Parts that are switched off or on together. `Scene.switch` makes it.

    Attributes
    ----------
    parts : tuple
    off : bool
        Whether the switch takes the parts out of the motion, or puts them into it.
    time : float or None
        When it acts [s].
    event : str or None
        The event at which it acts, as of `simulate`.
    when : callable or None
        A function of (t, state) at whose zeros it acts.
    force, torque, impulse : float or None
        Limits beyond which the first of the parts breaks [N], [N m], [N s].
    """

    parts: tuple[Any, ...]
    off: Flag = fields.flag(True)
    time: NumberOrNone = fields.number(None, least=0.0, unit="s")
    event: Value[str | None, str | None] = Value(checks.text, None)
    when: FunctionOrNone = fields.function(None)
    force: NumberOrNone = fields.number(None, above=0.0, unit="N")
    torque: NumberOrNone = fields.number(None, above=0.0, unit="N m")
    impulse: NumberOrNone = fields.number(None, above=0.0, unit="N s")

    @property
    def limits(self) -> dict[str, float]:
        """The limits at which it breaks, by name."""
        return {name: limit for name in LIMITS if (limit := getattr(self, name)) is not None}

    @property
    def at(self) -> Any:
        """When it acts: a time, the name of an event, a function or limits; None if `carom.Run` decides."""
        given = (self.time, self.event, self.when)
        return next((one for one in given if one is not None), self.limits or None)

    def __repr__(self) -> str:
        names = ", ".join(repr(part.name) for part in self.parts)
        limits = ", ".join(
            f"{name} > {limit:g} {LIMITS[name]}" for name, limit in self.limits.items()
        )
        at = f"{self.time:g} s" if self.time is not None else self.event or limits or None
        shown = getattr(self.when, "__name__", "a function") if self.when is not None else at
        return f"Switch({self.name!r}, {names}, {'off' if self.off else 'on'} at {shown})"
