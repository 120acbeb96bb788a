"""Motors along joint coordinates with a control: affine laws with ranges, and servos."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import arguments, checks, fields
from carom.fields import Integer, Number, NumberOrNone, Value, Vector, VectorOrNone
from carom.scene.coordinates import Along, Combination, joint_or_combination
from carom.scene.more_forces import PUSH, AlongJoint


def _range(name: str, value) -> np.ndarray:
    low, high = checks.finite_array(name, value, (2,))
    if not low <= high:
        raise ValueError(f"{name} must be (least, greatest), got {checks.shown(value)}")
    return np.array([low, high])


@dataclass(frozen=True, eq=False)
class Controlled(AlongJoint):
    """A force along a joint coordinate, affine in a control, the coordinate and its rate, within a range."""

    table = PUSH
    joint: Along = Value(joint_or_combination)
    if not TYPE_CHECKING:  # fields of those that have them, which a class variable must not become
        gear, control_range, no_load = 1.0, None, None

    if TYPE_CHECKING:

        @property
        def gear(self) -> float:
            """Length by the coordinate; 1 but of an `Actuator`."""
            ...

        @property
        def control_range(self) -> np.ndarray | None:
            """Least and greatest control; None but of an `Actuator`."""
            ...

        @property
        def no_load(self) -> float | None:
            """Rate at which its range has fallen to 0; None but of servos."""
            ...

        @property
        def gain(self) -> float:
            """Force by control."""
            ...

        @property
        def bias(self) -> np.ndarray:
            """Force without control, by the length and by its rate (3,)."""
            ...

        @property
        def control(self) -> float:
            """The control until it is set."""
            ...

        @property
        def force_range(self) -> np.ndarray | None:
            """Least and greatest force."""
            ...

    def _rows(self, force, arrays) -> list[dict[str, Any]]:
        number = arrays.coordinate(self.joint, self.coordinate)
        row: dict[str, Any] = {"coordinate": number, "force": self.constant(self.control)}
        if not (arrays.implicit and self.is_damped_spring):
            row["stiffness"], row["damping"] = self.spring
        if self.law:
            assert self.force_range is not None
            low, high = sorted(self.gear * self.force_range)
            row |= {"limited": 1, "low": low, "high": high, "no_load": self.no_load or 0.0}
        return [row]

    @property
    def has_kinks(self) -> bool:
        """Whether it has a range that its law can leave."""
        return self.law

    @property
    def is_damped_spring(self) -> bool:
        """Whether it has a spring and damper that an implicit step may take as a row."""
        if self.law or isinstance(self.joint, Combination):
            return False
        return min(self.spring) >= 0.0 and max(self.spring) > 0.0

    @property
    def law(self) -> bool:
        """Whether it is a function of q and q' that is not affine."""
        moves = bool(np.any(self.bias[1:])) or self.no_load is not None
        return self.force_range is not None and moves

    @property
    def spring(self) -> tuple[float, float]:
        """Stiffness and damping of its force along the coordinate."""
        square = self.gear * self.gear
        return -square * float(self.bias[1]), -square * float(self.bias[2])

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
        if self.force_range is None:
            return self.gear * force
        low, high = self.force_range
        if self.no_load is not None:
            low, high = low * (1.0 + rate / self.no_load), high * (1.0 - rate / self.no_load)
        return self.gear * np.clip(force, low, high)

    def constant(self, control: float) -> float:
        """Return the part of the force along the coordinate that does not depend on it."""
        force = self.gain * self.clipped(control) + float(self.bias[0])
        return self.gear * (force if self.law else _clipped(self.force_range, force))


def _clipped(bounds: np.ndarray | None, value: float) -> float:
    return value if bounds is None else min(max(value, float(bounds[0])), float(bounds[1]))


