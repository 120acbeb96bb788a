"""`CoordinateContact`, and its checks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from carom import checks
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


def checked_contact(
    others: Sequence[CoordinateContact], tangent, restitution, friction, impact_law, name
) -> CoordinateContact:
    """Return a contact; raise an error for numbers out of range, and for the name of one of `others`."""
    name = f"contact {len(others)}" if name is None else checks.text("name", name)
    contact = CoordinateContact(name, restitution, friction, impact_law, len(others))
    if contact.friction > 0.0 and tangent is None:
        raise ValueError(
            f"friction needs a tangent, got friction {checks.shown(friction)} without one"
        )
    if any(name == other.name for other in others):
        raise ValueError(f"name must be unique, got {checks.shown(name)} twice")
    return contact
