"""`CoordinateContact`: a contact of a system in coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from carom.fields import Value, Word, word
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
    impact_law : {"newton", "poisson", "stronge"}
    index : int
        Its index in `GeneralizedSystem.contacts`.
    """

    name: str
    restitution: Value[Any, Any] = number_or_law()
    friction: Value[Any, Any] = friction()
    impact_law: Word = word(IMPACT_LAWS)
    index: int = 0
