"""Shapes: volume, inertia, size, and the form in which they touch.

A shape lies in body axes with its mass centre at the origin. The ones that can touch are the convex
hull of a few `vertices`, swollen by a ball of `radius`: so their gap to a half-space is the lowest
vertex less the radius.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom import check
from carom.scene.convex import Convex
from carom.scene.revolved import Capsule, Cylinder
from carom.scene.values import keep


@dataclass(frozen=True)
class Sphere:
    """A solid ball of `radius` [m], above 0."""

    radius: float

    def __post_init__(self):
        keep(self, radius=check.number("radius", self.radius, above=0, unit="m"))

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        return 4 / 3 * math.pi * self.radius**3

    @property
    def size(self) -> float:
        """Largest distance of a point of the shape from its mass centre [m]."""
        return self.radius

    @property
    def vertices(self) -> np.ndarray:
        """The centre alone (1,3) [m]."""
        return np.zeros((1, 3))

    def inertia(self, mass: float) -> np.ndarray:
        """Return the inertia (3,3) [kg m^2] about the mass centre, for a `mass` [kg]."""
        return np.eye(3) * (0.4 * mass * self.radius**2)


@dataclass(frozen=True)
class Box:
    """A solid box with full edge lengths `lx`, `ly`, `lz` [m], each above 0."""

    lx: float
    ly: float
    lz: float
    radius: ClassVar[float] = 0.0

    def __post_init__(self):
        edges = {"lx": self.lx, "ly": self.ly, "lz": self.lz}
        keep(self, **{k: check.number(k, edge, above=0, unit="m") for k, edge in edges.items()})

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        return self.lx * self.ly * self.lz

    @property
    def size(self) -> float:
        """Largest distance of a point of the shape from its mass centre [m]."""
        return 0.5 * math.hypot(self.lx, self.ly, self.lz)

    @property
    def vertices(self) -> np.ndarray:
        """The eight corners (8,3) [m]."""
        signs = np.array([(i, j, k) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
        return 0.5 * signs * np.array([self.lx, self.ly, self.lz])

    def inertia(self, mass: float) -> np.ndarray:
        """Return the inertia (3,3) [kg m^2] about the mass centre, for a `mass` [kg]."""
        x, y, z = self.lx**2, self.ly**2, self.lz**2
        return np.diag([y + z, x + z, x + y]) * (mass / 12)


Shape = Sphere | Box | Capsule | Cylinder | Convex
SHAPES = (Sphere, Box, Capsule, Cylinder, Convex)
