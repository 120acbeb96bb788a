"""What a scene may state and `simulate` does not do yet: refused before a run, never left out in silence."""

from __future__ import annotations

from carom.scene.bodies import Body


def check_supported(scene) -> None:
    """Refuse contacts that the motion does not handle yet."""
    for contact in scene.contacts:
        _check_law(f"contact {contact.name!r}", contact)
    if scene.contact_default is not None:
        _check_law("set_contact_default", scene.contact_default)


def check_location(scene, impact_location: str) -> None:
    """Refuse contacts between bodies, and of curved ones, where impacts are not located."""
    if impact_location == "locate":
        return
    between = any(isinstance(c.other, Body) for c in scene.contacts)
    touching = [c.body for c in scene.contacts]
    if scene.contact_default is not None:
        between = between or len(scene.bodies) > 1
        touching += [body for body in scene.bodies if body.shape is not None]
    curved = [body for body in touching if any(p.corners is None for p in body.shape.pieces)]
    if between or curved:
        why = (
            f"shapes are curved, as that of {curved[0].name!r}"
            if curved
            else "bodies may touch each other"
        )
        raise ValueError(f'impact_location must be "locate" where {why}, got {impact_location!r}')


def _check_law(what: str, law) -> None:
    odd = [n for n in ("rolling_friction", "pivoting_friction") if getattr(law, n) != 0.0]
    if odd:
        raise ValueError(f"{what}: simulate does not use {', '.join(odd)} yet, got {law!r}")
