"""Forces on bodies other than gravity: springs with dampers, elastic mounts, forces and torques.

Pass a definition to `Scene.add_force`. Points are given in world coordinates at the start, and are then
fixed in their body. Vectors are given in world axes; they stay constant, or turn with the body.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.scene.bodies import Body, Ground
from carom.scene.more_forces import (
    CurveSpring,
    JointForce,
    JointFriction,
    JointInertia,
    JointSpring,
    UserForce,
)
from carom.scene.values import apart, in_scene, keep, optional_point


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Spring:
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

    stiffness: float
    anchor_parent: np.ndarray
    anchor_child: np.ndarray
    rest_length: float
    damping: float

    def __init__(
        self,
        stiffness: float,
        anchor_parent: ArrayLike,
        anchor_child: ArrayLike,
        rest_length: float | None = None,
        damping: float = 0.0,
    ):
        start, end, distance = apart(anchor_parent, anchor_child)
        if not distance > 0.0:
            raise ValueError(
                f"anchor_child must differ from anchor_parent, got {checks.shown(anchor_child)} for both"
            )
        rest = distance if rest_length is None else rest_length
        keep(
            self,
            stiffness=checks.number("stiffness", stiffness, least=0, unit="N/m"),
            anchor_parent=start,
            anchor_child=end,
            rest_length=checks.number("rest_length", rest, least=0, unit="m"),
            damping=checks.number("damping", damping, least=0, unit="N s/m"),
        )


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Torque:
    """A constant torque `vector` (3,) [N m] on the child, in world axes.

    The opposite torque acts on the parent; the ground does not move. If `follow` is True, the vector is given
    at the start and turns with the child.
    """

    vector: np.ndarray
    follow: bool

    def __init__(self, vector: ArrayLike, follow: bool = False):
        vector = checks.finite_array("vector", vector, (3,), unit="N m")
        keep(self, vector=vector, follow=checks.flag("follow", follow))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Force:
    """A constant force `vector` (3,) [N], world axes, on a point of the child.

    `anchor` (3,) is the point, in the world at the start [m]; None is the mass centre. If `follow` is True,
    the vector is given at the start and turns with the child (a thruster).
    """

    vector: np.ndarray
    anchor: np.ndarray | None
    follow: bool

    def __init__(self, vector: ArrayLike, anchor: ArrayLike | None = None, follow: bool = False):
        vector = checks.finite_array("vector", vector, (3,), unit="N")
        anchor = optional_point("anchor", anchor)
        keep(self, vector=vector, anchor=anchor, follow=checks.flag("follow", follow))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Bushing:
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

    stiffness: np.ndarray
    turn_stiffness: np.ndarray
    damping: np.ndarray
    turn_damping: np.ndarray
    axis: np.ndarray
    anchor: np.ndarray | None

    def __init__(
        self,
        stiffness: ArrayLike,
        turn_stiffness: ArrayLike = 0.0,
        damping: ArrayLike = 0.0,
        turn_damping: ArrayLike = 0.0,
        axis: ArrayLike = (0, 0, 1),
        anchor: ArrayLike | None = None,
    ):
        keep(
            self,
            stiffness=_along_across("stiffness", stiffness, "N/m"),
            turn_stiffness=_along_across("turn_stiffness", turn_stiffness, "N m/rad"),
            damping=_along_across("damping", damping, "N s/m"),
            turn_damping=_along_across("turn_damping", turn_damping, "N m s/rad"),
            axis=checks.unit_vector("axis", axis),
            anchor=optional_point("anchor", anchor),
        )


def _along_across(name: str, value: ArrayLike, unit: str) -> np.ndarray:
    """Return (along, across, across) from one number or a pair, at least 0."""
    given = checks.real_array(name, value, "() or (2,)")
    pair = checks.finite_array(
        name, np.full(2, given) if given.ndim == 0 else given, (2,), unit=unit
    )
    if np.any(pair < 0.0):
        raise ValueError(f"{name} must be at least 0, got {checks.shown(value)} [{unit}]")
    return np.array([pair[0], pair[1], pair[1]])


ForceDefinition = (
    Spring
    | Torque
    | Force
    | Bushing
    | JointSpring
    | JointForce
    | JointFriction
    | JointInertia
    | CurveSpring
    | UserForce
)
FORCES = (
    Spring, Torque, Force, Bushing, JointSpring, JointForce, JointFriction, JointInertia,
    CurveSpring, UserForce,
)  # fmt: skip


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class AppliedForce:
    """A force of a scene, from `parent` on `child`. `Scene.add_force` makes it.

    Attributes
    ----------
    index : int
        Its index in `Scene.forces`.
    name : str
    definition : Spring, Torque, Force, ... (one of `carom.forces`)
    parent : Body or carom.GROUND
    child : Body
    """

    index: int
    name: str
    definition: ForceDefinition
    parent: Body | Ground
    child: Body

    @property
    def kind(self) -> str:
        """The class name of the definition, such as ``"Spring"``."""
        return type(self.definition).__name__

    def __repr__(self) -> str:
        pair = f"{self.parent.name!r} -> {self.child.name!r}"
        return f"AppliedForce({self.name!r}, {self.kind}, {pair})"


def force_on(definition) -> tuple | None:
    """Return the joint or the bodies that a definition contains; None if it contains none."""
    if isinstance(definition, (JointSpring, JointForce, JointFriction, JointInertia)):
        return (definition.joint,)
    return definition.bodies if isinstance(definition, UserForce) else None


def make_force(index, name, definition, parent, child) -> AppliedForce:
    """Return a checked `AppliedForce`; the arguments are those of `Scene.add_force`."""
    if isinstance(definition, Force) and not isinstance(parent, Ground):
        raise ValueError(
            f"parent of a Force must be carom.GROUND, got {checks.shown(parent)}; "
            "for a force between two bodies use Spring, or two Forces"
        )
    return AppliedForce(index, name, definition, parent, child)
