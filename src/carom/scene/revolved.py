"""Shapes of revolution about body z."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom import check
from carom.scene.values import keep


@dataclass(frozen=True)
class Capsule:
    """A solid cylinder along body z with half balls as its ends.

    Parameters
    ----------
    radius
        Of the cylinder and of both ends [m], above 0.
    length
        Of the straight part [m], above 0: the whole is ``length + 2 * radius`` long.
    """

    radius: float
    length: float

    def __post_init__(self):
        keep(self, radius=check.number("radius", self.radius, above=0, unit="m"))
        keep(self, length=check.number("length", self.length, above=0, unit="m"))

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        return math.pi * self.radius**2 * (self.length + 4 / 3 * self.radius)

    @property
    def size(self) -> float:
        """Largest distance of a point of the shape from its mass centre [m]."""
        return 0.5 * self.length + self.radius

    @property
    def vertices(self) -> np.ndarray:
        """The two ends of the straight part (2,3) [m]."""
        return np.array([[0, 0, -0.5], [0, 0, 0.5]]) * self.length

    def inertia(self, mass: float) -> np.ndarray:
        """Return the inertia (3,3) [kg m^2] about the mass centre, for a `mass` [kg]."""
        r, l = self.radius, self.length
        straight = mass * l / (l + 4 / 3 * r)
        ends = mass - straight
        along = (straight / 2 + ends * 0.4) * r**2
        across = straight * (l**2 / 12 + r**2 / 4) + ends * (0.4 * r**2 + l**2 / 4 + 3 / 8 * l * r)
        return np.diag([across, across, along])


@dataclass(frozen=True)
class Cylinder:
    """A solid cylinder of `radius` and `length` [m], each above 0, along body z."""

    radius: float
    length: float

    def __post_init__(self):
        keep(self, radius=check.number("radius", self.radius, above=0, unit="m"))
        keep(self, length=check.number("length", self.length, above=0, unit="m"))

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        return math.pi * self.radius**2 * self.length

    @property
    def size(self) -> float:
        """Largest distance of a point of the shape from its mass centre [m]."""
        return math.hypot(self.radius, 0.5 * self.length)

    @property
    def vertices(self) -> np.ndarray:
        """Refused: a cylinder is not the hull of a few points swollen by a ball."""
        raise ValueError(
            f"{self!r} cannot touch yet: so far Sphere, Box, Capsule and Convex can; "
            "use one of these (a Capsule, or a Convex of points on both rims)"
        )

    def inertia(self, mass: float) -> np.ndarray:
        """Return the inertia (3,3) [kg m^2] about the mass centre, for a `mass` [kg]."""
        r, l = self.radius, self.length
        across = l**2 / 12 + r**2 / 4
        return mass * np.diag([across, across, r**2 / 2])
