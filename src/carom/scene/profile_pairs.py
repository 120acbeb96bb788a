"""Which solids a profile can touch: those whose section across its axis is the same along it."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.geometry import quaternion
from carom.scene.bodies import HalfSpace

PARALLEL = 1e-6  # greatest sine of the angle between two axes that are parallel


def check_profiles(what: str, one: Any, two: Any) -> None:
    """Refuse a pair with a profile that kernels cannot treat; `what` is its name."""
    for body, other in ((one, two), (two, one)):
        if isinstance(body, HalfSpace):
            continue
        for piece in body.shape.pieces:
            if piece.kind == "profile":
                axis = quaternion.rotate(_turn(body, piece), np.array([0.0, 0.0, 1.0]))
                why = _obstacle(other, axis)
                if why:
                    raise ValueError(
                        f"{what}: a Profile can touch half-spaces across its plane, spheres, cylinders, discs "
                        "and capsules with parallel axes, boxes and prisms with edges along its axis, got "
                        f"{other.name!r}, {why}. If the two need not touch: ignore_contact"
                    )


def _turn(body, piece) -> np.ndarray:
    return quaternion.multiply(body.orientation, piece.orientation)


def _obstacle(other, axis: np.ndarray) -> str:
    """Return what of the other side does not fit a profile with an axis, nothing if all does."""
    if isinstance(other, HalfSpace):
        along = abs(float(axis @ other.normal))
        return "" if along <= PARALLEL else "whose normal is not across the axis of the profile"
    for piece in other.shape.pieces:
        if piece.kind == "point":
            continue
        if piece.kind in ("profile", "ellipsoid"):
            return f"which is {'another Profile' if piece.kind == 'profile' else 'an Ellipsoid'}"
        own = quaternion.rotate_back(_turn(other, piece), axis)
        if piece.kind in ("segment", "cylinder"):
            fits = np.hypot(own[0], own[1]) <= PARALLEL
        elif piece.kind == "box":
            fits = np.sort(np.abs(own))[1] <= PARALLEL
        else:
            along = np.abs(piece.normals @ own)
            fits = bool(np.all((along <= PARALLEL) | (along >= 1.0 - PARALLEL**2)))
        if not fits:
            return "whose axis or edges are not parallel to the axis of the profile"
    return ""
