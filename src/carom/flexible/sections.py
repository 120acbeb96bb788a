"""Cross-sections of beams: areas and moments about axes through the centre."""

from __future__ import annotations

import math
from dataclasses import dataclass

from carom import arguments, checks
from carom.fields import Number, length
from carom.flexible.thresholds import LIGHTEST, SOFTEST

TERMS = 60  # of the series of the twist constant of a rectangle: the next is 1e-9 of the sum


@arguments.known
@dataclass(frozen=True)
class Circle:
    """A solid circle of a `radius` [m]."""

    radius: Number = length()

    @property
    def area(self) -> float:
        """Area [m^2]."""
        return math.pi * self.radius**2

    @property
    def second_moments(self) -> tuple[float, float]:
        """Second moments of area about y and about z [m^4]."""
        one = math.pi * self.radius**4 / 4.0
        return one, one

    @property
    def twist_constant(self) -> float:
        """Twist constant J [m^4]: torque = G J times the twist for each length."""
        return sum(self.second_moments)


@arguments.known
@dataclass(frozen=True)
class Tube:
    """A circular tube of an outer `radius` and a `thickness` of its wall [m]."""

    radius: Number = length()
    thickness: Number = length()

    def __post_init__(self):
        if not self.thickness < self.radius:
            raise ValueError(
                f"thickness must be below the radius {self.radius:g} m, got {self.thickness:g}; "
                "a solid one is a Circle"
            )

    @property
    def area(self) -> float:
        """Area [m^2]."""
        return math.pi * self.thickness * (2.0 * self.radius - self.thickness)

    @property
    def second_moments(self) -> tuple[float, float]:
        """Second moments of area about y and about z [m^4]."""
        inner = self.radius - self.thickness
        one = self.area * (self.radius**2 + inner**2) / 4.0
        return one, one

    @property
    def twist_constant(self) -> float:
        """Twist constant J [m^4]."""
        return sum(self.second_moments)


@arguments.known
@dataclass(frozen=True)
class Rectangle:
    """A rectangle of a `width` along y and a `height` along z [m]."""

    width: Number = length()
    height: Number = length()

    @property
    def area(self) -> float:
        """Area [m^2]."""
        return self.width * self.height

    @property
    def second_moments(self) -> tuple[float, float]:
        """Second moments of area about y and about z [m^4]."""
        b, h = self.width, self.height
        return b * h**3 / 12.0, h * b**3 / 12.0

    @property
    def twist_constant(self) -> float:
        """Twist constant J [m^4] of St. Venant's torsion (Timoshenko and Goodier, Theory of Elasticity, 109).

        J = a b^3/3 (1 - 192 b/(pi^5 a) sum over odd n of tanh(n pi a/(2 b))/n^5), a >= b.
        """
        b, a = sorted((self.width, self.height))
        total = sum(
            math.tanh(min(n * math.pi * a / (2.0 * b), 300.0)) / n**5 for n in range(1, TERMS, 2)
        )
        return a * b**3 / 3.0 * (1.0 - 192.0 * b / (math.pi**5 * a) * total)


SECTIONS = (Circle, Tube, Rectangle)
MOST_MODES = 1000  # of a beam
#: bounds of materials, far beyond all that there are: sums and squares are numbers
DENSITIES, MODULI = (LIGHTEST, 1e9), (SOFTEST, 1e18)


def material(density, young) -> tuple[float, float]:
    """Return density [kg/m^3] and Young's modulus [Pa], checked."""
    (light, heavy), (soft, hard) = DENSITIES, MODULI
    return (
        checks.number("density", density, least=light, most=heavy, unit="kg/m^3"),
        checks.number("young", young, least=soft, most=hard, unit="Pa"),
    )
