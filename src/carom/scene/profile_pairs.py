"""Which solids a profile can touch: those whose section across its axis is the same along it."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.geometry import quaternion
from carom.scene.bodies import HalfSpace

#: kinds of pieces that no profile touches
REFUSED = {"ellipsoid": "an Ellipsoid", "implicit": "curved ground"}
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
                        f"{what}: a Profile can touch half-spaces across its plane, spheres, cylinders, discs, "
                        "capsules and profiles with parallel axes, boxes and prisms with edges along its axis, "
                        f"got {other.name!r}, {why}. If the two need not touch: ignore_contact"
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
        if piece.kind in REFUSED:
            return f"which is {REFUSED[piece.kind]}"
        if _slant(piece, quaternion.rotate_back(_turn(other, piece), axis)) > PARALLEL:
            return "whose axis or edges are not parallel to the axis of the profile"
    return ""


def _slant(piece, axis: np.ndarray) -> float:
    """Return the sine of the greatest angle between an axis, in those of a piece, and its axis or edges."""
    if piece.kind == "point":
        return 0.0
    if piece.kind in ("segment", "cylinder", "profile"):
        return float(np.hypot(axis[0], axis[1]))
    if piece.kind == "box":
        return float(np.hypot(*np.sort(np.abs(axis))[:2]))
    along = np.minimum(np.abs(piece.normals @ axis), 1.0)
    return float(np.max(np.minimum(along, np.sqrt(1.0 - along**2))))


def slant(one, turn, other, other_turn) -> float:
    """Return the greatest angle [rad] of a profile of one shape to the axes of another, at two attitudes."""
    most = 0.0
    for a, q, b, p in ((one, turn, other, other_turn), (other, other_turn, one, turn)):
        for profile in (piece for piece in a.pieces if piece.kind == "profile"):
            axis = quaternion.rotate(
                quaternion.multiply(q, profile.orientation), np.array([0.0, 0.0, 1.0])
            )
            for piece in b.pieces:
                own = quaternion.rotate_back(quaternion.multiply(p, piece.orientation), axis)
                most = max(most, _slant(piece, own))
    return float(np.arcsin(min(most, 1.0)))
