"""A body that may strike a half-space, and the gap between the two."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom import check
from carom.geometry import quaternion
from carom.scene.bodies import Body, HalfSpace

IMPACT_LAWS = ("newton", "poisson", "stronge")
TOUCH = 1e-12  # relative to the lengths at hand: rounding of a body placed on the plane


@dataclass(frozen=True, eq=False, repr=False)
class Contact:
    """A body and a half-space that may touch. Made by `Scene.add_contact`.

    Attributes
    ----------
    index : int
        Place in `Scene.contacts`.
    name : str
    body : Body
    half_space : HalfSpace
    restitution : float
        e, 0 to 1.
    friction : float
        mu, at least 0.
    impact_law : {"newton", "poisson", "stronge"}
    """

    index: int
    name: str
    body: Body
    half_space: HalfSpace
    restitution: float
    friction: float
    impact_law: str

    def __repr__(self) -> str:
        return (
            f"Contact({self.name!r}, restitution={self.restitution:g}, "
            f"friction={self.friction:g}, impact_law={self.impact_law!r})"
        )


def make_contact(index, name, body, half_space, restitution, friction, impact_law) -> Contact:
    """Return a checked `Contact`; the arguments are those of `Scene.add_contact`."""
    contact = Contact(
        index=index,
        name=name,
        body=body,
        half_space=half_space,
        restitution=check.number("restitution", restitution, least=0, most=1),
        friction=check.number("friction", friction, least=0),
        impact_law=check.choice("impact_law", impact_law, IMPACT_LAWS),
    )
    if body.shape is None:
        raise ValueError(f"body must have a shape to touch with, got {body!r}")
    check_gap(contact)
    return contact


def initial_gap(contact: Contact) -> float:
    """Return the distance [m] of the body from the half-space at the start; inside is negative."""
    body, plane = contact.body, contact.half_space
    assert body.shape is not None
    offsets = quaternion.rotate(body.orientation, body.shape.vertices)
    lowest = float(np.min(offsets @ plane.normal))
    return lowest + float((body.position - plane.point) @ plane.normal) - body.shape.radius


def check_gap(contact: Contact) -> None:
    """Refuse a contact whose body starts inside the half-space by more than rounding."""
    body, plane = contact.body, contact.half_space
    assert body.shape is not None
    gap = initial_gap(contact)
    length = body.shape.size + float(np.linalg.norm(body.position - plane.point))
    if not gap >= -TOUCH * length:
        raise ValueError(
            f"contact {contact.name!r}: position {body.position} puts {body.name!r} "
            f"{-gap:.6g} m deep into {plane.name!r}, allowed is a gap of at least 0; move the body "
            f"by at least that along the normal {plane.normal}"
        )
