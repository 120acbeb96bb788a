"""`Clearance`: a joint with play, whose parts strike each other: a pin in a bush, a ball in a socket."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Any

import numpy as np

from carom import arguments, checks, fields
from carom.fields import Number, NumberOrNone, Value, Vector, Word
from carom.scene.friction import friction
from carom.scene.materials import IMPACT_LAWS
from carom.scene.restitution import restitution


def _axis(name: str, value) -> np.ndarray:
    return checks.unit_vector(name, value)


@arguments.known
@dataclass(frozen=True, eq=False)
class Clearance:
    """A joint with clearance: a pin of the child in a bush of the parent, or a ball in a socket.

    The pin moves freely until it touches the bush. There it strikes, with restitution and friction, and may
    slide or roll round. With a `length` both ends of the pin touch, so it is guided: a slider in its guide.
    `Scene.add_joint` makes stops of it: ``solution["pin"].force`` is that of the bush on the pin (normal, round
    the axis, along it), ``gap`` the clearance that is left, ``impacts`` the blows.

    Parameters
    ----------
    anchor : (3,)
        Centre of the pin and of the bush, in the world at the start [m].
    axis : (3,), optional
        Axis of the bush, in the world at the start. Default None: a ball in a socket.
    radial : float
        Radius of the bush less that of the pin [m], above 0.
    axial : float, optional
        How far the centre of the pin may go to either side along the axis [m]. Default: as far as it likes.
    length : float, optional
        Length of the bush [m]: the pin touches with both ends, at half of it from the anchor. Default: it
        touches with its middle, and may tilt.
    radius : float
        Radius of the pin [m], at which friction acts. Default 0.
    friction : float or Friction
        Friction of the pin in its bush, or its law. Default 0; a ball in a socket has none.
    restitution : float or Restitution
        Of the blows, from 0 (default) to 1, or its law: a function of the speed [m/s].
    impact_law : str
        As for `Scene.add_stop`.
    """

    anchor: Vector = fields.vector()
    axis: Value[Any, Any] = Value(_axis, None)
    _: KW_ONLY
    radial: Number = fields.number(above=0.0)
    axial: NumberOrNone = fields.number(None, above=0.0)
    length: NumberOrNone = fields.number(None, above=0.0)
    radius: Number = fields.number(0.0, least=0.0)
    friction: Value[Any, Any] = friction(0.0, axis=False)
    restitution: Value[Any, Any] = restitution(0.0)
    impact_law: Word = fields.word(IMPACT_LAWS, "newton")

    def __post_init__(self):
        if self.axis is None:
            for name in ("axial", "length", "friction"):
                value = getattr(self, name)
                if value is not None and value != 0.0:
                    raise ValueError(
                        f"{name} must be left out of a ball in a socket, which has no axis, got "
                        f"{checks.shown(value)}"
                    )

    @property
    def places(self) -> dict[str, np.ndarray]:
        """Centres of the circles that touch, by the ends of their names; a socket has none."""
        if self.axis is None:
            return {}
        if self.length is None:
            return {"": self.anchor}
        half = 0.5 * self.length * self.axis
        return {".1": self.anchor - half, ".2": self.anchor + half}
