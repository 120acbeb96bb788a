"""`Tether`: a massless cord between two points, which pulls and does not push."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from carom import arguments, fields
from carom.fields import NumberOrNone, Value, VectorOrNone, Word
from carom.scene.materials import IMPACT_LAWS
from carom.scene.restitution import restitution


@arguments.known
@dataclass(frozen=True, eq=False)
class Tether:
    """A massless cord of fixed length between a point of the parent and one of the child.

    It leaves both free while it is slack. When it gets taut it strikes as a stop does, with restitution, and
    then pulls for as long as it is under tension. `Scene.add_joint` makes a `Stop` of it:
    ``solution["cord"].force`` has its tension in the first column, ``gap`` is by how much it is slack, and
    ``impacts`` are the jerks.

    Parameters
    ----------
    length : float, optional
        Greatest distance of the two points [m], above 0. Default: their distance at the start.
    anchor_parent, anchor_child : (3,), optional
        The points, in the world at the start [m]. Default: the mass centres; of the ground it must be given.
    restitution : float or Restitution
        Of the jerk by which it gets taut, from 0 (default) to 1, or its law: a function of the speed [m/s].
    impact_law : str
        As for `Scene.add_stop`.

    Raises
    ------
    ValueError
        If a value is invalid, or the points are farther apart at the start than `length`.
    """

    length: NumberOrNone = fields.number(None, above=0.0)
    anchor_parent: VectorOrNone = fields.vector(None)
    anchor_child: VectorOrNone = fields.vector(None)
    restitution: Value[Any, Any] = restitution(0.0)
    impact_law: Word = fields.word(IMPACT_LAWS, "newton")
