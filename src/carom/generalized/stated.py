"""What the user says of a contact, and checks of the user's functions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from carom import check

LAWS = ("newton", "poisson", "stronge")


@dataclass(frozen=True)
class CoordinateContact:
    """A contact of a system in coordinates: its law; what touches is told by its gap."""

    name: str
    restitution: float
    friction: float
    impact_law: str
    index: int


def checked_contact(
    others: Sequence[CoordinateContact], tangent, restitution, friction, impact_law, name
) -> CoordinateContact:
    """Return a contact; refuse numbers out of range and a name that `others` have."""
    e = check.number("restitution", restitution, least=0.0, most=1.0)
    mu = check.number("friction", friction, least=0.0)
    check.choice("impact_law", impact_law, LAWS)
    if mu > 0.0 and tangent is None:
        raise ValueError(f"friction needs a tangent, got friction {friction!r} without one")
    name = f"contact {len(others)}" if name is None else name
    if any(name == other.name for other in others):
        raise ValueError(f"name must be new, got {name!r} twice")
    return CoordinateContact(name, e, mu, impact_law, len(others))


def checked_functions(q: np.ndarray, gap, gradient, tangent) -> int:
    """Refuse functions of a contact that are none or give another shape; return how many tangents."""
    n = len(q)
    for what, one in (("gap", gap), ("gap_gradient", gradient), ("tangent", tangent)):
        if not callable(one) and (one is not None or what == "gap"):
            raise TypeError(f"{what} must be a function, got {one!r}")
    answer("gap(q)", gap, (), q)
    if gradient is not None:
        answer("gap_gradient(q)", gradient, (n,), q)
    if tangent is None:
        return 0
    rows = np.asarray(tangent(q.copy()), dtype=float)
    if rows.shape not in ((n,), (1, n), (2, n)):
        raise ValueError(f"tangent(q) must have shape ({n},) or (2, {n}), got shape {rows.shape}")
    return rows.size // n


def answer(name: str, function: Callable, shape: tuple, *arguments) -> np.ndarray:
    """Return what a function gives at the start; refuse another shape than `shape`."""
    result = function(*(np.copy(a) if np.ndim(a) else a for a in arguments))
    return check.finite_array(name, result, shape)
