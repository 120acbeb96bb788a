"""What all surfaces of curved ground have: the piece that contacts see, and which bodies may touch it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from carom.scene.pieces import Piece


@dataclass(frozen=True, eq=False)
class SurfacePiece(Piece):
    """The one piece of a surface: everything beyond it. It is not convex."""

    surface: Any = None


class SurfaceDefinition(ABC):
    """Base class of surfaces: what contacts, files and kernels ask of them."""

    kind: ClassVar[str]  #: its name in `carom.collision.layout.SURFACE_KINDS`
    has_materials: ClassVar[bool] = False
    #: greatest length of the gradient of phi; 1 where phi is the distance from the surface
    steepest: float = 1.0

    @property
    @abstractmethod
    def size(self) -> float:
        """A length of the surface [m], of which round-off is a part."""

    @property
    @abstractmethod
    def lengths(self) -> tuple[float, ...]:
        """Up to three numbers of its kind."""

    @property
    @abstractmethod
    def bend(self) -> float:
        """Greatest curvature with the centre in free space [1/m]; inf for a point or an edge."""

    @property
    def numbers(self) -> np.ndarray:
        """Further numbers (L,) of its kind."""
        return np.zeros(0)

    def write(self, row) -> None:  # noqa: B027
        """Write to the row that kernels read what a kind has beside lengths and numbers: nothing."""

    def profile(self, far: float, n: int) -> Any:
        """Return the outline of a surface of revolution about z for pictures; None if it is none.

        It is a list of (r, z) [m], up to the distance `far` where the surface has no end, the number of sides
        of a circle, which is `n`, and True if the outline is closed.
        """
        return None

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """One piece: the solid beyond the surface."""
        return (SurfacePiece("implicit", extent=self.size, surface=self),)

    def refusal(self, piece: Piece) -> str | None:
        """Return why a piece of a body cannot touch the surface, or None."""
        if piece.kind == "cylinder":
            return "rims have no fixed points on curved ground; give a Capsule, an Ellipsoid or a Convex"
        if piece.kind == "ellipsoid":
            most = max(piece.half) ** 2 / min(piece.half)
            what = "its greatest radius of curvature"
        else:
            most, what = piece.radius, "the radius of its rounding"
        if most > 0.0 and not most * self.bend < 1.0 and not self._admits(piece):
            return (
                f"{what}, {most:g} m, must be less than that of the surface, {1.0 / self.bend:g} m; "
                "else it touches in several places"
            )
        return None

    def _admits(self, piece: Piece) -> bool:
        """Return whether a piece may touch where the surface is too sharp for its radius."""
        return False
