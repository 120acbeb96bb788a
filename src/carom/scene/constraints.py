"""Constraints beyond joints: relations between joint coordinates, motors, and user-defined rows.

Pass a definition to `Scene.add_constraint`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

from carom import arguments, checks, fields
from carom.fields import Function, FunctionOrNone, Integer, NumberOrNone, Value
from carom.scene.bodies import Body
from carom.scene.coordinates import (
    Combination,
    OneJoint,
    acts_along,
    joint_or_name,
    with_joints,
)
from carom.scene.joints import Joint
from carom.scene.values import MethodsOfScene, PartOfScene, in_scene


def _constant(name: str, rate) -> float:
    """Return a constant rate; a function of time is the motion."""
    if callable(rate):
        raise ValueError(
            f"{name} must be a number, got a function; one of time is given as motion="
        )
    return checks.number(name, rate)


def distinct_bodies(name: str, bodies: Body | str | Sequence[Body | str]) -> tuple[Any, ...]:
    """Return bodies, or their names, as a tuple; refuse an empty sequence and one that is in it twice."""
    single = isinstance(bodies, (Body, str))
    listed = tuple([bodies] if single else checks.listed(name, bodies, "Body"))
    for body in listed:
        checks.instance(name, body, (Body, str))
    if not listed or len(set(listed)) != len(listed):
        raise ValueError(f"{name} must be at least one body, each once, got {checks.shown(bodies)}")
    return listed


#: a field for bodies, which may be given by name
Bodies: TypeAlias = Value[tuple[Body, ...], Body | str | Sequence[Body | str]]


@arguments.known
class Coupling(Combination):
    """A linear relation between joint coordinates: gears, racks, differentials.

    ``sum of factor_k (q_k - q_k(0)) = 0``, with q in radians or metres.

    Parameters
    ----------
    factors : mapping
        Factors of the coordinates, none of them 0. A key is a joint or its name, for its first coordinate, or a
        pair (joint, index of the coordinate).
    """


@arguments.known
class Gear(Coupling):
    """A gear between two joints: ``q_second - q_second(0) = ratio (q_first - q_first(0))``.

    Parameters
    ----------
    first, second : Joint or str
        Two joints with coordinates, or their names; the gear acts on the first coordinate of each.
    ratio : float
        Rate of the second coordinate divided by that of the first, not 0; negative for spur gears about
        parallel axes. For a joint that turns and a joint that slides (a rack) in metres per radian.
    """

    def __init__(self, first: Joint | str, second: Joint | str, ratio: float):
        ratio = checks.number("ratio", ratio)
        if ratio == 0.0:
            raise ValueError(f"ratio must not be 0, got {checks.shown(ratio)}")
        for name, joint in (("first", first), ("second", second)):
            acts_along(joint, 0, name)
        if first == second:
            raise ValueError(f"first and second must be two joints, got {first!r} for both")
        super().__init__({first: ratio, second: -1.0})


@arguments.known
@dataclass(frozen=True, eq=False)
class Driver:
    """A motor that prescribes a joint coordinate as a function of time (a rheonomic constraint).

    Give one of `rate` and `motion`. The work of the motor is in the energy ledger (`Solution.ledger.loads`),
    its force or torque in `Solution.constraint_forces`.

    Parameters
    ----------
    joint : Joint or str
        The driven joint, or its name.
    rate : float, optional
        Constant rate: ``q = q(0) + rate t`` [rad/s or m/s].
    motion : callable or scipy.interpolate.PPoly, optional
        A function ``t -> (q, q', q'')`` that returns the coordinate and its first two derivatives, plain Python
        or compiled with Numba; or a piecewise polynomial of degree 5 at most (`CubicSpline`,
        `PchipInterpolator`, ...). q is measured from the initial position of the joint, so q(0) must be 0.
    coordinate : int, default 0
        Index of the driven coordinate of the joint.
    limit : float, optional
        Greatest force [N] or torque [N m] of the motor, above 0: where the rate needs more, the limit acts
        towards it, and the joint lags. Such a driver is a force, a `carom.forces.Drive`, which
        `Scene.add_constraint` adds and returns. Default: no limit.
    """

    joint: OneJoint = Value(joint_or_name)
    rate: NumberOrNone = Value(_constant, None)
    motion: FunctionOrNone = fields.function(None)
    coordinate: Integer = fields.integer(0, least=0)
    limit: NumberOrNone = fields.number(None, above=0.0)

    def __post_init__(self):
        acts_along(self.joint, self.coordinate)
        if (self.rate is None) == (self.motion is None):
            raise ValueError(
                f"rate or motion must be given, and not both, got {self.rate} and {self.motion}"
            )


@arguments.known
@dataclass(frozen=True, eq=False)
class Rows:
    """User-defined constraint rows ``a(q, t) v = b(q, t)``, up to 6, nonholonomic or holonomic.

    Parameters
    ----------
    bodies : sequence of Body or str
        The n bodies that the rows constrain, or their names, each once.
    function : callable
        ``function(t, poses) -> (rows, 6 n + 1)``: `poses` (n, 7) has position and orientation (quaternion,
        scalar first, body to world) of each body, world axes. A row of the result has six numbers for each
        body (the factors of its velocity, then those of its angular velocity, in world axes) and then b. Plain
        Python, or compiled with Numba, which makes a run of few bodies ten times faster. It must be smooth in t
        and the poses: central differences give its change along the motion.
    rows : int
        Number of rows, 1 to 6.
    position : callable, optional
        ``position(t, poses) -> (rows,)``: the constraint functions, which must be 0; the rows are their time
        derivative. If it is given, the rows are holonomic, and positions are projected back onto it.
    """

    bodies: Bodies = Value(distinct_bodies)
    function: Function = fields.function()
    rows: Integer = fields.integer(least=1, most=6)
    position: FunctionOrNone = fields.function(None)


ConstraintDefinition = Coupling | Driver | Rows
CONSTRAINTS = (Coupling, Driver, Rows)


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class Constraint(PartOfScene):
    """A constraint of a scene. `Scene.add_constraint` makes it.

    Attributes
    ----------
    definition : Coupling, Gear, Driver or Rows (of `carom.constraints`)
    """

    definition: ConstraintDefinition

    @property
    def kind(self) -> str:
        """The class name of the definition, such as ``"Gear"``."""
        return type(self.definition).__name__

    @property
    def rows(self) -> int:
        """Number of its constraint rows."""
        return self.definition.rows if isinstance(self.definition, Rows) else 1

    @property
    def parts(self) -> tuple[Joint | Body, ...]:
        """The joints or bodies that it constrains."""
        d = self.definition
        if isinstance(d, Coupling):
            return tuple(joint for joint, _, _ in d.terms)
        return (d.joint,) if isinstance(d, Driver) else d.bodies

    def __repr__(self) -> str:
        return (
            f"Constraint({self.name!r}, {self.kind}, {', '.join(repr(p.name) for p in self.parts)})"
        )


def with_parts(definition: Any, member: Callable) -> Any:
    """Return a definition whose joints and bodies are parts of a scene; one that has them already as it is.

    Parameters
    ----------
    definition : a force or a constraint
    member : `carom.scene.registry.Registry.member` of the scene

    Raises
    ------
    ValueError
        If the scene has no part with such a name (with the nearest one), or if a part is of another scene.
    """
    if isinstance(definition, Combination):
        return with_joints(definition, member)
    own = {}
    if isinstance(getattr(definition, "joint", None), Combination):
        own["joint"] = with_joints(definition.joint, member)
    elif hasattr(definition, "joint"):
        own["joint"] = member("joint of the definition", definition.joint, (Joint,))
    elif hasattr(definition, "bodies"):
        own["bodies"] = tuple(
            member("each body of the definition", body, (Body,)) for body in definition.bodies
        )
    known = all(getattr(definition, name) == part for name, part in own.items())
    return definition if known else replace(definition, **own)


class SceneConstraints(MethodsOfScene):
    """The methods of `Scene` for constraints beyond joints."""

    @arguments.known
    def add_constraint(
        self, definition: ConstraintDefinition, *, name: str | None = None, replace: bool = False
    ) -> Any:
        """Add a constraint beyond joints: a gear, a motor, or user-defined rows.

        Parameters
        ----------
        definition
            A constraint of `carom.constraints`. Its joints and bodies, given as objects or by name, must belong
            to this scene.
        name
            Name in the scene. Default ``"constraint1"``, ``"constraint2"``, ...
        replace : bool
            True: a constraint that has this name is replaced, and what refers to it then refers to the new one.
            Default False: a name that is taken is refused.

        Returns
        -------
        Constraint
            The constraint; of a `Driver` with a limit the force, an `AppliedForce`.
        """
        checks.instance("definition", definition, CONSTRAINTS)
        if isinstance(definition, Driver) and definition.limit is not None:
            from carom.scene.joint_friction import Drive

            d = definition
            drive = Drive(d.joint, d.limit, d.coordinate, rate=d.rate, motion=d.motion)
            return self.add_force(drive, name=name, replace=replace)  # pyright: ignore
        definition = with_parts(definition, self._parts.member)
        return self._parts.make(Constraint, "constraint", name, replace, definition=definition)

    @property
    def constraints(self) -> tuple[Constraint, ...]:
        """Constraints beyond joints, in the order in which they were added."""
        return self._parts.parts(Constraint)


__getattr__ = arguments.members_of("carom.constraints", ["Coupling", "Driver", "Gear", "Rows"])


def __dir__() -> list[str]:
    return ["Constraint", "Gear", *(constraint.__name__ for constraint in CONSTRAINTS)]
