"""Flexible bodies: the bodies that stand for their modes, what holds these back, and their supports.

Three modes are one body, which follows the flexible one in `Scene.bodies`: its position (3,) are their
coordinates, in units in which their mass is that of the flexible body.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom import checks
from carom.flexible.modes import Modes
from carom.geometry import quaternion
from carom.scene.shapes.profile import Profile

if TYPE_CHECKING:
    from carom.scene.bodies import Body
    from carom.scene.registry import Registry


def of_modes(modes: Modes, shape, given: dict[str, Any], replace: bool) -> tuple[float, Any]:
    """Return mass and inertia of a free body with modes, which nothing else may state."""
    checks.instance("modes", modes, (Modes,))
    if modes.supported:
        raise ValueError(
            f"modes must be those of a free body, got {modes!r}; a body on supports is made by "
            "add_static(shape, modes=modes)"
        )
    for name, value in given.items():
        if value is not None and not (name == "inertia" and modes.inertia is None):
            raise ValueError(
                f"{name} must be left out with modes, which have their own, got {checks.shown(value)}"
            )
    check_shape(shape)
    if checks.flag("replace", replace):
        raise ValueError(
            "replace must be left out with modes, got True; remove the body and add it anew"
        )
    return modes.mass, given["inertia"] if modes.inertia is None else modes.inertia


def check_shape(shape) -> None:
    """Refuse shapes that cannot bend."""
    if shape is None:
        raise ValueError("shape must be given with modes, got None")
    if isinstance(shape, Profile):
        raise ValueError(
            f"shape must be another one than a Profile with modes, got {checks.shown(shape)}; give a Box, a "
            "Capsule, a Cylinder, a Convex or a Compound"
        )


def rigid(parent, child) -> None:
    """Refuse a flexible body as a side of a joint or of a force."""
    for argument, end in (("parent", parent), ("child", child)):
        if getattr(end, "modes", None) is not None:
            raise ValueError(
                f"{argument} must be a rigid body, got {checks.shown(end)} with modes; joints, springs and "
                "loads on flexible bodies do not move their modes"
            )


def add_modes(parts: Registry, body: Body, modes: Modes, gravity: np.ndarray) -> None:
    """Add the bodies that stand for the modes of a body, three each, and what holds them back.

    On supports they begin bent by the weight of the body.
    """
    from carom.scene.bodies import Body
    from carom.scene.forces import AppliedForce
    from carom.scene.modal_spring import ModalSpring

    n, mass = len(modes), float(body.mass)
    w = 2.0 * np.pi * modes.frequencies
    down = quaternion.rotate_back(body.orientation, np.asarray(gravity, dtype=float))
    weights, rows = np.zeros((n + -n % 3, 3)), np.zeros((3, n + -n % 3))
    weights[:n] = np.sqrt(mass) * modes.participation.T
    rows[0, :n], rows[1, :n] = mass * w * w, 2.0 * mass * modes.damping * w
    rows[2, :n] = weights[:n] @ down / rows[0, :n]
    size = 1.0 if body.shape is None else body.shape.size
    inertia = np.full(3, 2.0 / 3.0 * mass * size**2)  # of no use but as a size
    for first in range(0, n, 3):
        stiffness, damping, start = rows[:, first : first + 3]
        last = min(first + 3, n)
        which = f"{first + 1}-{last}" if last > first + 1 else f"{last}"
        three = parts.make(
            Body, "body", f"{body.name} modes {which}", False, shape=None,
            mass=mass, inertia=inertia, position=start, orientation=(1.0, 0.0, 0.0, 0.0),
            velocity=(0.0, 0.0, 0.0), angular_velocity=(0.0, 0.0, 0.0), material=None, color=None, look=(),
        )  # fmt: skip
        parts.make(
            AppliedForce, "force", f"{three.name} stiffness", False,
            definition=ModalSpring(stiffness, damping, weights[first : first + 3]), parent=body, child=three,
        )  # fmt: skip


def bodies_of_modes(scene, part) -> list[Body]:
    """Return the bodies that stand for the modes of a part; none of one without modes."""
    if getattr(part, "modes", None) is None:
        return []
    return [one for one in scene.bodies if one.name.startswith(f"{part.name} modes ")]


def add_supported(scene, shape, modes: Modes, place: dict[str, Any], name: str | None) -> Body:
    """Add a flexible body on its supports: its axes stay where they are."""
    from carom.scene.bodies import GROUND, Body
    from carom.scene.joints import Fixed
    from carom.scene.joints.joint import Joint

    checks.instance("modes", modes, (Modes,))
    if not modes.supported:
        raise ValueError(
            f"modes must be those of a body on supports, got {modes!r}; a free one is made by "
            "add_body(shape, modes=modes)"
        )
    check_shape(shape)
    inertia = shape.inertia(modes.mass) if modes.inertia is None else modes.inertia
    if name is None:
        name = scene._parts._numbered("static", len(scene.statics) + 1)
    body = scene._parts.make(
        Body, "body", name, False, shape=shape, mass=modes.mass, inertia=inertia, modes=modes,
        velocity=(0.0, 0.0, 0.0), angular_velocity=(0.0, 0.0, 0.0), look=None, **place,
    )  # fmt: skip
    scene._parts.make(
        Joint, "joint", f"{body.name} support", False, definition=Fixed(), parent=GROUND, child=body,
        frames=(None, None),
    )  # fmt: skip
    add_modes(scene._parts, body, modes, scene.gravity)
    return body
