"""Coordinates of joints, and their combinations: along which forces, stops and constraints act."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias, TypeVar

import numpy as np

from carom import checks
from carom.fields import Value, keep
from carom.scene.bodies import Body, Ground
from carom.scene.joints import Joint, JointDefinition

#: how a user states a combination: for each joint or its name, or (joint, index of a coordinate), its factor
Factors: TypeAlias = Mapping[Joint | str | tuple[Joint | str, int], float]


def joint_or_name(name: str, joint) -> Any:
    """Return a joint, or its name, which is looked up when the definition is added to a scene."""
    if isinstance(joint, str):
        return checks.text(name, joint)
    definition = isinstance(joint, JointDefinition)
    hint = "; give what add_joint returned, or its name" if definition else ""
    checks.instance(name, joint, (Joint,), hint)
    return joint


def counted(joints) -> dict[tuple[int, int], int]:
    """Return the columns of coordinates whose turns or laps a run counts, by index of joint and coordinate."""
    every = ((one, k) for one in joints for k in range(len(one.definition.coordinates)))
    turning = [(one.index, k) for one, k in every if one.definition.period(k) > 0.0]
    return {key: column for column, key in enumerate(turning)}


def kind_of(joint: Joint | Combination | Length, coordinate: int | str) -> str:
    """Return "turn" or "slide", the kind of a coordinate of a joint, or of one that stops alone limit.

    A combination in which anything slides is a displacement; "" stands for joints that are only named.
    """
    if isinstance(joint, Length):
        return "turn" if isinstance(joint, BodyTurn) else "slide"
    if isinstance(joint, Combination):
        kinds = {kind_of(one, k) for one, k, _ in joint.terms}
        return "slide" if "slide" in kinds else min(kinds)
    if isinstance(coordinate, str):
        return joint.definition.limits[coordinate]
    return coordinate_kind(joint, coordinate)


def coordinate_kind(joint: Joint | str, coordinate: int, name: str = "joint") -> str:
    """Return "turn" or "slide", the kind of a joint coordinate; refuse one that the joint does not have.

    A joint that is only named has any coordinate until it is known, of the kind "".
    """
    joint = joint_or_name(name, joint)
    if isinstance(joint, str):
        checks.integer("coordinate", coordinate, least=0)
        return ""
    own = joint.definition.coordinates
    if not own:
        raise ValueError(
            f"{name} must have coordinates of its own (Revolute, Prismatic, ...), got {checks.shown(joint)}"
        )
    checks.integer("coordinate", coordinate, least=0)
    if coordinate >= len(own):
        raise ValueError(
            f"coordinate must be below {len(own)}, the number of coordinates of {joint!r}, got {coordinate}"
        )
    return own[coordinate]


def acts_along(
    joint: Joint | Combination | Length | str, coordinate: int, name: str = "joint"
) -> None:
    """Refuse a joint without this coordinate, and a rail that can be left, along which nothing acts."""
    if isinstance(joint, (Combination, Length)):
        if coordinate != 0:
            raise ValueError(
                f"coordinate must be left out with a combination, got {checks.shown(coordinate)}"
            )
        return
    coordinate_kind(joint, coordinate, name)
    if isinstance(joint, Joint) and joint.can_be_left:
        raise ValueError(
            f"{name} must be two-sided: nothing acts along a rail that can be left, got {joint!r}; its "
            "friction is that of the joint"
        )


def joint_or_combination(name: str, joint) -> Any:
    """Return a joint, its name, or the combination that a mapping from joints to factors states."""
    if isinstance(joint, Mapping):
        return Combination._of(_terms(name, joint))
    return joint if isinstance(joint, Combination) else joint_or_name(name, joint)


def _terms(name: str, factors: Factors) -> tuple[tuple[Joint, int, float], ...]:
    """Return the terms of a sum, checked."""
    if not isinstance(factors, Mapping) or not factors:
        raise ValueError(
            f"{name} must be a mapping from joints to numbers, got {checks.shown(factors)}"
        )
    terms = []
    for key, factor in factors.items():
        pair = key if isinstance(key, tuple) and len(key) == 2 else (key, 0)
        joint, coordinate = pair
        acts_along(joint, coordinate, f"each key of {name}")
        factor = checks.number(f"{name}[{joint!r}]", factor)
        if factor == 0.0:
            raise ValueError(f"{name}[{joint!r}] must not be 0, got {factor!r}")
        terms.append((joint, coordinate, factor))
    return tuple(terms)


@dataclass(frozen=True, init=False, eq=False)
class Combination:
    """A sum of joint coordinates, each times a factor: ``sum of factor_k (q_k - q_k(0))``."""

    terms: tuple[tuple[Joint, int, float], ...]  #: joint, number of its coordinate, factor

    def __init__(self, factors: Factors):
        keep(self, terms=_terms("factors", factors))

    @classmethod
    def _of(cls, terms) -> Combination:
        """Return the combination of these terms: coordinates, their numbers, factors."""
        made = object.__new__(cls)
        keep(made, terms=tuple(terms))
        return made

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The joints of its terms, or the lengths."""
        return tuple(joint for joint, _, _ in self.terms)

    @property
    def name(self) -> str:
        """How it is called in messages: ``"1 first + 2.5 second"``."""
        return " + ".join(f"{factor:g} {joint.name}" for joint, _, factor in self.terms)

    @property
    def child(self) -> Body:
        """A body that it moves."""
        return self.joints[0].child

    @property
    def parent(self) -> Body | Ground:
        """Another body that it moves, or the ground."""
        last = self.joints[-1].child
        return self.joints[0].parent if last is self.child else last

    @property
    def can_be_left(self) -> bool:
        """False: it has no rail."""
        return False


