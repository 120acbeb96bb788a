"""Forces on bodies other than gravity: springs with dampers, elastic mounts, forces and torques.

Pass a definition to `Scene.add_force`. Points are given in world coordinates at the start, and are then
fixed in their body. Vectors are given in world axes; they stay constant, or turn with the body.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks, fields
from carom.fields import REQUIRED, Flag, Number, Value, Vector, VectorOrNone, keep
from carom.scene.bodies import GROUND, Body, Ground
from carom.scene.constraints import with_parts
from carom.scene.more_forces import (
    Actuator,
    AlongJoint,
    CurveSpring,
    JointForce,
    JointFriction,
    JointInertia,
    JointSpring,
    UserForce,
)
from carom.scene.values import MethodsOfScene, PartOfScene, apart, in_scene


@arguments.known
@dataclass(frozen=True, eq=False)
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

    stiffness: Number = fields.number(least=0, unit="N/m")
    anchor_parent: Vector = fields.vector()
    anchor_child: Vector = fields.vector()
    rest_length: Value[float, float | None] = fields.number(None, least=0, unit="m")
    damping: Number = fields.number(0.0, least=0, unit="N s/m")

    def __post_init__(self):
        distance = apart(self)
        if self.rest_length is None:
            keep(self, rest_length=distance)


@arguments.known
@dataclass(frozen=True, eq=False)
class Torque:
    """A constant torque `vector` (3,) [N m] on the child, in world axes.

    The opposite torque acts on the parent; the ground does not move. If `follow` is True, the vector is given
    at the start and turns with the child.
    """

    vector: Vector = fields.vector(unit="N m")
    follow: Flag = fields.flag(False)


@arguments.known
@dataclass(frozen=True, eq=False)
class Force:
    """A constant force `vector` (3,) [N], world axes, on a point of the child.

    `anchor` (3,) is the point, in the world at the start [m]; None is the mass centre. If `follow` is True,
    the vector is given at the start and turns with the child (a thruster).
    """

    vector: Vector = fields.vector(unit="N")
    anchor: VectorOrNone = fields.vector(None)
    follow: Flag = fields.flag(False)


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

    stiffness: Vector = _along_across("N/m")
    turn_stiffness: Vector = _along_across("N m/rad", 0.0)
    damping: Vector = _along_across("N s/m", 0.0)
    turn_damping: Vector = _along_across("N m s/rad", 0.0)
    axis: Vector = fields.direction((0, 0, 1))
    anchor: VectorOrNone = fields.vector(None)


ForceDefinition = (
    Spring
    | Torque
    | Force
    | Bushing
    | JointSpring
    | JointForce
    | Actuator
    | JointFriction
    | JointInertia
    | CurveSpring
    | UserForce
)
FORCES = get_args(ForceDefinition)


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class AppliedForce(PartOfScene):
    """A force of a scene, from `parent` on `child`. `Scene.add_force` makes it.

    Attributes
    ----------
    definition : Spring, Torque, Force, ... (one of `carom.forces`)
    parent : Body or carom.GROUND
    child : Body
    """

    definition: ForceDefinition
    parent: Body | Ground
    child: Body

    def __post_init__(self):
        if isinstance(self.definition, Force) and not isinstance(self.parent, Ground):
            raise ValueError(
                f"parent of a Force must be carom.GROUND, got {checks.shown(self.parent)}; "
                "for a force between two bodies use Spring, or two Forces"
            )

    @property
    def kind(self) -> str:
        """The class name of the definition, such as ``"Spring"``."""
        return type(self.definition).__name__

    def __repr__(self) -> str:
        pair = f"{self.parent.name!r} -> {self.child.name!r}"
        return f"AppliedForce({self.name!r}, {self.kind}, {pair})"


def force_on(definition) -> tuple | None:
    """Return the joint or the bodies that a definition contains; None if it contains none."""
    if isinstance(definition, AlongJoint):
        return (definition.joint,)
    return definition.bodies if isinstance(definition, UserForce) else None


def sides(first) -> tuple[Body | Ground, Body]:
    """Return parent and child of a force on a joint or on a body."""
    return (GROUND, first) if isinstance(first, Body) else (first.parent, first.child)


class SceneForces(MethodsOfScene):
    """The methods of `Scene` for forces."""

    @arguments.known
    def add_force(
        self,
        definition: ForceDefinition,
        parent: Body | Ground | str = GROUND,
        child: Body | str | None = None,
        *,
        name: str | None = None,
        replace: bool = False,
    ) -> AppliedForce:
        """Add a force on `child`, or between `parent` and `child`.

        There are three forms: ``add_force(definition, child)``, where the ground is the parent;
        ``add_force(definition, parent, child)``; and ``add_force(definition)`` for a definition that contains
        its joint or its bodies (`JointSpring`, `JointForce`, `UserForce`).

        Parameters
        ----------
        definition
            A force of `carom.forces`.
        parent
            A body or its name, or `carom.GROUND`. If only one body is given, it is the child.
        child
            Another body, or its name.
        name
            Name in the scene. Default ``"force1"``, ``"force2"``, ...
        replace : bool
            True: a force that has this name is replaced, and what refers to it then refers to the new one.
            Default False: a name that is taken is refused.
        """
        checks.instance("definition", definition, FORCES)
        definition = with_parts(definition, self._parts.member)
        named = force_on(definition)
        if named is not None:
            if child is not None or parent is not GROUND:
                raise ValueError(
                    f"parent and child must be left out with {type(definition).__name__}, which names "
                    f"its own, got {checks.shown(parent)} and {checks.shown(child)}"
                )
            parent, child = sides(named[0])
        if child is None and isinstance(parent, (Body, str)):
            parent, child = GROUND, parent
        if child is None:
            raise TypeError(
                "child must be given: add_force(definition, body) for a force on a body, "
                "add_force(definition, parent, child) for one between two"
            )
        parent, child = self._parts.pair(parent, child)
        return self._parts.make(
            AppliedForce, "force", name, replace, definition=definition, parent=parent, child=child
        )

    @property
    def forces(self) -> tuple[AppliedForce, ...]:
        """Forces, in the order in which they were added."""
        return self._parts.parts(AppliedForce)


__getattr__ = arguments.members_of("carom.forces", [one.__name__ for one in FORCES])


def __dir__() -> list[str]:
    return ["AppliedForce", *(force.__name__ for force in FORCES)]
