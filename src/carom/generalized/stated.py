"""`CoordinateContact`: a contact of a system in coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from carom.fields import Number, Value, Word, number, word
from carom.scene.friction import friction
from carom.scene.materials import IMPACT_LAWS
from carom.scene.restitution import restitution as number_or_law


@dataclass(frozen=True)
class CoordinateContact:
    """A contact of a `GeneralizedSystem`.

    Attributes
    ----------
    name : str
    restitution : float or Restitution
        Coefficient of restitution e, or its law.
    friction : float or Friction
        Friction coefficient mu, or its law.
    impact_law : {"newton", "poisson", "stronge", "moreau"}
    tangential_restitution : float
        e_t.
    index : int
        Its index in `GeneralizedSystem.contacts`.
    """

    name: str
    restitution: Value[Any, Any] = number_or_law()
    friction: Value[Any, Any] = friction(axis=False)
    impact_law: Word = word(IMPACT_LAWS)
    tangential_restitution: Number = number(0.0, least=-1, most=1)
    index: int = 0
