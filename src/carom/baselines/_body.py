"""The data of a scene for Moreau-Jean: one body, one half-space, and the gap between them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from carom import checks
from carom.geometry.frames import contact_axes

_TIE = 1e-9  # points whose heights differ by less than this part of the size strike together


class OneBody(NamedTuple):
    """One rigid body above one half-space."""

    mass: float
    inertia: np.ndarray  # (3, 3), body axes, about the mass centre
    points: np.ndarray  # (m, 3) vertices in body axes; the mass centre for a sphere
    radius: float  # radius of the ball around each point
    axes: np.ndarray  # (3, 3) rows n, t1, t2
    plane_point: np.ndarray
    restitution: float
    friction: float
    gravity: np.ndarray


def read_scene(scene) -> tuple[OneBody, Any]:
    """Return the arrays of a scene of one body and one contact, and the body; refuse other scenes."""
    if isinstance(scene, type) or not (hasattr(scene, "bodies") and hasattr(scene, "contacts")):
        raise TypeError(f"scene must be a Scene, got {checks.shown(scene)}")
    if hasattr(scene, "validate"):
        scene.validate()
    bodies, contacts = list(scene.bodies), list(scene.contacts)
    if len(bodies) != 1 or len(contacts) != 1:
        raise ValueError(
            "scene must have exactly one body and one contact for moreau_jean, got "
            f"{len(bodies)} bodies and {len(contacts)} contacts"
        )
    for kind in ("joints", "constraints", "forces"):
        if len(getattr(scene, kind, ())) > 0:
            raise ValueError(f"scene must have no {kind} for moreau_jean")
    body, contact = bodies[0], contacts[0]
    vertices = getattr(body.shape, "vertices", None)
    ball = vertices is None or len(vertices) == 0
    points = np.zeros((1, 3)) if ball else np.array(vertices, dtype=np.float64)
    system = OneBody(
        mass=float(body.mass),
        inertia=np.array(body.inertia, dtype=np.float64),
        points=points,
        radius=float(getattr(body.shape, "radius", 0.0) or 0.0),
        axes=contact_axes(np.asarray(contact.half_space.normal, dtype=np.float64)),
        plane_point=np.array(contact.half_space.point, dtype=np.float64),
        restitution=checks.number("restitution of the contact", contact.restitution),
        friction=float(contact.friction),
        gravity=np.array(scene.gravity, dtype=np.float64),
    )
    return system, body


def lowest_point(system: OneBody, x, R) -> tuple[float, np.ndarray]:
    """Return the gap [m] and the arm (3,) from mass centre to contact, in world axes.

    Several lowest points at the same height (an edge or a face) are replaced by their mean.
    """
    n = system.axes[0]
    arms = system.points @ R.T
    heights = arms @ n
    size = max(float(np.abs(system.points).max()), system.radius)
    tied = heights <= heights.min() + _TIE * size
    arm = arms[tied].mean(axis=0) - system.radius * n
    return float((x + arm - system.plane_point) @ n), arm


def contact_jacobian(system: OneBody, R, arm) -> np.ndarray:
    """Return G (3, 6): contact velocity (n, t1, t2) from xdot (world) and W (body axes).

    Rows ``e^T [I, -hat(r) R]`` with r the arm: the velocity of the point is ``xdot + (R W) x r``.
    """
    spin = np.cross(arm, system.axes) @ R  # e.(w x r) = (r x e).w
    return np.hstack([system.axes, spin])
