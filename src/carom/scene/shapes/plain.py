"""Shapes `Sphere`, `Box` and `Ellipsoid`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from carom import arguments
from carom.fields import Number, length
from carom.scene.pieces import Piece, Shape


@arguments.known
@dataclass(frozen=True)
class Sphere(Shape):
    """A solid ball of `radius` [m], above 0."""

    radius: Number = length()

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        return 4 / 3 * math.pi * self.radius**3

    @property
    def size(self) -> float:
        """Largest distance of a point of the shape from its mass centre [m]."""
        return self.radius

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """One piece: a point, rounded by a ball."""
        return (Piece("point", radius=self.radius, extent=self.size),)

    def _inertia(self, mass: float) -> np.ndarray:
        return np.eye(3) * (0.4 * mass * self.radius**2)


@arguments.known
@dataclass(frozen=True)
class Box(Shape):
    """A solid box, with rounded edges and corners if a radius is given.

    Parameters
    ----------
    lx, ly, lz
        Outer edge lengths [m], each above 0.
    radius
        Radius of the rounding [m], from 0 (default: sharp edges) to half of the shortest edge. Volume and
        inertia are those of the rounded solid.
    """

    lx: Number = length()
    ly: Number = length()
    lz: Number = length()
    radius: Number = length(0.0, zero=True)

    def __post_init__(self):
        least = min(("lx", "ly", "lz"), key=lambda k: getattr(self, k))
        most = getattr(self, least) / 2
        if not self.radius <= most:
            raise ValueError(
                f"radius must be finite and at least 0 and at most {most:g} [m], half of {least}, "
                f"got {self.radius}"
            )

    def __repr__(self) -> str:
        radius = f", radius={self.radius!r}" if self.radius else ""
        return f"Box(lx={self.lx!r}, ly={self.ly!r}, lz={self.lz!r}{radius})"

    @cached_property
    def half(self) -> np.ndarray:
        """Half edge lengths (3,) of the core, the box inside the rounding [m]."""
        half = 0.5 * np.array([self.lx, self.ly, self.lz]) - self.radius
        half.setflags(write=False)
        return half

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        if not self.radius:
            return self.lx * self.ly * self.lz
        return _rounded_box(self.half, self.radius)[0]

    @cached_property
    def size(self) -> float:
        """Largest distance of a point of the shape from its mass centre [m]."""
        return math.hypot(*self.half) + self.radius

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """One piece: a box, rounded by a ball; the box is a point if `radius` is half of all edges."""
        half = self.half
        kind = "box" if np.any(half > 0) else "point"
        return (Piece(kind, half, self.radius, extent=self.size),)

    def _inertia(self, mass: float) -> np.ndarray:
        if not self.radius:
            x, y, z = self.lx**2 / 12, self.ly**2 / 12, self.lz**2 / 12
        else:
            half, axes = self.half, (0, 1, 2)
            volume = self.volume
            x, y, z = (_rounded_box(np.roll(half, -i), self.radius)[1] / volume for i in axes)
        return np.diag([y + z, x + z, x + y]) * mass


@arguments.known
@dataclass(frozen=True)
class Ellipsoid(Shape):
    """A solid ellipsoid with semi-axes `a`, `b`, `c` [m] along body x, y, z, each above 0."""

    a: Number = length()
    b: Number = length()
    c: Number = length()

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        return 4 / 3 * math.pi * self.a * self.b * self.c

    @property
    def size(self) -> float:
        """Largest distance of a point of the shape from its mass centre [m]."""
        return max(self.a, self.b, self.c)

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """One piece: an ellipsoid; `inner` is its least radius of curvature, min^2 / max of the semi-axes."""
        axes = (self.a, self.b, self.c)
        inner = min(axes) ** 2 / max(axes)
        return (Piece("ellipsoid", np.array(axes), inner=inner, extent=self.size),)

    def _inertia(self, mass: float) -> np.ndarray:
        x, y, z = self.a**2, self.b**2, self.c**2
        return np.diag([y + z, x + z, x + y]) * (mass / 5)


def _rounded_box(half: np.ndarray, r: float) -> tuple[float, float]:
    """Return the volume of a box of half edges a, b, c rounded by a ball, and the integral of x^2 over it.

    The parts: core, six slabs on its faces, twelve quarters of cylinders on its edges, eight octants
    of a ball on its corners.
    """
    a, b, c = half
    pi = math.pi
    volume = 8 * a * b * c + 8 * r * (a * b + b * c + c * a)
    volume += 2 * pi * r**2 * (a + b + c) + 4 / 3 * pi * r**3
    core = 8 * a * b * c * a**2 / 3
    slabs = 8 * b * c * ((a + r) ** 3 - a**3) / 3 + 8 * r * a * (b + c) * a**2 / 3
    along = 2 * pi * r**2 * a**3 / 3
    # Across, over quarters of discs: the integral of (a + x)^2, four of them.
    across = 2 * (b + c) * (pi * r**2 * a**2 + 8 * a * r**3 / 3 + pi * r**4 / 4)
    corners = 4 / 3 * pi * r**3 * a**2 + pi * a * r**4 + 4 / 15 * pi * r**5
    return volume, core + slabs + along + across + corners
