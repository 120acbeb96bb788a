"""What a scene may state and `simulate` does not do yet: refused before a run, never left out in silence."""

from __future__ import annotations

from carom.scene.bodies import Body
from carom.scene.pieces import VERTEX_KINDS


def check_supported(scene) -> None:
    """Refuse contacts that the motion does not handle yet."""
    for contact in scene.contacts:
        if isinstance(contact.other, Body):
            _check_pieces(contact.body)
            _check_pieces(contact.other)
        else:
            _ = contact.body.shape.vertices  # refused by a shape that is no hull of vertices
    if scene.contact_default is not None:
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
