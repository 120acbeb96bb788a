"""Joints between a point of one body and a curve of the other: rails, wires, slots."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from carom import arguments, checks, fields
from carom.fields import Value, VectorOrNone
from carom.scene.curves import Curve
from carom.scene.joints.definition import JointDefinition

CurveField: TypeAlias = Value[Curve, Curve]


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
    """

    guide, turn = "curve", "ball"
    coordinates = ("slide",)
    in_trees = False

    curve: CurveField = Value(_curve)
    anchor: VectorOrNone = fields.vector(None)


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
