"""Forces of fluids: drag, wind, buoyancy, and the lift of a body that turns."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom import arguments, checks, fields
from carom.fields import Number, NumberOrNone, Value, Vector
from carom.scene.force_definition import ForceDefinition, ForceTable
from carom.scene.shapes.plain import Box, Sphere
from carom.scene.shapes.revolved import Capsule, Cylinder

AIR, WATER = 1.2, 1000.0  # densities [kg/m^3]

DRAG = ForceTable(
    "drag",
    [
        ("child", "i8"),
        ("factor", "f8"),  # half of density, drag coefficient and area [kg/m]
        ("flow", "f8", 3),  # velocity of the fluid,
        ("address", "i8"),  # or a function of the user's: t, position -> velocity
    ],
)
MAGNUS = ForceTable("magnus", [("child", "i8"), ("factor", "f8"), ("flow", "f8", 3)])
BUOYANCY = ForceTable(
    "buoyancy",
    [
        ("child", "i8"),
        ("density", "f8"),
        ("volume", "f8"),
        ("bounded", "i8"),  # 1 if the fluid has a surface, at a height along -g
        ("surface", "f8"),
        ("radius", "f8"),
    ],
)


def drag_coefficient(shape: Any) -> float:
    """Return a rough drag coefficient of a shape, at high Reynolds numbers."""
    known = {Sphere: 0.47, Box: 1.05, Cylinder: 0.82, Capsule: 0.5}
    return next((c for kind, c in known.items() if isinstance(shape, kind)), 1.0)


def mean_area(shape: Any) -> float | None:
    """Return the area of the shadow of a convex shape, the mean of all directions: a quarter of its surface."""
    if isinstance(shape, Sphere):
        return math.pi * shape.radius**2
    if isinstance(shape, Box):  # with round edges: Steiner's formula for the box within them
        r = shape.radius
        a, b, c = (side - 2.0 * r for side in (shape.lx, shape.ly, shape.lz))
        return 0.5 * (a * b + b * c + c * a) + 0.5 * math.pi * r * (a + b + c) + math.pi * r * r
    if isinstance(shape, (Cylinder, Capsule)):
        r, length = shape.radius, shape.length
        ends = 2.0 if isinstance(shape, Cylinder) else 4.0
        return 0.25 * math.pi * r * (2.0 * length + ends * r)
    return None


def _flow(name: str, value: Any) -> Any:
    return value if callable(value) else checks.finite_array(name, value, (3,), "m/s")


def _given(what: str, value: float | None, found: float | None, body: Any) -> float:
    """Return a value, or that of the shape of a body; refuse a body whose shape does not tell."""
    if value is not None:
        return value
    if found is None:
        raise ValueError(
            f"{what} must be given for {body.name!r}, whose shape does not tell it, got None"
        )
    return found


@dataclass(frozen=True, eq=False)
class _InFlow(ForceDefinition):
    """Quadratic drag relative to a flow."""

    table = DRAG

    def _drag(self, force: Any, arrays: Any, flow: Any) -> list[dict[str, Any]]:
        own: Any = self
        shape = force.child.shape
        area = _given("area", own.area, mean_area(shape), force.child)
        coefficient = drag_coefficient(shape) if own.coefficient is None else own.coefficient
        row = {"child": force.child.index, "factor": 0.5 * own.density * coefficient * area}
        if callable(flow):
            what = f"the flow of {force.name!r}"
            return [{**row, "address": arrays.function(flow, (3,), (3,), what)}]
        return [{**row, "flow": flow}]


@arguments.known
@dataclass(frozen=True, eq=False)
class Drag(_InFlow):
    r"""Quadratic drag of a fluid at rest on the mass centre of the child: :math:`-\tfrac12 \rho c A |v| v`.

    Parameters
    ----------
    density : float
        Density of the fluid [kg/m^3], at least 0. Default 1.2 (air).
    coefficient : float, optional
        Drag coefficient c. Default: .47 of a `Sphere`, .5 of a `Capsule`, .82 of a `Cylinder`, 1.05 of a `Box`,
        else 1: rough values for high Reynolds numbers.
    area : float, optional
        Area A [m^2]. Default: the mean shadow of the shape over all directions, a quarter of its surface
        (Cauchy); of other shapes than these four it must be given.
    """

    density: Number = fields.number(AIR, least=0, unit="kg/m^3")
    coefficient: NumberOrNone = fields.number(None, least=0)
    area: NumberOrNone = fields.number(None, least=0, unit="m^2")

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        return self._drag(force, arrays, np.zeros(3))


@arguments.known
@dataclass(frozen=True, eq=False)
class Wind(_InFlow):
    r"""Quadratic drag in a flow u: :math:`-\tfrac12 \rho c A |v - u| (v - u)` on the mass centre of the child.

    Parameters
    ----------
    velocity : (3,) or callable
        Velocity u of the fluid [m/s], world axes; or a field, ``velocity(t, position) -> (3,)``, plain Python
        or compiled with Numba.
    density, coefficient, area
        As of `Drag`.
    """

    velocity: Value[np.ndarray | Callable, Any] = Value(_flow)
    density: Number = fields.number(AIR, least=0, unit="kg/m^3")
    coefficient: NumberOrNone = fields.number(None, least=0)
    area: NumberOrNone = fields.number(None, least=0, unit="m^2")

    @property
    def has_kinks(self) -> bool:
        """Whether it is a field."""
        return callable(self.velocity)

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        return self._drag(force, arrays, self.velocity)


@arguments.known
@dataclass(frozen=True, eq=False)
class Magnus(ForceDefinition):
    r"""Lift of a ball that turns: :math:`\tfrac12 c \rho \pi r^3\, \omega \times (v - u)`.

    Parameters
    ----------
    density : float
        Density of the fluid [kg/m^3], at least 0. Default 1.2 (air).
    coefficient : float
        Factor c: the lift coefficient over r w/v. Default 1, about that of a ball with seams; 16/3 is the
        theory of an ideal fluid.
    radius : float, optional
        Radius r [m], above 0. Default: that of the `Sphere` of the child.
    velocity : (3,)
        Velocity u of the fluid [m/s], world axes. Default: at rest.
    """

    table = MAGNUS

    density: Number = fields.number(AIR, least=0, unit="kg/m^3")
    coefficient: Number = fields.number(1.0)
    radius: NumberOrNone = fields.number(None, above=0.0, unit="m")
    velocity: Vector = fields.vector((0.0, 0.0, 0.0), unit="m/s")

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        shape = force.child.shape
        own = shape.radius if isinstance(shape, Sphere) else None
        r = _given("radius", self.radius, own, force.child)
        factor = 0.5 * self.coefficient * self.density * math.pi * r**3
        return [{"child": force.child.index, "factor": factor, "flow": self.velocity}]


@arguments.known
@dataclass(frozen=True, eq=False)
class Buoyancy(ForceDefinition):
    """The weight of the fluid that the child displaces, against gravity, on its mass centre: a potential.

    Parameters
    ----------
    density : float
        Density of the fluid [kg/m^3], at least 0. Default 1000 (water).
    surface : float, optional
        Height of the surface of the fluid above the origin [m], against gravity, for a `Sphere`: what is above
        it displaces nothing. Default: the fluid is everywhere.
    volume : float, optional
        Displaced volume [m^3], at least 0. Default: that of the shape of the child.
    """

    table = BUOYANCY

    density: Number = fields.number(WATER, least=0, unit="kg/m^3")
    surface: NumberOrNone = fields.number(None, unit="m")
    volume: NumberOrNone = fields.number(None, least=0, unit="m^3")

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        body, row = force.child, {"child": force.child.index, "density": self.density}
        own = None if body.shape is None else float(body.shape.volume)
        if self.surface is None:
            return [{**row, "volume": _given("volume", self.volume, own, body)}]
        if not isinstance(body.shape, Sphere) or self.volume is not None:
            raise ValueError(
                f"surface must be left out except for a Sphere without volume=, got {body.name!r} with "
                f"{checks.shown(body.shape)}"
            )
        bounds = {"bounded": 1, "surface": self.surface, "radius": body.shape.radius}
        return [{**row, "volume": own, **bounds}]
