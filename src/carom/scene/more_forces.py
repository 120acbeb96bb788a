"""Forces along joint coordinates, springs with a characteristic curve, and user-defined forces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import arguments, checks, fields
from carom.fields import (
    Function,
    FunctionOrNone,
    Integer,
    Number,
    Value,
    Vector,
)
from carom.scene.body_forces import SPRING, both_ends
from carom.scene.constraints import Bodies, distinct_bodies
from carom.scene.coordinates import (
    Along,
    Combination,
    OneJoint,
    acts_along,
    joint_or_combination,
    joint_or_name,
    kind_of,
)
from carom.scene.force_definition import ForceDefinition, ForceTable
from carom.scene.values import apart

#: a spring, damper and force along a coordinate of a joint
PUSH = ForceTable(
    "push",
    [
        ("coordinate", "i8"),
        ("stiffness", "f8"),
        ("damping", "f8"),
        ("rest", "f8"),
        ("force", "f8"),  # constant
        ("address", "i8"),  # of a function of the user's: t, (q, q') -> force; 0 for none
        ("limited", "i8"),  # 1 if the sum is at most `high` and at least `low`, 2 if it pulls only
        ("low", "f8"),
        ("high", "f8"),
        ("no_load", "f8"),  # rate at which these have fallen to 0, 0 for constant ones
    ],
    settable=("force",),
)
#: forces of a function of the user's: t, (bodies, 13) -> (bodies, 6)
USER_FORCE = ForceTable(
    "user_force",
    [
        ("address", "i8"),
        ("energy_address", "i8"),  # of their potential, 0 if they have none
        ("first", "i8"),  # range of its bodies in `Relations.named`
        ("last", "i8"),
    ],
)


@dataclass(frozen=True, eq=False)
class AlongJoint(ForceDefinition):
    """What acts along a `coordinate` of a joint."""

    joint: OneJoint = Value(joint_or_name)

    if TYPE_CHECKING:

        @property
        def coordinate(self) -> int:
            """Its number: a field of each of them, which stands last."""
            ...

    def __post_init__(self):
        acts_along(self.joint, self.coordinate)

    @property
    def value_unit(self) -> str:
        """Unit of the value along the coordinate."""
        return "N m" if kind_of(self.joint, self.coordinate) == "turn" else "N"

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        assert self.table is not None
        names = [column[0] for column in self.table.columns if hasattr(self, column[0])]
        row = {name: getattr(self, name) for name in names}
        return [{**row, "coordinate": arrays.coordinate(self.joint, self.coordinate)}]


@arguments.known
@dataclass(frozen=True, eq=False)
class JointSpring(AlongJoint):
    """A spring and damper along a coordinate of a joint: ``-stiffness (q - rest) - damping q'``.

    An angle includes whole turns (a clock spring). One coordinate may have several springs.

    Parameters
    ----------
    joint : Joint, str or mapping
        The joint, or its name; or a mapping from joints to factors, which states a sum of their coordinates
        (`Scene.add_play`). Along a sum it is explicit in all methods.
    stiffness, damping : float
        For an angle [N m/rad] and [N m s/rad], for a displacement [N/m] and [N s/m]; at least 0. Default 0.
    rest : float
        Coordinate without spring force [rad or m]; at the start the coordinate is 0. Default 0.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    table = PUSH

    joint: Along = Value(joint_or_combination)
    stiffness: Number = fields.number(0.0, least=0.0)
    damping: Number = fields.number(0.0, least=0.0)
    rest: Number = fields.number(0.0)
    coordinate: Integer = fields.integer(0, least=0)

    @property
    def is_row(self) -> bool:
        """Whether it is a row of an implicit step."""
        return not isinstance(self.joint, Combination) and self.stiffness + self.damping > 0.0

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        return [] if arrays.implicit and self.is_row else super()._rows(force, arrays)


def _number_or_function(name: str, value) -> float | Callable:
    return value if callable(value) else checks.number(name, value)


