"""What a scene may state and `simulate` does not do yet: refused before a run, never left out in silence."""

from __future__ import annotations

from carom.scene.bodies import Body
from carom.scene.contacts import Contact
from carom.scene.materials import ContactLaw


def check_supported(scene) -> None:
    """Refuse contacts that the motion does not handle yet."""
    if scene.contact_default is not None and len(scene.bodies) > 1:
        raise ValueError(
            "simulate cannot let all pairs touch yet, got set_contact_default with "
            f"{len(scene.bodies)} bodies; add the contacts with half-spaces by add_contact"
        )
    for contact in scene.contacts:
        _check_contact(contact)


def _check_contact(contact: Contact) -> None:
    if isinstance(contact.other, Body):
        raise ValueError(
            f"contact {contact.name!r}: simulate cannot let two bodies touch yet, got {contact!r}; "
            "so far bodies touch half-spaces"
        )
    assert contact.body.shape is not None
    _ = contact.body.shape.vertices  # refused by a shape that is no hull of vertices
    plain = ContactLaw()
    odd = [
        n
        for n in ("rolling_friction", "pivoting_friction")
        if getattr(contact, n) != getattr(plain, n)
    ]
    if odd:
        raise ValueError(
            f"contact {contact.name!r}: simulate does not use {', '.join(odd)} yet, got {contact!r}"
        )
