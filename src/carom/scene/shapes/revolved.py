"""Shapes of revolution about body z: `Capsule`, `Cylinder` and `Disc`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from carom import arguments, fields
from carom.fields import Number
from carom.scene.pieces import Piece, Shape


@arguments.known
@dataclass(frozen=True)
class Capsule(Shape):
    """A solid cylinder along body z with hemispherical ends.

    Parameters
    ----------
    radius
        Radius of the cylinder and of both ends [m], above 0.
    length
        Length of the straight part [m], above 0; the total length is ``length + 2 * radius``.
    """

    radius: Number = fields.length()
    length: Number = fields.length()

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        return math.pi * self.radius**2 * (self.length + 4 / 3 * self.radius)

    @property
    def size(self) -> float:
        """Largest distance of a point of the shape from its mass centre [m]."""
        return 0.5 * self.length + self.radius

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """One piece: a segment, rounded by a ball."""
        half = np.array([0.0, 0.0, 0.5 * self.length])
        return (Piece("segment", half, self.radius, extent=self.size),)

    def _inertia(self, mass: float) -> np.ndarray:
        r, l = self.radius, self.length
        straight = mass * l / (l + 4 / 3 * r)
        ends = mass - straight
        along = (straight / 2 + ends * 0.4) * r**2
        across = straight * (l**2 / 12 + r**2 / 4) + ends * (0.4 * r**2 + l**2 / 4 + 3 / 8 * l * r)
        return np.diag([across, across, along])


@arguments.known
@dataclass(frozen=True)
class Cylinder(Shape):
    """A solid cylinder of `radius` and `length` [m], each above 0, along body z."""

    radius: Number = fields.length()
    length: Number = fields.length()

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        return math.pi * self.radius**2 * self.length

    @property
    def size(self) -> float:
        """Largest distance of a point of the shape from its mass centre [m]."""
        return math.hypot(self.radius, 0.5 * self.length)

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """One piece: a cylinder with sharp rims."""
        half = np.array([self.radius, self.radius, 0.5 * self.length])
        return (Piece("cylinder", half, extent=self.size),)

    def _inertia(self, mass: float) -> np.ndarray:
        r, l = self.radius, self.length
        across = l**2 / 12 + r**2 / 4
        return mass * np.diag([across, across, r**2 / 2])


@arguments.known
@dataclass(frozen=True)
class Disc(Shape):
    """A flat disc or ring without thickness, with its axis along body z: a coin, a hoop.

    For contact it is a full disc with a sharp rim: bodies cannot pass through the hole of a ring.

    Parameters
    ----------
    radius
        Outer radius [m], above 0.
    inner_radius
        Radius of the hole [m], from 0 (default: a full disc) to `radius` (a hoop). Only the inertia depends on
        it: m (R^2 + r^2) / 2 about z, half of that about x and y.
    """

    radius: Number = fields.length()
    inner_radius: Number = fields.length(0.0, zero=True)
    volume: ClassVar[float] = 0.0  # [m^3]

    def __post_init__(self):
        if not self.inner_radius <= self.radius:
            raise ValueError(
                f"inner_radius must be finite and at least 0 and at most {self.radius:g} [m], the radius, "
                f"got {self.inner_radius}"
            )

    @property
    def size(self) -> float:
        """Largest distance of a point of the shape from its mass centre [m]."""
        return self.radius

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """One piece: a cylinder of length 0."""
        return (Piece("cylinder", np.array([self.radius, self.radius, 0.0]), extent=self.size),)

    def _inertia(self, mass: float) -> np.ndarray:
        across = mass * (self.radius**2 + self.inner_radius**2) / 4
        return np.diag([across, across, 2 * across])
