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
    VectorOrNone,
)
from carom.scene.body_forces import SPRING, both_ends
from carom.scene.constraints import Bodies, distinct_bodies
from carom.scene.coordinates import (
    OneJoint,
    acts_along,
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
    joint : Joint or str
        The joint, or its name.
    stiffness, damping : float
        For an angle [N m/rad] and [N m s/rad], for a displacement [N/m] and [N s/m]; at least 0. Default 0.
    rest : float
        Coordinate without spring force [rad or m]; at the start the coordinate is 0. Default 0.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    table = PUSH

    stiffness: Number = fields.number(0.0, least=0.0)
    damping: Number = fields.number(0.0, least=0.0)
    rest: Number = fields.number(0.0)
    coordinate: Integer = fields.integer(0, least=0)

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        return [] if arrays.implicit else super()._rows(force, arrays)  # else a row of the solve


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


def _range(name: str, value) -> np.ndarray:
    low, high = checks.finite_array(name, value, (2,))
    if not low <= high:
        raise ValueError(f"{name} must be (least, greatest), got {checks.shown(value)}")
    return np.array([low, high])


@arguments.known
@dataclass(frozen=True, eq=False)
class Actuator(AlongJoint):
    """A motor along a joint coordinate with a control u, which `Run.ctrl` sets.

    Its force is affine in the control, in the length ``l = gear q`` and in the rate l':

        F = gain u + bias[0] + bias[1] l + bias[2] l',

    and acts along the coordinate as gear F on the child, its opposite on the parent. A position servo with
    stiffness k and damping c has gain k and bias (0, -k, -c), a velocity servo gain c and bias (0, 0, -c). The
    law is that of MuJoCo's ``general``. ``bias[1] l`` has a potential; the work of all else is in
    `ledger.loads`.

    Parameters
    ----------
    joint : Joint
    gain : float
        Force by control. Default 1: the control is the force.
    bias : (3,)
        Default 0.
    gear : float
        Default 1.
    control : float
        u until it is set, and in `simulate`. Default 0.
    control_range, force_range : (2,), optional
        Least and greatest u and F: others are replaced by the nearest of these. A law that depends on q or q'
        and has a `force_range` is called as a Python function, which takes 3 microseconds.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    gain: Number = fields.number(1.0)
    bias: Vector = fields.vector((0.0, 0.0, 0.0))
    gear: Number = fields.number(1.0)
    control: Number = fields.number(0.0)
    control_range: VectorOrNone = Value(_range, None)
    force_range: VectorOrNone = Value(_range, None)
    coordinate: Integer = fields.integer(0, least=0)

    table = PUSH

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        number = arrays.coordinate(self.joint, self.coordinate)
        row: dict[str, Any] = {"coordinate": number, "force": self.constant(self.control)}
        if self.law:
            arrays.laws[force.index] = law = Law(self)
            row["address"] = arrays.along_joint(law, force)
        elif not (arrays.implicit and self.is_damped_spring):
            row["stiffness"], row["damping"] = self.spring
        return [row]

    @property
    def is_damped_spring(self) -> bool:
        """Whether it has a spring and damper that an implicit step may take as a row."""
        return not self.law and min(self.spring) >= 0.0 and max(self.spring) > 0.0

    @property
    def law(self) -> bool:
        """Whether it is a function of q and q' that is not affine."""
        return self.force_range is not None and bool(self.bias[1:].any())

    @property
    def spring(self) -> tuple[float, float]:
        """Stiffness and damping of its force along the coordinate."""
        return -self.gear * self.gear * float(self.bias[1]), -self.gear * self.gear * float(
            self.bias[2]
        )

    def clipped(self, control: float) -> float:
        """Return the control that acts."""
        return _clipped(self.control_range, control)

    def affine(self, control, length, rate):
        """Return F, without its range, for the control that acts; numbers or arrays."""
        return self.gain * control + self.bias[0] + self.bias[1] * length + self.bias[2] * rate

    def force_at(self, control, q, rate):
        """Return the force along the coordinate, for a control that is not clipped; numbers or arrays."""
        if self.control_range is not None:
            control = np.clip(control, *self.control_range)
        force = self.affine(control, self.gear * q, self.gear * rate)
        return self.gear * (
            force if self.force_range is None else np.clip(force, *self.force_range)
        )

    def constant(self, control: float) -> float:
        """Return the part of the force along the coordinate that does not depend on it; of a law, 0."""
        force = self.gain * self.clipped(control) + float(self.bias[0])
        return 0.0 if self.law else self.gear * _clipped(self.force_range, force)


def _clipped(bounds: np.ndarray | None, value: float) -> float:
    return value if bounds is None else min(max(value, float(bounds[0])), float(bounds[1]))


class Law:
    """The force of an `Actuator` with a range, as a function of time, coordinate and rate."""

    def __init__(self, actuator: Actuator):
        d = self.actuator = actuator
        assert d.force_range is not None
        self.low, self.high = d.force_range.tolist()
        self.gear, (_, self.of_length, self.of_rate) = d.gear, d.bias.tolist()
        self.set(d.control)

    def set(self, control: float) -> None:
        """Let this control act."""
        self.rest = self.actuator.gain * self.actuator.clipped(control) + float(
            self.actuator.bias[0]
        )

    def __call__(self, t: float, q: float, rate: float) -> float:
        """Return the force along the coordinate."""
        total = self.rest + self.gear * (self.of_length * q + self.of_rate * rate)
        return self.gear * min(max(total, self.low), self.high)


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
