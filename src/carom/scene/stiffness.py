"""How stiff a contact is: what an impact lasts, and its greatest force.

A single impact does not depend on it. Where several contacts strike together and all pairs of the scene have
Hertz's law, the moduli decide how they share the impact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from carom import arguments, checks
from carom.fields import Number, NumberOrNone, Value, number

HERTZ = 1.5  # exponent of the depth of a ball in a plane


@arguments.known
@dataclass(frozen=True)
class Stiffness:
    """A normal force ``k d^exponent`` at the depth d.

    Parameters
    ----------
    k : float
        Stiffness [N/m^exponent], above 0.
    exponent : float
        1 (default): a linear spring. 1.5: Hertz's law.
    """

    k: Number = number(above=0)
    exponent: Number = number(1.0, above=0)

    def _of(self, curvature: float | None) -> tuple[float, float]:
        """Return k [N/m^exponent] and the exponent; the curvature of the bodies does not matter."""
        return self.k, self.exponent


def _each(name: str, value, **bounds) -> Any:
    """Return a number, or one for each of two bodies."""
    if isinstance(value, (tuple, list)):
        if len(value) != 2:
            raise ValueError(
                f"{name} must be a number or two, one for each body, got {checks.shown(value)}"
            )
        return tuple(checks.number(name, one, **bounds) for one in value)
    return checks.number(name, value, **bounds)


@arguments.known
@dataclass(frozen=True)
class Hertz:
    """Hertz's law of two elastic bodies with round surfaces: ``(4/3) E* R^(1/2) d^(3/2)`` at the depth d.

    ``1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2``, and 1/R is the sum of the curvatures of both.

    Parameters
    ----------
    young : float or (float, float)
        Young's modulus E [Pa], above 0, of both bodies or of each.
    poisson : float or (float, float)
        Poisson's ratio nu, from 0 to .5. Default 0.3.
    radius : float, optional
        R [m]. Default: by the two shapes where they touch, which must be balls, ellipsoids, or one of these and
        a plane. An ellipsoid touches along an ellipse, by its two relative curvatures there.
    """

    young: Value[Any, Any] = Value(lambda name, value: _each(name, value, above=0.0, unit="Pa"))
    poisson: Value[Any, Any] = Value(
        lambda name, value: _each(name, value, least=0.0, most=0.5), 0.3
    )
    radius: NumberOrNone = number(None, above=0, unit="m")

    @property
    def modulus(self) -> float:
        """E* [Pa]."""
        young, poisson = (v if isinstance(v, tuple) else (v, v) for v in (self.young, self.poisson))
        return 1.0 / sum((1.0 - nu * nu) / E for E, nu in zip(young, poisson))

    def _of(self, curvature: float | None) -> tuple[float, float]:
        """Return k [N/m^1.5] and the exponent, for the sum of the curvatures of both bodies [1/m]."""
        if self.radius is None and not curvature:
            raise ValueError("radius of a Hertz must be given where no shapes have one, got None")
        radius = self.radius if self.radius is not None else 1.0 / cast(float, curvature)
        return 4.0 / 3.0 * self.modulus * math.sqrt(radius), HERTZ


def stiffness(name: str, value) -> float | Stiffness | Hertz:
    """Return a stiffness: a number is one relative to those of other contacts."""
    return value if isinstance(value, ABSOLUTE) else checks.number(name, value, above=0.0)


#: a stiffness in newton and metres, not one relative to those of other contacts
ABSOLUTE = (Stiffness, Hertz)


def curvature_of(first, second) -> float:
    """Return the sum of the curvatures of two parts where they touch [1/m].

    It is 0 for other pairs than two balls, or a ball and a half-space: their curvature is not one number.
    """
    total = 0.0
    for part in (first, second):
        shape: Any = getattr(part, "shape", None)
        if type(shape).__name__ == "Sphere":
            total += 1.0 / shape.radius
        elif not hasattr(part, "normal"):  # no half-space
            return 0.0
    return total


def is_point_contact(first, second) -> bool:
    """Return whether two parts touch in a point whose curvatures are known: balls, ellipsoids and planes do."""
    shapes = [type(getattr(part, "shape", None)).__name__ for part in (first, second)]
    known = ("Sphere", "Ellipsoid")
    return any(name in known for name in shapes) and all(
        name in known or hasattr(part, "normal") for name, part in zip(shapes, (first, second))
    )


def curvatures_of(shape, across, normal) -> np.ndarray:
    """Return the curvatures (2, 2) [1/m] of a ball or an ellipsoid along two tangents, where it has a normal.

    The support function h(n) = |A n| of an ellipsoid has the radii of curvature as second derivatives along the
    tangents: A^2/h - (A^2 n)(A^2 n)^T/h^3.
    """
    if type(shape).__name__ == "Sphere":
        return np.eye(2) / shape.radius
    square = np.diag([shape.a, shape.b, shape.c]) ** 2
    h, along = np.sqrt(normal @ square @ normal), square @ normal
    return np.linalg.inv(across.T @ (square / h - np.outer(along, along) / h**3) @ across)
