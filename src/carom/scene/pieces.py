"""The convex pieces of a shape for contact: each a core rounded by a ball, placed in body axes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.fields import keep
from carom.geometry import quaternion
from carom.geometry.cells import Cells, cells_of
from carom.scene.materials import Material
from carom.scene.outline import Outline

IDENTITY = (1.0, 0.0, 0.0, 0.0)
#: of the corners of a box
SIGNS = np.array([(i, j, k) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
VERTEX_KINDS = ("point", "segment", "box", "hull")


@dataclass(frozen=True, eq=False)
class Piece:
    """A convex piece: all points within a distance `radius` of a convex core.

    Attributes
    ----------
    kind : {"point", "segment", "box", "hull", "cylinder", "ellipsoid", "profile"}
        Kind of the core. Segments, cylinders and profiles lie along z of the piece.
    half : (3,)
        Half sizes of the core along its axes [m].
    radius : float
        Radius of the ball that rounds the core [m].
    inner : float
        For an ellipsoid: it is also a smaller convex core, rounded by a ball of this radius [m].
    extent : float
        Largest distance of a point of the piece from its own origin [m].
    vertices : (n, 3)
        Vertices of a hull, in axes of the piece [m].
    faces : tuple of (normal, ring)
        Faces of a hull: outward unit normal and the indices of its vertices, counter-clockwise from outside.
    outline, hollows, bend : (n, 13), (k, 2), float
        Boundary of a profile, where it is most hollow (`carom.scene.outline`), and the greatest curvature of
        its smooth hollows [1/m].
    position, orientation : (3,), (4,)
        Position and orientation of the piece in the axes of the body.
    material : Material or None
        Material of the surface of the piece; None: that of its body.
    """

    kind: str
    half: np.ndarray = field(default_factory=lambda: np.zeros(3))
    radius: float = 0.0
    inner: float = 0.0
    extent: float = 0.0
    vertices: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    faces: tuple = ()
    outline: np.ndarray = field(default_factory=lambda: np.zeros((0, 13)))
    hollows: np.ndarray = field(default_factory=lambda: np.zeros((0, 2)))
    bend: float = 0.0
    position: np.ndarray = field(default_factory=lambda: np.zeros(3))
    orientation: np.ndarray = field(default_factory=lambda: np.array(IDENTITY))
    material: Material | None = None

    def __post_init__(self):
        keep(self, half=np.array(self.half, dtype=float))

    @cached_property
    def normals(self) -> np.ndarray:
        """Outward unit normals (f,3) of the faces of a hull, in axes of the piece."""
        return np.array([normal for normal, _ in self.faces]).reshape(-1, 3)

    @cached_property
    def cells(self) -> tuple[Cells, Cells]:
        """Cells of directions of the vertices of a hull, and of the normals of its faces."""
        return cells_of(self.vertices), cells_of(self.normals)

    @cached_property
    def corners(self) -> np.ndarray | None:
        """The vertices of the core (n,3) in body axes; None for a smooth core."""
        if self.kind not in VERTEX_KINDS:
            return None
        if self.kind == "hull":
            local = self.vertices
        elif self.kind == "segment":
            local = self.half * np.array([[0, 0, -1], [0, 0, 1]])
        else:
            local = self.half * SIGNS if self.kind == "box" else np.zeros((1, 3))
        corners = self.position + quaternion.rotate(self.orientation, local)
        corners.setflags(write=False)
        return corners

    def support(self, direction: np.ndarray) -> np.ndarray:
        """Return the point (3,) farthest along a unit `direction`, both in body axes."""
        d = quaternion.rotate_back(self.orientation, direction)
        if self.kind == "hull":
            core = self.vertices[np.argmax(self.vertices @ d)]
        elif self.kind == "ellipsoid":
            core = self.half**2 * d / np.linalg.norm(self.half * d)
        elif self.kind == "cylinder":
            across = np.hypot(d[0], d[1])
            rim = self.half[0] / across if across > 0 else 0.0
            core = np.array([rim * d[0], rim * d[1], np.copysign(self.half[2], d[2])])
        elif self.kind == "profile":
            found = Outline(self.outline).peaks(d[:2])
            found = found if len(found) else self.outline[:1, 1:3]
            core = np.array([*found[np.argmax(found @ d[:2])], np.copysign(self.half[2], d[2])])
        else:
            core = np.copysign(self.half, d)
        core = core + self.radius * d
        return self.position + quaternion.rotate(self.orientation, core)

    def placed(
        self, position: np.ndarray, orientation: np.ndarray, material: Material | None = None
    ) -> Piece:
        """Return the piece of a part that has this place in a body; `material` if it has none of its own."""
        return replace(
            self,
            position=position + quaternion.rotate(orientation, self.position),
            orientation=quaternion.multiply(orientation, self.orientation),
            material=self.material or material,
        )


class Shape(ABC):
    """Base class of all shapes: their pieces, and the quantities that follow from the pieces.

    Each shape also has, as fields or properties, its `volume` [m^3] and its `size` [m], the largest distance of
    a point from the mass centre.
    """

    if TYPE_CHECKING:
        volume: Any
        size: Any

    @property
    @abstractmethod
    def pieces(self) -> tuple[Piece, ...]:
        """The convex pieces of the shape."""

    @property
    def has_materials(self) -> bool:
        """Whether a part has a material of its own."""
        return False

    def inertia(self, mass: float) -> np.ndarray:
        """Return the inertia (3,3) [kg m^2] about the mass centre, for a `mass` [kg].

        Raises
        ------
        ValueError
            For a `Compound` with a given `centroid`, because then the mass distribution is unknown.
        """
        return self._inertia(checks.mass("mass", mass, zero=True))

    @abstractmethod
    def _inertia(self, mass: float) -> np.ndarray:
        """Return the inertia for a checked mass."""

    def support(self, direction: ArrayLike) -> np.ndarray:
        """Return the point (3,) of the shape [m] farthest along `direction` (3,), in body axes."""
        d = checks.unit_vector("direction", direction)
        points = np.array([piece.support(d) for piece in self.pieces])
        return points[np.argmax(points @ d)]

    @property
    def vertices(self) -> np.ndarray:
        """Vertices (n,3) [m] of a shape that is the hull of these points, rounded by a ball of `radius`."""
        pieces = self.pieces
        corners = [piece.corners for piece in pieces]
        if any(c is None for c in corners) or len({piece.radius for piece in pieces}) > 1:
            raise ValueError(
                f"{self!r} has no vertices: only Sphere, Box, Capsule and Convex are hulls of a few vertices, "
                "rounded by one ball"
            )
        return np.concatenate([c for c in corners if c is not None])