@dataclass(frozen=True, eq=False)
class Length:
    """The distance of a point of `parent` from one of `child`: a coordinate that belongs to no joint.

    Attributes
    ----------
    parent : Body or carom.GROUND
    child : Body
    anchor_parent, anchor_child : (3,) or None
        The points, in the world at the start [m]; None for the mass centre, wherever it is.
    """

    parent: Body | Ground
    child: Body
    anchor_parent: np.ndarray | None
    anchor_child: np.ndarray | None

    @property
    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        """The points of parent and child, in the world at the start."""
        pairs = (self.parent, self.anchor_parent), (self.child, self.anchor_child)
        a, b = (end.position if at is None else at for end, at in pairs)  # pyright: ignore
        return a, b

    @property
    def name(self) -> str:
        """How it is called in messages."""
        return f"{self.parent.name}-{self.child.name}"

    @property
    def index(self) -> tuple:
        """What tells it from other coordinates, in the place of the index of a joint."""
        return self.parent.index, self.child.index, *(tuple(end.tolist()) for end in self.ends)

    @property
    def joints(self) -> tuple[Joint, ...]:
        """None."""
        return ()

    @property
    def can_be_left(self) -> bool:
        """False: it has no rail."""
        return False


@dataclass(frozen=True, eq=False)
class Gap(Length):
    """The gap of a contact in coordinates of the user's own.

    Attributes
    ----------
    number : int
        Number of the contact.
    size : float
        The greatest of the changes of the gap by that of a coordinate by its size.
    """

    number: int = 0
    size: float = 1.0

    @property
    def index(self) -> tuple:
        """What tells it from other coordinates."""
        return "gap", self.number


class SystemOfScene(Protocol):
    """A system in coordinates of the user's own, as the compiled scene needs it."""

    functions: Any

    def arrays(self, drop: float) -> Any:
        """Return its arrays (`carom.model.chart`)."""


@dataclass(frozen=True, eq=False)
class Strand(Length):
    """A strand of rope between two circles, or points, with its parts of the arcs round them.

    Attributes
    ----------
    axis : (3,)
        Axis of both circles, in the world; 0 if both are points, and the strand is a `Length`.
    radii : (2,)
        Radii of the first circle and of the second [m]; below 0 if the rope goes round against the axis.
    start : float
        Its value at the start [m].
    """

    axis: np.ndarray
    radii: np.ndarray
    start: float

    @property
    def index(self) -> tuple:
        """What tells it from other coordinates."""
        return (*super().index, *self.axis.tolist(), *self.radii.tolist(), self.start)