@arguments.known
@dataclass(frozen=True, eq=False)
class JointForce(AlongJoint):
    """A force or torque along a joint coordinate: it acts on the child, its opposite on the parent.

    Its work is in `ledger.loads`.

    Parameters
    ----------
    joint : Joint or str
        The joint, or its name.
    force : float or callable
        Force [N] along a displacement or torque [N m] about an angle: a number, or a function
        ``force(t, q, rate)`` of the time, the coordinate and its rate, plain Python or compiled with Numba.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    table = PUSH

    force: Value[float | Callable, float | Callable] = Value(_number_or_function)
    coordinate: Integer = fields.integer(0, least=0)

    @property
    def has_kinks(self) -> bool:
        """Whether it is a function."""
        return callable(self.force)

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        number = arrays.coordinate(self.joint, self.coordinate)
        if not callable(self.force):
            return [{"coordinate": number, "force": self.force}]
        return [{"coordinate": number, "address": arrays.along_joint(self.force, force)}]


@arguments.known
@dataclass(frozen=True, eq=False)
class JointInertia(AlongJoint):
    """Inertia along a joint coordinate, with the kinetic energy ``inertia q'^2/2``.

    It models the rotor of a motor behind a gear: the moment of inertia of the rotor times the square of the
    gear ratio (in robotics: reflected inertia, armature). It has no mass and no weight, and exerts no
    gyroscopic torque on the bodies. One coordinate may have several.

    Parameters
    ----------
    joint : Joint or str
        The joint, or its name.
    inertia : float
        [kg m^2] for an angle, [kg] for a displacement; at least 0.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    inertia: Number = fields.number(least=0.0)
    coordinate: Integer = fields.integer(0, least=0)


def _curve(name: str, given):
    """Return a piecewise polynomial: the given one, or that through the points of a table."""
    if checks.is_polynomial(given):
        return given
    table = checks.finite_array(name, given, (2, None))
    if table.shape[1] < 2 or not np.all(np.diff(table[0]) > 0.0):
        raise ValueError(
            f"{name} must have two distances or more, each above the one before, got {checks.shown(given)}"
        )
    from scipy.interpolate import PchipInterpolator

    return PchipInterpolator(table[0], table[1])


@arguments.known
@dataclass(frozen=True, eq=False)
class CurveSpring(ForceDefinition):
    """A spring between a point of the parent and a point of the child, with a given characteristic curve.

    Parameters
    ----------
    anchor_parent, anchor_child : (3,)
        The two points, in the world at the start [m]; they must differ.
    tension : (2, n) array-like or scipy.interpolate.PPoly
        Force [N] that pulls the points together, as a function of their distance [m]: two rows (distances,
        tensions), interpolated by a monotone cubic (`scipy.interpolate.PchipInterpolator`); or a piecewise
        polynomial of degree 5 at most. The first and the last piece are extrapolated.
    damping : float
        Damping coefficient [N s/m], at least 0. Default 0.
    """

    table = SPRING
    has_kinks = True
    value_unit = "N"

    anchor_parent: Vector = fields.vector()
    anchor_child: Vector = fields.vector()
    tension: Value[Any, Any] = Value(_curve)
    damping: Number = fields.number(0.0, least=0.0, unit="N s/m")

    def __post_init__(self):
        apart(self)

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        first, last = arrays.curve(self.tension)
        own = {"damping": self.damping, "piece": first, "last_piece": last}
        return [{**both_ends(self, force, arrays), **own}]


@arguments.known
@dataclass(frozen=True, eq=False)
class UserForce(ForceDefinition):
    """User-defined forces and torques on any bodies.

    Parameters
    ----------
    bodies : sequence of Body or str
        The n bodies on which the forces act, or their names, each once.
    function : callable
        ``function(t, states) -> (n, 6)``: `states` (n, 13) has position, orientation (quaternion, scalar first,
        body to world), velocity and angular velocity of each body, world axes. The result has a force [N] and a
        torque about the mass centre [N m] for each body, world axes. Plain Python, or compiled with Numba,
        which makes a run of few bodies some ten times faster.
    potential : callable, optional
        ``potential(t, states) -> float`` [J]; the forces are its negative gradient. If it is given, the energy
        of the forces is part of `potential_energy`; otherwise their work is in `ledger.loads`.
    """

    table = USER_FORCE
    has_kinks = True

    bodies: Bodies = Value(distinct_bodies)
    function: Function = fields.function()
    potential: FunctionOrNone = fields.function(None)

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        n, name = len(self.bodies), f"the force {force.name!r}"
        row = {"address": arrays.function(self.function, (n, 13), (n, 6), name)}
        if self.potential is not None:
            of_potential = f"the potential of {name}"
            row["energy_address"] = arrays.function(self.potential, (n, 13), (1,), of_potential)
        row["first"], row["last"] = arrays.list_bodies(self.bodies)
        return [row]


def has_kinks(scene) -> bool:
    """Return whether forces of a scene are functions of the user or curves: these may have kinks and jumps."""
    return scene._chart is not None or any(force.definition.has_kinks for force in scene.forces)
