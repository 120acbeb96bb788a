"""Insides of spheres, cylinders, cones and tori: ground in closed form."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from carom import arguments, checks
from carom.fields import Number, NumberOrNone, Value, length, number
from carom.scene.pieces import Piece
from carom.scene.surface_definition import SurfaceDefinition

_optional_length: Any = partial(Value, checks.length, None)


@arguments.known
@dataclass(frozen=True)
class InsideSphere(SurfaceDefinition):
    """The inside of a sphere about the origin: a bowl, a dome.

    Parameters
    ----------
    radius : float
        [m], above 0. The solid is everything farther from the origin.
    """

    radius: Number = length()
    kind = "inside_sphere"

    @property
    def size(self) -> float:
        """A length of the surface [m]: its radius."""
        return self.radius

    @property
    def lengths(self) -> tuple[float, ...]:
        """Its radius."""
        return (self.radius,)

    def profile(self, far: float, n: int) -> Any:
        """Return its outline: half a circle."""
        angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, n // 2 + 1)
        circle = self.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        circle[[0, -1], 0] = 0.0
        return circle, n

    @property
    def bend(self) -> float:
        """Greatest curvature with the centre in free space [1/m]."""
        return 1.0 / self.radius


@arguments.known
@dataclass(frozen=True)
class InsideCylinder(SurfaceDefinition):
    """The inside of a circular cylinder about the z axis: a pipe, a well, a half-pipe.

    Parameters
    ----------
    radius : float
        [m], above 0.
    length : float or None
        Length [m] of a can: flat ends close it at z = -length/2 and length/2. Default None: it has no ends.
    """

    radius: Number = length()
    length: NumberOrNone = _optional_length()
    kind = "inside_cylinder"

    @property
    def size(self) -> float:
        """A length of the surface [m]: its radius, or half its length if that is more."""
        return max(self.radius, 0.5 * (self.length or 0.0))

    @property
    def lengths(self) -> tuple[float, ...]:
        """Its radius, and half its length, 0 for none."""
        return self.radius, 0.5 * (self.length or 0.0)

    def profile(self, far: float, n: int) -> Any:
        """Return its outline: a line, and its ends."""
        r, half = self.radius, 0.5 * self.length if self.length else far
        wall = [(r, -half), (r, half)]
        return ([(0.0, -half), *wall, (0.0, half)] if self.length else wall), n

    @property
    def bend(self) -> float:
        """Greatest curvature with the centre in free space [1/m]."""
        return 1.0 / self.radius


@arguments.known
@dataclass(frozen=True)
class InsideCone(SurfaceDefinition):
    """The inside of a circular cone about the z axis, with its apex at the origin: a funnel.

    Parameters
    ----------
    half_angle : float
        Angle [rad] between the z axis and the surface, above 0 and below pi/2. The cone opens towards +z.
    """

    half_angle: Number = number(above=0, below=math.pi / 2, unit="rad")
    kind = "inside_cone"

    @property
    def size(self) -> float:
        """A length of the surface [m]; a cone has none of its own."""
        return 1.0

    @property
    def lengths(self) -> tuple[float, ...]:
        """Sine and cosine of its half-angle."""
        return math.sin(self.half_angle), math.cos(self.half_angle)

    def profile(self, far: float, n: int) -> Any:
        """Return its outline: a line from the apex."""
        sine, cosine = self.lengths
        return [(0.0, 0.0), (far * sine, far * cosine)], n

    @property
    def bend(self) -> float:
        """Greatest curvature with the centre in free space [1/m]: that of the apex."""
        return math.inf

    def _admits(self, piece: Piece) -> bool:
        return (
            piece.kind != "ellipsoid"
        )  # a ball touches a ring of the cone, of which four points are enough


@arguments.known
@dataclass(frozen=True)
class InsideTorus(SurfaceDefinition):
    """The inside of a tube that is bent to a ring about the z axis.

    Parameters
    ----------
    radius : float
        Radius of the ring, of the centre of the tube [m], above 0.
    tube_radius : float
        Inner radius of the tube [m], above 0 and below `radius`.
    """

    radius: Number = length()
    tube_radius: Number = length()
    kind = "inside_torus"

    def __post_init__(self):
        if not self.radius > self.tube_radius:
            raise ValueError(
                f"radius must be above tube_radius, got radius={self.radius:g} m and "
                f"tube_radius={self.tube_radius:g} m"
            )

    @property
    def size(self) -> float:
        """A length of the surface [m]: its outer radius."""
        return self.radius + self.tube_radius

    @property
    def lengths(self) -> tuple[float, ...]:
        """Radius of the ring and of the tube."""
        return self.radius, self.tube_radius

    def profile(self, far: float, n: int) -> Any:
        """Return its outline: a circle, closed."""
        angle = 4.0 * np.pi / n * np.arange(n // 2)
        circle = self.tube_radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return circle + (self.radius, 0.0), 2 * n, True

    @property
    def bend(self) -> float:
        """Greatest curvature with the centre in free space [1/m]."""
        return 1.0 / self.tube_radius
