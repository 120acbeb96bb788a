"""What a scene may state and `simulate` does not do yet: refused before a run, never left out in silence."""

from __future__ import annotations

from carom.scene.bodies import Body
from carom.scene.pieces import VERTEX_KINDS


def check_supported(scene) -> None:
    """Refuse contacts that the motion does not handle yet."""
    for contact in scene.contacts:
        _check_law(f"contact {contact.name!r}", contact)
        if isinstance(contact.other, Body):
            _check_pieces(contact.body)
            _check_pieces(contact.other)
        else:
            _ = contact.body.shape.vertices  # refused by a shape that is no hull of vertices
    if scene.contact_default is not None:
        _check_law("set_contact_default", scene.contact_default)
        for body in scene.bodies:
            if body.shape is not None:
                _check_pieces(body)


def check_location(scene, impact_location: str) -> None:
    """Refuse contacts between bodies where impacts are not located."""
    default = scene.contact_default is not None and len(scene.bodies) > 1
    if impact_location != "locate" and (
        default or any(isinstance(c.other, Body) for c in scene.contacts)
    ):
        raise ValueError(
            f'impact_location must be "locate" where bodies may touch each other, got {impact_location!r}'
        )


def _check_pieces(body: Body) -> None:
    """Refuse shapes that cannot touch other bodies yet."""
    assert body.shape is not None
    pieces = body.shape.pieces
    if len(pieces) != 1 or pieces[0].kind not in VERTEX_KINDS:
        raise ValueError(
            f"body {body.name!r}: simulate cannot let {body.shape!r} touch another body yet; so far Sphere, "
            "Capsule, Box and Convex can, rounded or not"
        )


def _check_law(what: str, law) -> None:
    odd = [n for n in ("rolling_friction", "pivoting_friction") if getattr(law, n) != 0.0]
    if odd:
        raise ValueError(f"{what}: simulate does not use {', '.join(odd)} yet, got {law!r}")
