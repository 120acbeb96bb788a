"""Springs with dampers, elastic mounts, forces and torques: on a body, or between two."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks, fields
from carom.fields import REQUIRED, Flag, Number, Value, Vector, VectorOrNone, keep
from carom.geometry import quaternion
from carom.geometry.frames import triad
from carom.scene.force_definition import ENDS, ForceDefinition, ForceTable
from carom.scene.values import apart

SPRING = ForceTable(
    "spring",
    [
        *ENDS,
        ("stiffness", "f8"),
        ("damping", "f8"),
        ("rest_length", "f8"),
        ("piece", "i8"),  # tension as a curve of the length: range of pieces, empty if it is linear
        ("last_piece", "i8"),
    ],
    apart=False,
)
#: a force and torque on a point of a body, constant in the axes of a body or of the world
LOAD = ForceTable(
    "load",
    [
        ("body", "i8"),
        ("frame", "i8"),  # the body whose axes the vectors are in, -1 for the world
        ("anchor", "f8", 3),
        ("force", "f8", 3),
        ("torque", "f8", 3),
    ],
    apart=False,
    settable=("force", "torque"),
)
#: an elastic mount: springs and dampers along and about three axes of the parent
BUSHING = ForceTable(
    "bushing",
    [
        *ENDS,
        ("parent_frame", "f8", 4),  # from the axes of the mount to those of the body
        ("child_frame", "f8", 4),
        ("stiffness", "f8", 3),
        ("damping", "f8", 3),
        ("turn_stiffness", "f8", 3),
        ("turn_damping", "f8", 3),
    ],
    apart=False,
)


def both_ends(definition, force, arrays) -> dict[str, Any]:
    """Return the columns of both bodies and of the anchors on them."""
    return {
        "parent": force.parent.index,
        "child": force.child.index,
        "parent_anchor": arrays.point(force.parent, definition.anchor_parent),
        "child_anchor": arrays.point(force.child, definition.anchor_child),
    }


@arguments.known
@dataclass(frozen=True, eq=False)
class Spring(ForceDefinition):
    """A spring and damper between a point of the parent and a point of the child.

    It pulls the two points together with the force ``stiffness (d - rest_length) + damping d'``, where d is
    their distance and d' its rate.

    Parameters
    ----------
    stiffness
        Stiffness [N/m], at least 0.
    anchor_parent, anchor_child : (3,)
        The two points, in the world at the start [m]. They must differ, because a line between equal points
        has no direction.
    rest_length
        Length without spring force [m], at least 0. Default: the distance of the anchors at the start.
    damping
        Damping coefficient [N s/m], at least 0. Default 0.
    """

    table = SPRING
    value_unit = "N"

    stiffness: Number = fields.number(least=0, unit="N/m")
    anchor_parent: Vector = fields.vector()
    anchor_child: Vector = fields.vector()
    rest_length: Value[float, float | None] = fields.number(None, least=0, unit="m")
    damping: Number = fields.number(0.0, least=0, unit="N s/m")

    def __post_init__(self):
        distance = apart(self)
        if self.rest_length is None:
            keep(self, rest_length=distance)

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        if arrays.implicit:  # it is a row of the solve
            return []
        own = {name: getattr(self, name) for name in ("stiffness", "damping", "rest_length")}
        return [{**both_ends(self, force, arrays), **own}]


@arguments.known
@dataclass(frozen=True, eq=False)
class Torque(ForceDefinition):
    """A constant torque `vector` (3,) [N m] on the child, in world axes.

    The opposite torque acts on the parent; the ground does not move. If `follow` is True, the vector is given
    at the start and turns with the child.
    """

    table = LOAD

    vector: Vector = fields.vector(unit="N m")
    follow: Flag = fields.flag(False)

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        frame, torque = _in_axes(self, force, arrays)
        rows = [{"body": force.child.index, "frame": frame, "torque": torque}]
        if force.parent.index >= 0:
            rows.append({"body": force.parent.index, "frame": frame, "torque": -torque})
        return rows


@arguments.known
@dataclass(frozen=True, eq=False)
class Force(ForceDefinition):
    """A constant force `vector` (3,) [N], world axes, on a point of the child.

    `anchor` (3,) is the point, in the world at the start [m]; None is the mass centre. If `follow` is True,
    the vector is given at the start and turns with the child (a thruster).
    """

    table = LOAD

    vector: Vector = fields.vector(unit="N")
    anchor: VectorOrNone = fields.vector(None)
    follow: Flag = fields.flag(False)

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        frame, vector = _in_axes(self, force, arrays)
        point = arrays.point(
            force.child, force.child.position if self.anchor is None else self.anchor
        )
        return [{"body": force.child.index, "frame": frame, "anchor": point, "force": vector}]


def _in_axes(definition, force, arrays) -> tuple[int, np.ndarray]:
    """Return the body in whose axes the vector of a load is constant, -1 for the world, and the vector."""
    if not definition.follow:
        return -1, definition.vector
    return force.child.index, arrays.axes(force.child, definition.vector[:, None])[:, 0]


def _along_across(unit: str, default: Any = REQUIRED) -> Vector:
    """Return a field for (along, across, across), given as one number or a pair, at least 0."""

    def check(name: str, value: ArrayLike) -> np.ndarray:
        given = checks.real_array(name, value, "() or (2,)")
        both = np.full(2, given) if given.ndim == 0 else given
        pair = checks.finite_array(name, both, (2,), unit=unit)
        if np.any(pair < 0.0):
            raise ValueError(f"{name} must be at least 0, got {checks.shown(value)} [{unit}]")
        return pair[[0, 1, 1]]

    return Value(check, default)


@arguments.known
@dataclass(frozen=True, eq=False)
class Bushing(ForceDefinition):
    """An elastic mount between the child and the parent, without force or torque at the start.

    It resists displacement along and across an axis of the parent, and rotation about the axis and across it.
    Its potential is U = (d.K d + theta.K_t theta)/2, where d and theta are the displacement and the rotation
    vector of the child relative to the parent. Rotations must stay below half a turn.

    Parameters
    ----------
    stiffness
        Stiffness [N/m], at least 0: one number, or (along the axis, across it).
    turn_stiffness
        Rotational stiffness [N m/rad], at least 0: one number, or (about the axis, across it). Default 0.
    damping, turn_damping
        Damping coefficients [N s/m] and [N m s/rad], given in the same way. Default 0.
    axis : (3,), default (0, 0, 1)
        Axis, in the world at the start; it turns with the parent.
    anchor : (3,), optional
        Point of action, in the world at the start [m]. Default: the mass centre of the child.

    Attributes
    ----------
    stiffness, turn_stiffness, damping, turn_damping : (3,)
        Values along, or about, the axis and two directions perpendicular to it.
    """

    table = BUSHING

    stiffness: Vector = _along_across("N/m")
    turn_stiffness: Vector = _along_across("N m/rad", 0.0)
    damping: Vector = _along_across("N s/m", 0.0)
    turn_damping: Vector = _along_across("N m s/rad", 0.0)
    axis: Vector = fields.direction((0, 0, 1))
    anchor: VectorOrNone = fields.vector(None)

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        anchor = force.child.position if self.anchor is None else self.anchor
        row: dict[str, Any] = {"parent": force.parent.index, "child": force.child.index}
        for end, body in (("parent", force.parent), ("child", force.child)):
            row[f"{end}_anchor"] = arrays.point(body, anchor)
            row[f"{end}_frame"] = quaternion.from_matrix(arrays.axes(body, triad(self.axis)))
        for name in ("stiffness", "damping", "turn_stiffness", "turn_damping"):
            row[name] = getattr(self, name)
        return [row]