@dataclass(frozen=True, eq=False)
class BodyTurn(Length):
    """The angle by which a body has turned about an axis that is fixed in the world: no joint measures it.

    Along it a torque acts on the body alone. The parent is the ground.

    Attributes
    ----------
    axis : (3,)
        The axis, in the world; it keeps its direction in the body, too.
    """

    axis: np.ndarray

    @property
    def name(self) -> str:
        """How it is called in messages."""
        return f"turn of {self.child.name}"

    @property
    def index(self) -> tuple:
        """What tells it from other coordinates."""
        return "turn", self.child.index, *self.axis.tolist()


@dataclass(frozen=True, init=False, eq=False)
class Wrap(Combination):
    """The length of a rope, part of which lies round guides on which it rubs, with its slip on these.

    There is one slip: between several guides nothing moves but the rope. The slip is half the difference of
    what is behind the guide and before it, less what a wheel has turned.

    Attributes
    ----------
    slip : tuple of float
        Factor of each term in the slip [m].
    strands : tuple of two int
        Numbers of the terms of the strands before the (first) guide and behind the (last) one, -1 for one that
        nothing moves.
    angles : tuple of two float
        Angles of these strands at the start [rad].
    way : int
        1 if the rope goes round the guide, the first of several, by the axis of its strands, else -1.
    arc : float
        Angle that lies on it at the start, with whole turns [rad].
    friction : float
        Coefficient of friction on it.
    others : tuple
        Way, arc and friction of each guide that follows.
    """

    slip: tuple[float, ...]
    strands: tuple[int, int]
    angles: tuple[float, float]
    way: int
    arc: float
    friction: float
    others: tuple[tuple[int, float, float], ...] = ()

    @property
    def guides(self) -> tuple[tuple[int, float, float], ...]:
        """Way, arc and friction of all guides."""
        return ((self.way, self.arc, self.friction), *self.others)


@dataclass(frozen=True, eq=False)
class Bush(Length):
    """The distance of the centre of a pin, a point of the child, from the axis of its bush, in the parent.

    Attributes
    ----------
    axis : (3,)
        Axis of the bush, in the world at the start.
    radius : float
        Radius of the pin [m].
    friction : float or Friction
        Friction of the pin in its bush.
    """

    axis: np.ndarray
    radius: float = 0.0
    friction: Any = 0.0

    @property
    def index(self) -> tuple:
        """What tells it from other coordinates."""
        return (*super().index, "across", *self.axis.tolist(), self.radius)


@dataclass(frozen=True, eq=False)
class Axial(Length):
    """The displacement of a point of the child along an axis of the parent, in a joint with clearance.

    Attributes
    ----------
    axis : (3,)
        The axis, in the world at the start.
    """

    axis: np.ndarray

    @property
    def index(self) -> tuple:
        """What tells it from other coordinates."""
        return (*super().index, "along", *self.axis.tolist())


def terms_of(joint: Joint | Combination | Length | None, coordinate: int | str):
    """Return joints, coordinates and factors of a combination, or the one coordinate of a joint, once."""
    return joint.terms if isinstance(joint, Combination) else ((joint, coordinate, 1.0),)


T = TypeVar("T", bound=Combination)


def with_joints(combination: T, member: Callable, name: str = "each joint of the definition") -> T:
    """Return a combination whose joints are parts of a scene; one that has them already as it is."""
    terms = tuple(
        (joint if isinstance(joint, Length) else member(name, joint, (Joint,)), k, factor)
        for joint, k, factor in combination.terms
    )
    if len({term[:2] for term in terms}) != len(terms):
        raise ValueError(f"{name} must be given once, got {[t[0].name for t in terms]}")
    for joint, k, _ in terms:
        acts_along(joint, k, name)
    if terms == combination.terms:
        return combination
    made = copy.copy(combination)
    keep(made, terms=terms)
    return made


#: fields for a joint, and for a joint or a combination
OneJoint: TypeAlias = Value[Joint, Joint | str]
Along: TypeAlias = Value[Any, Any]
