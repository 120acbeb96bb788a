"""Parts of a scene that an `impact_location` does not support: they are refused before the run."""

from __future__ import annotations

from carom.scene.bodies import HalfSpace


def check_location(scene, impact_location: str) -> None:
    """Refuse stops, contacts between bodies and curved shapes if impacts are not located."""
    if impact_location == "locate":
        return
    if scene.stops:
        raise ValueError(
            f'impact_location must be "locate" if joints have stops, got {impact_location!r}'
        )
    between = any(not isinstance(c.other, HalfSpace) for c in scene.contacts)
    touching = [c.body for c in scene.contacts]
    if scene.contact_default is not None:
        between = between or len(scene.bodies) > 1 or bool(scene.statics)
        touching += [body for body in scene.bodies if body.shape is not None]
    curved = [body for body in touching if any(p.corners is None for p in body.shape.pieces)]
    if between or curved:
        why = (
            f"shapes are curved, as that of {curved[0].name!r}"
            if curved
            else "bodies may touch each other"
        )
        raise ValueError(f'impact_location must be "locate" if {why}, got {impact_location!r}')
