"""`Compound`: one rigid shape of several parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks, fields
from carom.fields import Value, Vector, keep
from carom.geometry import quaternion
from carom.geometry.attitude import attitude
from carom.scene.materials import Material
from carom.scene.pieces import IDENTITY, Piece, Shape


@arguments.known
@dataclass(frozen=True, eq=False)
class Part:
    """A part of a `Compound`.

    Parameters
    ----------
    shape
        Any shape.
    position : (3,)
        Position of its mass centre in the axes of the compound [m].
    orientation
        As for `Scene.add_body`, part to compound. Default no rotation.
    material : Material, optional
        Material of the surface of this part. Default: that of the body.

    Examples
    --------
    A rubber foot on a steel leg:

    >>> steel = carom.Material(restitution=0.6, friction=0.2)
    >>> rubber = carom.Material(restitution=0.1, friction=0.9)
    >>> leg = carom.Compound([
    ...     carom.Part(carom.Box(0.02, 0.02, 0.3), (0, 0, 0.15)),
    ...     carom.Part(carom.Sphere(0.02), (0, 0, 0), material=rubber),
    ... ])
    >>> scene = carom.Scene()
    >>> scene.add_body(leg, mass=1.0, material=steel, position=(0, 0, 1)).shape.pieces[1].material is rubber
    True
    """

    shape: Shape
    position: Vector = fields.vector(unit="m")
    orientation: Value[np.ndarray, Any] = Value(attitude, IDENTITY)
    material: Value[Material | None, Material | None] = Value(
        partial(checks.instance, kinds=(Material,)), None
    )

    def __post_init__(self):
        checks.instance("shape", self.shape, (Shape,), "; a shape is needed")


@arguments.known
@dataclass(frozen=True, init=False, eq=False, repr=False)
class Compound(Shape):
    """Several shapes fixed to each other as one rigid body: a dumbbell, a table, a cup.

    The shape is moved so that its mass centre becomes the origin of the body: a point with the coordinates
    ``p`` here is at ``p - centroid`` in body axes.

    Parameters
    ----------
    parts : sequence of Part, (shape, position) or (shape, position, orientation)
        `position` (3,) of the mass centre of the part [m]; `orientation` as for `Scene.add_body`, part to
        compound, default no rotation. Parts may overlap; their common volume then counts in each of them. A
        `Part` may have a material of its own.
    masses : sequence of float, optional
        Masses of the parts relative to each other, each at least 0. Default: their volumes (equal densities).
    centroid : (3,), optional
        The mass centre [m], if it is not that of the parts: for a loaded die, or for a shape that only covers a
        body with known mass properties. The body then needs its mass and inertia.

    Attributes
    ----------
    parts : tuple of (shape, position, orientation)
        The parts as given, with the material as a fourth entry where one was given.
    centroid : (3,)
        The mass centre, in the axes of `parts` [m].
    volume
        Sum of the volumes of the parts [m^3].
    size
        Upper bound of the distance of a point of the shape from its mass centre [m]: the maximum over the parts
        of the distance of their mass centre plus their own size.
    """

    parts: tuple
    centroid: np.ndarray
    volume: float
    size: float
    _pieces: tuple[Piece, ...]
    # inertia by mass [m^2]; None where the mass is not that of the parts
    _spread: np.ndarray | None

    def __init__(
        self, parts: Sequence, masses: ArrayLike | None = None, centroid: ArrayLike | None = None
    ):
        placed = tuple(_part(k, part) for k, part in enumerate(_sequence(parts)))
        shapes = [part[0] for part in placed]
        volumes = np.array([shape.volume for shape in shapes])
        positions = np.array([part[1] for part in placed])
        if centroid is None:
            weights = _weights(shapes, volumes, masses)
            middle = weights @ positions
            spread = _spread_of(placed, positions - middle, weights)
        else:
            if masses is not None:
                raise ValueError(
                    f"masses must be left out if centroid is given, got {checks.shown(masses)}"
                )
            middle, spread = checks.finite_array("centroid", centroid, (3,)), None
        arms = positions - middle
        size = max(float(np.linalg.norm(a)) + s.size for a, s in zip(arms, shapes))
        pieces = [p.placed(a, *place) for a, (s, _, *place) in zip(arms, placed) for p in s.pieces]
        keep(self, parts=placed, centroid=middle, volume=float(volumes.sum()), size=size)
        keep(self, _pieces=tuple(pieces), _spread=spread)

    def __repr__(self) -> str:
        return f"Compound(<{', '.join(type(part[0]).__name__ for part in self.parts)}>)"

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """Convex pieces of all parts."""
        return self._pieces

    @property
    def has_materials(self) -> bool:
        """Whether a part has a material of its own."""
        return any(piece.material is not None for piece in self._pieces)

    @property
    def radius(self) -> float:
        """Radius of the ball that rounds all parts, if it is the same for all [m]."""
        return self.pieces[0].radius

    def _inertia(self, mass: float) -> np.ndarray:
        if self._spread is None:
            raise ValueError(
                f"inertia must be given with {self!r}, whose centroid was given: its mass distribution is "
                "unknown"
            )
        return mass * self._spread


def _spread_of(placed, arms, weights) -> np.ndarray:
    """Return the inertia (3,3) by mass of parts with these weights, about their mass centre."""
    spread = np.zeros((3, 3))
    for weight, arm, (shape, _, turn, *_) in zip(weights, arms, placed):
        axes = quaternion.matrix(turn)
        spread += axes @ shape.inertia(weight) @ axes.T
        spread += weight * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return 0.5 * (spread + spread.T)


def _sequence(parts) -> Sequence:
    """Return the parts, as a sequence that is not empty."""
    if not isinstance(parts, Sequence) or isinstance(parts, (str, bytes)) or len(parts) == 0:
        raise ValueError(
            "parts must be a sequence of at least one Part or (shape, position, orientation), got "
            f"{checks.shown(parts)}"
        )
    return parts


def _part(number: int, part) -> tuple:
    """Return a checked (shape, position, orientation), with the material if there is one."""
    if isinstance(part, Part):
        place = part.shape, part.position, part.orientation
        return place if part.material is None else (*place, part.material)
    name = f"parts[{number}]"
    if not isinstance(part, Sequence) or len(part) not in (2, 3):
        raise ValueError(
            f"{name} must be (shape, position), (shape, position, orientation) or a Part, got "
            f"{checks.shown(part)}"
        )
    shape, position, *turn = part
    checks.instance(f"{name}[0]", shape, (Shape,), "; a shape is needed")
    position = checks.finite_array(f"{name}[1]", position, (3,))
    orientation = attitude(f"{name}[2]", turn[0] if turn else IDENTITY)
    for array in (position, orientation):
        array.setflags(write=False)
    return shape, position, orientation


def _weights(shapes, volumes, masses) -> np.ndarray:
    """Return the part of each in the whole mass."""
    if masses is None:
        if not np.all(volumes > 0.0):
            flat = shapes[int(np.argmin(volumes))]
            raise ValueError(
                f"masses must be given where a part has no volume, got None and {checks.shown(flat)}"
            )
        return volumes / volumes.sum()
    weights = checks.finite_array("masses", masses, (len(shapes),))
    if not (np.all(weights >= 0.0) and weights.sum() > 0.0):
        raise ValueError(f"masses must be at least 0 and not all 0, got {checks.shown(masses)}")
    return weights / weights.sum()
