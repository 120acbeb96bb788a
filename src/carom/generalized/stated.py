"""`CoordinateContact`: a contact of a system in coordinates."""

from __future__ import annotations

from dataclasses import dataclass

from carom.fields import Number, Word, number, word
from carom.scene.materials import IMPACT_LAWS


@dataclass(frozen=True)
class CoordinateContact:
    """A contact of a `GeneralizedSystem`.

    Attributes
    ----------
    name : str
    restitution, friction : float
        Coefficient of restitution e and friction coefficient mu.
    impact_law : {"newton", "poisson", "stronge"}
    index : int
        Its index in `GeneralizedSystem.contacts`.
    """

    name: str
    restitution: Number = number(least=0.0, most=1.0)
    friction: Number = number(least=0.0)
    impact_law: Word = word(IMPACT_LAWS)
    index: int = 0