@arguments.known
@dataclass(frozen=True, eq=False)
class Actuator(Controlled):
    """A motor along a joint coordinate with a control u, which `Run.ctrl` sets.

    Its force is affine in the control, in the length ``l = gear q`` and in the rate l':

        F = gain u + bias[0] + bias[1] l + bias[2] l',

    and acts along the coordinate as gear F on the child, its opposite on the parent. The law is that of
    MuJoCo's ``general``; `PositionServo` and `VelocityServo` state two of them by their own numbers.
    ``bias[1] l`` has a potential where there is no `force_range`; the work of all else is in `ledger.loads`.

    Parameters
    ----------
    joint : Joint, str or mapping
        The joint, or its name; or a mapping from joints to factors, which states a sum of their coordinates.
    gain : float
        Force by control. Default 1: the control is the force.
    bias : (3,)
        Default 0.
    gear : float
        Default 1.
    control : float
        u until it is set, and in `simulate`. Default 0.
    control_range, force_range : (2,), optional
        Least and greatest u and F: others are replaced by the nearest of these.
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


@dataclass(frozen=True, eq=False)
class Servo(Controlled):
    """A controlled force towards a goal, with a limit that may fall with the speed."""

    if TYPE_CHECKING:

        @property
        def target(self) -> float:
            """The goal."""
            ...

        @property
        def limit(self) -> float | None:
            """The greatest force."""
            ...

    def __post_init__(self):
        super().__post_init__()
        if self.no_load is not None and self.limit is None:
            raise ValueError(f"limit must be given with no_load, got None and {self.no_load:g}")

    @property
    def control(self) -> float:  # pyright: ignore[reportIncompatibleMethodOverride]
        """The control until it is set: the target."""
        return self.target

    @property
    def force_range(self) -> np.ndarray | None:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Least and greatest force at rest."""
        return None if self.limit is None else np.array([-self.limit, self.limit])


@arguments.known
@dataclass(frozen=True, eq=False)
class PositionServo(Servo):
    """A motor that holds a joint coordinate near a target, as a spring and damper with a limit.

        F = kp (target - q) - kd q',    -limit <= F <= limit,

    and with `no_load` a limit that falls with the speed, as of a motor on a battery:
    from -limit (1 + q'/no_load) to limit (1 - q'/no_load). `Run.ctrl` sets the target. Without a limit a servo
    is a row of the steps of ``method="implicit"``, so it may be stiff, and has a potential; all other work is
    in `ledger.loads`. (`constraints.Driver` and `forces.Drive` give a motion exactly, up to a limit.)

    Parameters
    ----------
    joint : Joint, str or mapping
        The joint, or its name; or a mapping from joints to factors, which states a sum of their coordinates.
    kp : float
        Stiffness [N/m or N m/rad], at least 0.
    kd : float
        Damping [N s/m or N m s/rad], at least 0. Default 0.
    limit : float, optional
        Greatest force [N] or torque [N m], above 0.
    target : float
        Coordinate [m or rad] to which it goes, until it is set. Default 0.
    no_load : float, optional
        Rate [m/s or rad/s], above 0, at which it has no force left in the direction of motion.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    kp: Number = fields.number(least=0.0)
    kd: Number = fields.number(0.0, least=0.0)
    limit: NumberOrNone = fields.number(None, above=0.0)
    target: Number = fields.number(0.0)
    no_load: NumberOrNone = fields.number(None, above=0.0)
    coordinate: Integer = fields.integer(0, least=0)

    @property
    def gain(self) -> float:
        """Force by target."""
        return self.kp

    @property
    def bias(self) -> np.ndarray:
        """Force at the target 0, by the coordinate and by its rate (3,)."""
        return np.array([0.0, -self.kp, -self.kd])


@arguments.known
@dataclass(frozen=True, eq=False)
class VelocityServo(Servo):
    """A motor that holds the rate of a joint coordinate near a target, with a limit.

        F = kv (target - q'),    -limit <= F <= limit,

    with `no_load`, `Run.ctrl` and the ledger as of `PositionServo`.

    Parameters
    ----------
    joint : Joint, str or mapping
        The joint, or its name; or a mapping from joints to factors, which states a sum of their coordinates.
    kv : float
        Force by rate [N s/m or N m s/rad], at least 0.
    limit : float, optional
        Greatest force [N] or torque [N m], above 0.
    target : float
        Rate [m/s or rad/s] to which it goes, until it is set. Default 0.
    no_load : float, optional
        Rate [m/s or rad/s], above 0, at which it has no force left in the direction of motion.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    kv: Number = fields.number(least=0.0)
    limit: NumberOrNone = fields.number(None, above=0.0)
    target: Number = fields.number(0.0)
    no_load: NumberOrNone = fields.number(None, above=0.0)
    coordinate: Integer = fields.integer(0, least=0)

    @property
    def gain(self) -> float:
        """Force by target."""
        return self.kv

    @property
    def bias(self) -> np.ndarray:
        """Force at the target 0, by the coordinate and by its rate (3,)."""
        return np.array([0.0, 0.0, -self.kv])
