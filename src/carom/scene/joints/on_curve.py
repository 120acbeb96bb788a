"""Joints between a point of one body and a curve of the other: rails, wires, slots."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from carom import arguments, checks, fields
from carom.fields import Value, VectorOrNone, Word
from carom.scene.curves import Curve
from carom.scene.friction import friction as friction_or_law
from carom.scene.joints.definition import JointDefinition
from carom.scene.materials import IMPACT_LAWS
from carom.scene.restitution import restitution as number_or_law

CurveField: TypeAlias = Value[Curve, Curve]
#: sine of the least angle of `side` to the curve, and of the greatest one of a plane curve to its plane
LEAST_SINE, PLANE = 1e-3, 1e-9


def _curve(name: str, value) -> Curve:
    hint = "; carom.curves.Spline(points) or carom.curves.Curve(function) makes one"
    checks.instance(name, value, (Curve,), hint)
    return value


@arguments.known
@dataclass(frozen=True, eq=False)
class PointOnCurve(JointDefinition):
    """A bead on a wire, a car on a rail: a point of the child stays on a curve of the parent.

    The child rotates freely. The coordinate is the arc length [m] along the curve, 0 at the point of the curve
    that is nearest to `anchor`; on a closed curve it counts laps. A run ends with `Status.LEFT_CURVE` where the
    point passes an end of an open curve, unless a stop keeps it (`Scene.add_stop`).

    Parameters
    ----------
    curve : carom.curves.Curve or Spline
        In the world at the start; it moves with the parent.
    anchor : (3,), optional
        The point of the child, on the curve at the start. Default: the mass centre of the child.
    side : (3,), optional
        Of a rail that can be left, which is a plane curve: a direction at the anchor, across the curve, towards
        the side on which the point may fly. The point stays in the plane of the curve, the rail only pushes,
        and has a contact called ``child-joint`` in results. The coordinate is that of the nearest point of the
        rail, and nothing may act along it. Default None: the point cannot leave the curve.
    restitution, friction
        e from 0 to 1 (default 0), and mu at least 0 (default 0), or their laws, of a rail that can be left.
    impact_law : {"newton", "poisson", "stronge"}
        Definition of e of a rail that can be left. Default "newton".

    Raises
    ------
    ValueError
        If `side` is along the curve or across its plane, or the curve is in no plane; if restitution or
        friction are given without `side`.
    """

    guide, turn = "curve", "ball"
    coordinates = ("slide",)
    in_trees = False

    curve: CurveField = Value(_curve)
    anchor: VectorOrNone = fields.vector(None)
    side: VectorOrNone = fields.direction(None)
    restitution: Value[Any, Any] = number_or_law(0.0)
    friction: Value[Any, Any] = friction_or_law(0.0)
    impact_law: Word = fields.word(IMPACT_LAWS, "newton")

    def __post_init__(self):
        for name in ("restitution", "friction"):
            if self.side is None and getattr(self, name) != 0.0:
                raise ValueError(
                    f"{name} must be that of a rail that can be left, with side=, got "
                    f"{getattr(self, name)} and no side"
                )

    @property
    def rows(self) -> int:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Number of constraint rows: across the curve, or across the plane of a rail that can be left."""
        return 2 if self.side is None else 1

    def across(self, anchor: np.ndarray) -> np.ndarray:
        """Return the unit normal (3,) of the plane of a rail that can be left; tangent x normal is free."""
        curve, side = self.curve, self.side
        t = curve.tangent(curve.nearest(anchor))
        normal = np.cross(side, t)
        if not np.linalg.norm(normal) > LEAST_SINE:
            raise ValueError(f"side must not be along the curve at the anchor, got {checks.shown(side)}")
        bends = np.linalg.norm(curve.ends[:, 2], axis=1)
        if curve.sharpest * curve.length > PLANE:
            at = np.argmax(bends)
            normal = np.cross(*curve.ends[at, 1:])
        normal /= np.linalg.norm(normal)
        off = np.abs(curve.ends[:, 1:] @ normal) / (1.0, max(curve.sharpest, PLANE / curve.length))
        if not np.max(off) < PLANE:
            raise ValueError(
                f"side must be left out, or the curve be in a plane, got {checks.shown(side)} and {curve!r}"
            )
        towards = np.cross(t, normal) @ side
        if not abs(towards) > LEAST_SINE:
            raise ValueError(
                f"side must not be perpendicular to the plane of the curve, got {checks.shown(side)}"
            )
        return normal if towards > 0.0 else -normal


@arguments.known
@dataclass(frozen=True, eq=False)
class CurveOnPoint(JointDefinition):
    """A slot on a pin: a curve of the child stays on a point of the parent.

    The child rotates freely. The coordinate is the arc length [m] of the point along the curve, as that of
    `PointOnCurve`, and ends of the curve are treated alike. Reactions act on the child at the point.

    Parameters
    ----------
    curve : carom.curves.Curve or Spline
        In the world at the start; it moves with the child.
    anchor : (3,)
        The point of the parent, on the curve at the start.
    """

    guide, turn = "curve", "ball"
    coordinates = ("slide",)
    in_trees = False

    curve: CurveField = Value(_curve)
    anchor: VectorOrNone = fields.vector()
