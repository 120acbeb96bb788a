"""Joints between a point of one body and a curve of the other: rails, wires, slots."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, TypeAlias

import numpy as np

from carom import arguments, checks, fields
from carom.fields import Value, VectorOrNone, Word
from carom.scene.curves import Curve
from carom.scene.friction import friction as friction_or_law
from carom.scene.joints.definition import JointDefinition
from carom.scene.materials import IMPACT_LAWS
from carom.scene.restitution import restitution as number_or_law

CurveField: TypeAlias = Value[Curve, Curve]
#: sine of the least angle of the free side to the curve, and of the greatest one of a plane curve to its plane
LEAST_SINE, PLANE = 0.02, 1e-9


def _curve(name: str, value) -> Curve:
    hint = "; carom.curves.Spline(points) or carom.curves.Curve(function) makes one"
    return checks.instance(name, value, (Curve,), hint)


@dataclass(frozen=True, eq=False)
class OnCurve(JointDefinition):
    """A joint of a point of one body and a curve of the other, which turn freely."""

    guide, turn = "curve", "ball"
    coordinates = ("slide",)
    in_trees = False

    curve: CurveField = Value(_curve)
    side: ClassVar[Any] = None

    def period(self, coordinate: int) -> float:
        """Return the length of a closed curve [m], after which all is as before; 0 for an open one."""
        return self.curve.length if self.curve.closed else 0.0

    def foot(self, point: np.ndarray) -> float:
        """Return the arc length of the foot of a point (3,), from which the coordinate is measured."""
        return self.curve.nearest(point)


@arguments.known
@dataclass(frozen=True, eq=False)
class PointOnCurve(OnCurve):
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
        Of a rail that can be left: a direction across it, towards the side on which the point may fly. The rail
        only pushes; its contact is called ``child-joint`` in results. A plane curve has the free side on that
        side of it to which `side` points at the anchor, and the point flies in its plane. A curve in space has
        it towards `side` everywhere, and the point flies above the curve, seen along `side`. Nothing may act
        along the coordinate. Default None: the point cannot leave the curve.
    restitution, friction
        e from 0 to 1 (default 0), and mu at least 0 (default 0), or their laws, of a rail that can be left.
    impact_law : {"newton", "poisson", "stronge", "moreau"}
        Definition of e of a rail that can be left. Default "newton".

    Raises
    ------
    ValueError
        If `side` is along the curve, or across its plane; if restitution or friction are given without `side`.
    """

    anchor: VectorOrNone = fields.vector(None)
    side: Value[Any, Any] = fields.direction(None)
    restitution: Value[Any, Any] = number_or_law(0.0)
    friction: Value[Any, Any] = friction_or_law(0.0, axis=False)
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

    @cached_property
    def plane(self) -> np.ndarray:
        """Unit normal (3,) of the plane of a rail that can be left, of any sign; 0 for a curve in space."""
        curve, first = self.curve, np.cross(self.side, self.curve.ends[0, 1])
        sharpest = np.argmax(np.linalg.norm(curve.ends[:, 2], axis=1))
        bends = curve.sharpest * curve.length > PLANE
        normal = np.cross(*curve.ends[sharpest, 1:]) if bends else first
        normal = normal / max(np.linalg.norm(normal), PLANE)
        off = np.abs(curve.ends[:, 1:] @ normal) / (1.0, max(curve.sharpest, PLANE / curve.length))
        return normal if np.max(off) < PLANE else np.zeros(3)

    @cached_property
    def shadow(self) -> Curve:
        """The curve in space, seen along the free side."""
        return Curve._of(self.curve.knots, self._seen(self.curve.ends), self.curve.closed)

    def _seen(self, vectors: np.ndarray) -> np.ndarray:
        return vectors - (vectors @ self.side)[..., None] * self.side

    def foot(self, point: np.ndarray) -> float:
        """Return the arc length of the foot of a point (3,), from which the coordinate is measured."""
        curve = self.curve
        if self.side is None:
            return super().foot(point)
        x, knots = curve.ends[:, 0], curve.knots
        if self.plane.any():
            s = curve.foot_from(point, knots[np.argmin(np.sum((x - point) ** 2, axis=1))], far=True)
        else:  # the highest branch below it
            near = 4.0 * np.max(np.diff(knots)) ** 2
            height, beside = (point - x) @ self.side, np.sum(self._seen(point - x) ** 2, axis=1)
            height[(beside > max(near, np.min(beside))) | (height < -math.sqrt(near))] = math.inf
            best = height if np.isfinite(height).any() else beside
            s = self.shadow.foot_from(self._seen(point), knots[np.argmin(best)])
        return s % curve.length if curve.closed else min(max(s, 0.0), curve.length)

    def across(self, anchor: np.ndarray) -> np.ndarray:
        """Return the normal (3,) of the plane of a rail that can be left, 0 for a curve in space.

        Tangent x normal is the free side.
        """
        side, normal = self.side, self.plane
        where, tangents = "the curve at the anchor", self.curve.tangent(self.foot(anchor))
        if not normal.any():
            where, tangents = "a curve in space anywhere", self.curve.ends[:, 1]
        if not np.min(np.linalg.norm(np.cross(side, tangents), axis=-1)) > LEAST_SINE:
            raise ValueError(f"side must not be along {where}, got {checks.shown(side)}")
        towards = np.cross(tangents, normal) @ side
        if normal.any() and not abs(towards) > LEAST_SINE:
            raise ValueError(
                f"side must not be perpendicular to the plane of the curve, got {checks.shown(side)}"
            )
        return normal if np.all(towards >= 0.0) else -normal

    def free(self, anchor: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Return the unit vectors (K, 3) across a rail that can be left, towards the free side."""
        tangent, across = self.curve.tangent(s), self.across(anchor)
        side = self.side - (tangent @ self.side)[..., None] * tangent
        side = np.cross(tangent, across) if across.any() else side
        return side / np.linalg.norm(side, axis=-1, keepdims=True)


@arguments.known
@dataclass(frozen=True, eq=False)
class CurveOnPoint(OnCurve):
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

    anchor: VectorOrNone = fields.vector()
