"""Contacts: a body that may touch a half-space or another body, and their gap at the start."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.geometry import quaternion
from carom.scene.bodies import Body, HalfSpace, StaticBody
from carom.scene.materials import IMPACT_LAWS, ContactLaw
from carom.scene.profile_pairs import check_profiles
from carom.scene.stiffness import ABSOLUTE, Hertz, is_point_contact
from carom.scene.surfaces import SurfaceDefinition
from carom.scene.user_surface import Surface, check_at, evaluator
from carom.scene.values import PartOfScene, in_scene

__all__ = ["IMPACT_LAWS", "Contact", "check_gap", "check_overlap", "initial_gap"]

TOUCH = 1e-12  # relative to the lengths at hand: rounding of a body placed on another


def check_curvature(body: Body, other: HalfSpace | StaticBody | Body) -> None:
    """Refuse a body that touches curved ground in places that its contact does not find."""
    surface = None if isinstance(other, HalfSpace) else other.shape
    if not isinstance(surface, SurfaceDefinition) or body.shape is None:
        return
    for piece in body.shape.pieces:
        why = surface.refusal(piece)
        if why:
            raise ValueError(
                f"body {body.name!r}, {body.shape!r}, cannot touch {other.name!r}, {surface!r}: {why}"
            )


def check_hertz(stiffness, body: Body, other) -> None:
    """Refuse Hertz's law without a radius for shapes that do not tell one."""
    if (
        isinstance(stiffness, Hertz)
        and stiffness.radius is None
        and not is_point_contact(body, other)
    ):
        raise ValueError(
            f"stiffness of {body.name!r} on {other.name!r} must have a radius, which only balls, ellipsoids "
            "and planes have by themselves: carom.Hertz(young, poisson, radius=), with 1/radius the sum of "
            "the curvatures where they touch; an edge or a face has none, give carom.Stiffness(k, exponent)"
        )


@in_scene
@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Contact(PartOfScene, ContactLaw):
    """A pair that may touch. `Scene.add_contact` makes it; it also has the attributes of its `ContactLaw`.

    Attributes
    ----------
    body : Body
    other : HalfSpace, StaticBody or Body
        The partner of `body`. The normal of the contact points from `other` to `body`.
    """

    body: Body
    other: HalfSpace | StaticBody | Body

    def __post_init__(self):
        super().__post_init__()
        for part in (self.body, self.other):
            if isinstance(part, Body):
                if part.shape is None:
                    raise ValueError(f"body must have a shape for contact, got {part!r}")
                _ = part.shape.pieces  # refused by a shape that has nothing to touch with
        check_curvature(self.body, self.other)
        check_profiles(f"contact {self.name!r}", self.body, self.other)

    @property
    def half_space(self) -> HalfSpace | None:
        """The half-space, or None if `other` is a body or a static body."""
        return self.other if isinstance(self.other, HalfSpace) else None

    def __repr__(self) -> str:
        plain = ContactLaw(friction=self.friction, friction_held=self.friction)
        law = {name: getattr(self, name) for name in vars(plain)}
        shown = {"restitution": "", "friction": "", "impact_law": ""}
        values = ", ".join(
            f"{name}={value!r}" if isinstance(value, (str, *ABSOLUTE)) else f"{name}={value:g}"
            for name, value in law.items()
            if name in shown or (value != getattr(plain, name) and name != "of_materials")
        )
        return f"Contact({self.name!r}, {values})"


def initial_gap(contact: Contact) -> float:
    """Return the gap [m] between the two at the start, negative if they overlap."""
    return gap_between(contact.body, contact.other)[0]


def check_gap(contact: Contact) -> None:
    """Refuse a contact whose partners overlap at the start by more than rounding."""
    check_overlap(f"contact {contact.name!r}", contact.body, contact.other)


def check_overlap(what: str, body: Body, other: HalfSpace | StaticBody | Body) -> None:
    """Refuse a pair that cannot touch or overlaps at the start by more than rounding; `what` is its name."""
    check_curvature(body, other)
    if far(body, other, body.position, place(other)):
        return
    depth, normal = overlap(body, other)
    if not depth <= 0.0:
        raise ValueError(
            f"{what}: position {body.position} puts {body.name!r} "
            f"{depth:.6g} m deep into {other.name!r}, but the gap must be at least 0; move the body by at "
            f"least this depth along the normal {normal}"
        )


def place(part: HalfSpace | StaticBody | Body) -> np.ndarray:
    """Return the position of a body, or a point of a half-space."""
    return part.point if isinstance(part, HalfSpace) else part.position


def far(body: Body, other: HalfSpace | StaticBody | Body, x: np.ndarray, y: np.ndarray):
    """Return whether the bounding ball of a body at x (..., 3) does not reach the other at y (..., 3).

    Then no gap is computed.
    """
    assert body.shape is not None
    if isinstance(other, HalfSpace):
        return (x - y) @ other.normal > body.shape.size
    if isinstance(other.shape, SurfaceDefinition):  # without end
        return np.zeros(np.broadcast_shapes(np.shape(x), np.shape(y))[:-1], dtype=bool)[()]
    assert other.shape is not None
    return np.sum((x - y) ** 2, axis=-1) > (body.shape.size + other.shape.size) ** 2


def overlap(body: Body, other: HalfSpace | StaticBody | Body) -> tuple[float, np.ndarray]:
    """Return the depth [m] of a body in the other at the start, 0 if it is rounding, and the normal (3,)."""
    assert body.shape is not None
    gap, normal = gap_between(body, other)
    if isinstance(other, HalfSpace):
        length = body.shape.size + float(np.linalg.norm(body.position - other.point))
    else:
        assert other.shape is not None
        places = np.linalg.norm(body.position) + np.linalg.norm(other.position)
        length = body.shape.size + other.shape.size + float(places)
        if gap != gap and isinstance(other.shape, Surface):  # with the error of its function
            own = quaternion.rotate_back(other.orientation, body.position - other.position)
            check_at(other.shape, evaluator(other.shape), own)
    return (0.0 if gap >= -TOUCH * length else -gap), normal


def gap_between(body: Any, other: Any) -> tuple[float, np.ndarray]:
    """Return the gap [m], negative inside, and the normal (3,) from the other to the body.

    `body` and `other` have a shape, a position and an orientation; `other` may be a half-space.
    """
    if isinstance(other, HalfSpace):
        down = quaternion.rotate_back(body.orientation, -other.normal)
        depth = float(body.shape.support(down) @ down)
        return float((body.position - other.point) @ other.normal) - depth, other.normal
    from carom.collision.api import nearest_points  # compiled code, only where bodies meet

    here, there = (body.position, body.orientation), (other.position, other.orientation)
    point = nearest_points(body.shape, here, other.shape, there)
    return point.gap, point.normal
