"""Checks that a method of `simulate` can do all that a scene states; nothing is silently left out."""

from __future__ import annotations

from carom.scene.bodies import Body
from carom.scene.more_forces import JointFriction


def check_method(scene, method: str) -> None:
    """Refuse dry friction in joints for methods that do not know it."""
    if not method.startswith("rk") and any(
        isinstance(f.definition, JointFriction) for f in scene.forces
    ):
        raise ValueError(
            f'method must be "rk4", "rk5" or "rk8" where joints have dry friction, got {method!r}'
        )


def check_location(scene, impact_location: str) -> None:
    """Refuse contacts between bodies, of curved ones, and stops, where impacts are not located."""
    if impact_location == "locate":
        return
    if scene.stops:
        raise ValueError(
            f'impact_location must be "locate" where joints have stops, got {impact_location!r}'
        )
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
