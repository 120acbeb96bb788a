"""`varied`: a copy of a scene with other values."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace

import numpy as np

from carom import checks
from carom.scene.scene import Scene
from carom.scene.shapes import Box
from carom.studies.identify.recording import State, checked_state

#: parameters of `varied`: lower and upper bound, and a step large enough for the start of a search
KNOWN: dict[str, tuple[float, float, float]] = {
    "restitution": (0.0, 1.0, 0.1),
    "friction": (0.0, np.inf, 0.05),
    "friction_held": (0.0, np.inf, 0.05),
    "inertia_factor": (0.05, np.inf, 0.15),
    "corner_radius": (0.0, np.inf, 0.0),
}


def varied(
    scene: Scene,
    *,
    restitution: float | None = None,
    friction: float | None = None,
    friction_held: float | None = None,
    inertia_factor: float = 1.0,
    corner_radius: float | None = None,
    start: State | None = None,
) -> Scene:
    """Return a copy of a scene with some values changed, for all its bodies and contacts.

    Parameters
    ----------
    scene : Scene
        Scene with bodies, half-spaces and contacts; joints and forces are allowed only if `start` is None.
    restitution, friction, friction_held : float, optional
        Values for all contacts. Default: unchanged. A new `friction` also replaces `friction_held` if the two
        were equal and `friction_held` is not given.
    inertia_factor : float
        Factor of the inertia of all bodies. Default 1.
    corner_radius : float, optional
        Radius of the rounding of all boxes [m]. Their outer size, mass and inertia do not change.
    start : State, optional
        Initial state of the bodies, in their order.

    Raises
    ------
    ValueError
        If the scene has parts that cannot be copied in this way, or a value is outside its range.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene must be a carom.Scene, got {type(scene).__name__}")
    if scene.contact_default is not None:
        raise ValueError(
            "scene must have its contacts from add_contact, got one with set_contact_default; "
            "give a function that makes the scene instead"
        )
    if start is not None and (scene.joints or scene.forces):
        raise ValueError(
            "start must be left out, also of a Recording, for a scene with joints or forces, which are placed "
            f"for its own initial state, got {checks.shown(scene)}; for another start give a function that "
            "makes the scene instead"
        )
    if start is not None:
        start = checked_state(start, len(scene.bodies))
    factor = checks.scale("inertia_factor", inertia_factor)
    if corner_radius is not None:
        corner_radius = checks.length("corner_radius", corner_radius, zero=True)
    found = deepcopy(scene)
    for k, body in enumerate(found.bodies):
        change(body, inertia=factor * body.inertia)
        if corner_radius is not None and isinstance(body.shape, Box):
            change(body, shape=replace(body.shape, radius=corner_radius))
        if start is not None:
            change(body, **{name: values[k] for name, values in start._asdict().items()})
    given = {"restitution": restitution, "friction": friction, "friction_held": friction_held}
    given = {name: value for name, value in given.items() if value is not None}
    for contact in found.contacts:
        if contact.friction_held == contact.friction and "friction" in given:
            change(contact, friction_held=None)  # then it equals the new friction
        change(contact, **given)
        contact.__post_init__()
    found.validate()
    return found


def change(part, **values) -> None:
    """Set fields of a frozen part of a copied scene, each checked."""
    for name, value in values.items():
        object.__setattr__(part, name, value)
