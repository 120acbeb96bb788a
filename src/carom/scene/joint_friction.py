"""Dry friction along coordinates of joints: constant, by a law, by load; drives with a limit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import arguments, checks, fields
from carom.fields import FunctionOrNone, Integer, NumberOrNone, Value
from carom.scene.coordinates import Along, Combination, joint_or_combination, kind_of
from carom.scene.friction import friction
from carom.scene.joints import Joint, Screw
from carom.scene.more_forces import AlongJoint

#: columns of the table of frictions without a load
NO_LOAD = {"arm": 1.0, "length": 0.0, "torsion": 0.0, "shoulder": 0.0, "thread": 0.0, "steep": 1.0}


@dataclass(frozen=True, eq=False)
class DryFriction(AlongJoint):
    """What holds a joint coordinate, at rest or at a rate, up to a bound."""

    if TYPE_CHECKING:

        @property
        def bound(self) -> Any:
            """Its bound: a number, a law or None; a field of each of them."""
            ...

    @property
    def law(self) -> Any:
        """The law of its bound, or of its coefficient."""
        return self.bound

    @property
    def by_load(self) -> bool:
        """Whether its bound is a coefficient times a load."""
        return False

    @property
    def load(self) -> dict[str, float]:
        """Columns of the table of frictions that say how the reaction of the joint bounds it."""
        return NO_LOAD


@arguments.known
@dataclass(frozen=True, eq=False)
class JointFriction(DryFriction):
    """Dry (Coulomb) friction along a joint coordinate, against its motion: `bound`, or `mu` times a load.

    A joint without motion sticks exactly while the force that keeps it at rest is at most the bound. Changes
    between slip and stick are located within the step. The work of the friction is in `ledger.friction`.

    With `mu` the bound follows the reaction of the joint, with a force of the size F and a moment of the size M
    in the bearing; friction and reaction are found together at each moment:

    ====================================  ===================================================================
    pin (an angle)                        torque mu radius F; with `length`, two bearings at its ends carry
                                          F across the axis and M, and a shoulder F along it
    slide                                 force mu F; with `length`, mu times what two guides at its ends
                                          carry, so that a drawer jams that is pulled beside its middle; with
                                          `radius` also M about the axis over it
    screw                                 mu times the force of the thread, along the helix at `radius`: it
                                          locks itself where the tangent of its lead is less than mu
    rail (`joints.PointOnCurve`)          force mu F
    ====================================  ===================================================================

    Parameters
    ----------
    joint : Joint, str or mapping
        The joint, or its name; or a mapping from joints to factors, which states a sum of their coordinates: on
        joint k the friction is factor_k times that of the sum (`Scene.add_play`).
    bound : float or Friction, optional
        Friction force [N] along a displacement or torque [N m] about an angle, at least 0; or a law of it,
        whose coefficients are forces or torques, and whose speed is that of the coordinate [m/s or rad/s].
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    mu : float or Friction, optional
        Instead of `bound`, the coefficient of friction by load, or a law of it by the speed of the surfaces
        [m/s], which is `radius` times the rate of an angle.
    radius : float, optional
        With `mu`: radius [m] at which surfaces slide on each other; needed for an angle and a screw. Of a
        slide, the distance from its axis at which it is kept from turning; by default this has no friction.
    length : float, optional
        With `mu`: distance [m] of two bearings, with the anchor of the child in the middle. By default one
        bearing, which carries moments without friction.

    Notes
    -----
    An impact has no friction by load, as it has none of a constant bound. Friction of a slide acts on its axis.
    Where reactions are not unique (redundant joints), loads are those of one solution.
    """

    joint: Along = Value(joint_or_combination)
    bound: Value[Any, Any] = friction(None, axis=False)
    coordinate: Integer = fields.integer(0, least=0)
    mu: Value[Any, Any] = friction(None, axis=False)
    radius: Value[Any, Any] = fields.length(None)
    length: Value[Any, Any] = fields.length(None)

    def __post_init__(self):
        super().__post_init__()
        if (self.bound is None) == (self.mu is None):
            raise ValueError(
                "bound (a force or torque) or mu (a coefficient, by load) must be given, and not both, "
                f"got {checks.shown(self.bound)} and {checks.shown(self.mu)}"
            )
        if self.mu is None:
            for name in ("radius", "length"):
                if getattr(self, name) is not None:
                    raise ValueError(
                        f"{name} must be left out with bound: it belongs to mu, got {getattr(self, name)}"
                    )
            return
        if isinstance(self.joint, Combination):
            raise ValueError(f"mu must belong to one joint, got a sum of joints: {self.joint!r}")
        if isinstance(self.joint, Joint):
            self._check_load(self.joint)

    def _check_load(self, joint: Joint) -> None:
        """Refuse lengths that a joint lacks or does not have."""
        definition = joint.definition
        kind, screw = kind_of(joint, self.coordinate), isinstance(definition, Screw)
        if screw and self.coordinate != 0:
            raise ValueError(f"coordinate of a screw must be 0 with mu, got {self.coordinate}")
        if kind == "turn" and self.radius is None:
            raise ValueError(
                f"radius must be given with mu for an angle: that of the pin or thread [m], of {joint!r}"
            )
        if self.length is not None and (
            screw or definition.turn == "cross" or definition.guide in ("plane", "curve")
        ):
            raise ValueError(
                f"length must be left out for {joint!r}, which has one bearing, got {self.length}"
            )
        if self.radius is not None and kind == "slide" and definition.guide != "line":
            raise ValueError(
                f"radius must be left out for a displacement of {joint!r}, got {self.radius}"
            )

    @property
    def law(self) -> Any:
        """The law of its bound, or of its coefficient."""
        return self.bound if self.mu is None else self.mu

    @property
    def by_load(self) -> bool:
        """Whether its bound is a coefficient times a load."""
        return self.mu is not None

    @property
    def load(self) -> dict[str, float]:
        """Columns of the table of frictions that say how the reaction of the joint bounds it."""
        if not self.by_load:
            return NO_LOAD
        definition, turns = self.joint.definition, kind_of(self.joint, self.coordinate) == "turn"
        made = NO_LOAD | {"length": self.length or 0.0}
        if isinstance(definition, Screw):  # tan lead = displacement by a radian over the radius
            lead = math.atan(definition.scale() / self.radius)
            steep = 1.0 / math.cos(lead)
            return made | {"arm": self.radius * steep, "thread": math.sin(lead), "steep": steep}
        if turns:
            return made | {"arm": self.radius, "shoulder": 1.0}
        return made | {"torsion": 0.0 if self.radius is None else 1.0 / self.radius}


@arguments.known
@dataclass(frozen=True, eq=False)
class Drive(DryFriction):
    """A motor that drives a joint coordinate at a rate, as far as its force or torque is at most a limit.

    It is a motor that runs at the rate whatever happens, behind a clutch that slips at the limit: the joint has
    the rate exactly while less is needed for it, and else the limit acts towards the rate. Both changes are
    located within the step. The force times the rate is the power of the motor, in `ledger.loads`; what slip
    takes of it is heat, in `ledger.friction`. With ``rate=0`` it is a brake. `Scene.add_constraint` makes one
    of a `carom.constraints.Driver` with a `limit`.

    Parameters
    ----------
    joint : Joint, str or mapping
        The joint, or its name; or a mapping from joints to factors, which states a sum of their coordinates.
    bound : float or Friction
        The limit: a force [N] along a displacement or a torque [N m] about an angle, at least 0; or a law of it
        by the speed of slip (a torque-speed line).
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    rate : float, optional
        Constant rate [rad/s or m/s].
    motion : callable or scipy.interpolate.PPoly, optional
        Instead of `rate`, a motion as of a `carom.constraints.Driver`, of which the rate is taken: what slip
        has left behind is not caught up.
    """

    joint: Along = Value(joint_or_combination)
    bound: Value[Any, Any] = friction(axis=False)
    coordinate: Integer = fields.integer(0, least=0)
    rate: NumberOrNone = fields.number(None)
    motion: FunctionOrNone = fields.function(None)

    def __post_init__(self):
        super().__post_init__()
        if (self.rate is None) == (self.motion is None):
            raise ValueError(
                f"rate or motion must be given, and not both, got {self.rate} and {self.motion}"
            )
        if self.motion is not None and not isinstance(self.joint, (Joint, str)):
            raise ValueError(f"motion must be left out with a sum of joints, got {self.motion}")

    @property
    def has_kinks(self) -> bool:
        """Whether its rate is a function."""
        return self.motion is not None

    @property
    def holds(self) -> bool:
        """Whether it is a brake."""
        return self.rate == 0.0

    def rates(self, t: np.ndarray) -> np.ndarray:
        """Return its rate at times (T,)."""
        if self.motion is None:
            return np.full(len(t), self.rate)
        if checks.is_polynomial(self.motion):
            return np.asarray(self.motion.derivative()(t))  # pyright: ignore
        return np.array([self.motion(float(one))[1] for one in t])
