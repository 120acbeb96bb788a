"""`CoordinateContact`, and checks of user-defined functions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

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


def checked_functions(q: np.ndarray, gap, gradient, tangent) -> tuple[int, ...]:
    """Check that the functions of a contact return the right shapes; return that of the tangents."""
    n = len(q)
    for what, one in (("gap", gap), ("gap_gradient", gradient), ("tangent", tangent)):
        checks.function(what, one, optional=what != "gap")
    answer("gap(q)", gap, (), q)
    if gradient is not None:
        answer("gap_gradient(q)", gradient, (n,), q)
    if tangent is None:
        return (0, n)
    rows = checks.call("tangent(q)", tangent, q.copy())
    rows = checks.real_array("tangent(q)", rows, f"({n},) or (2, {n})")
    if rows.shape not in ((n,), (1, n), (2, n)):
        raise ValueError(f"tangent(q) must have shape ({n},) or (2, {n}), got shape {rows.shape}")
    return checks.finite_array("tangent(q)", rows, rows.shape).shape


def answer(name: str, function: Callable, shape: tuple, *arguments) -> np.ndarray:
    """Return the result of a function at the start; raise an error for a shape other than `shape`."""
    given = [np.copy(a) if np.ndim(a) else a for a in arguments]
    return checks.finite_array(name, checks.call(name, function, *given), shape)
