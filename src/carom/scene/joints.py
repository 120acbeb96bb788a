"""Joints, placed in the world as the system stands at the start.

Give a definition to `Scene.add_joint` with the two bodies it joins. Anchors are points [m], axes
directions (made unit vectors; the zero vector is refused), all in world axes. Where an anchor
may be left out, it is the mass centre of the child.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import listed, number, shown, unit_quaternion, unit_vector
from carom.scene.bodies import Body, Ground
from carom.scene.values import apart, keep, optional_point, point

PARALLEL = 1e-9  # sine of the angle between two directions below which they count as parallel
ACROSS = 1e-9  # cosine below which they count as perpendicular


@dataclass(frozen=True, init=False, eq=False)
class Revolute:
    """A hinge: the bodies share the point `anchor` (3,) and turn about `axis` (3,) alone."""

    anchor: np.ndarray
    axis: np.ndarray

    def __init__(self, anchor: ArrayLike, axis: ArrayLike):
        keep(self, anchor=point("anchor", anchor), axis=unit_vector("axis", axis))


@dataclass(frozen=True, init=False, eq=False)
class Spherical:
    """A ball joint: the bodies share the point `anchor` (3,) and turn freely about it."""

    anchor: np.ndarray

    def __init__(self, anchor: ArrayLike):
        keep(self, anchor=point("anchor", anchor))


@dataclass(frozen=True, init=False, eq=False)
class Fixed:
    """A weld: no relative motion. Reactions are reported at `anchor` (3,)."""

    anchor: np.ndarray | None

    def __init__(self, anchor: ArrayLike | None = None):
        keep(self, anchor=optional_point("anchor", anchor))


@dataclass(frozen=True, init=False, eq=False)
class Prismatic:
    """A slider: the child moves along `axis` (3,), fixed in the parent, without turning."""

    axis: np.ndarray
    anchor: np.ndarray | None

    def __init__(self, axis: ArrayLike, anchor: ArrayLike | None = None):
        keep(self, axis=unit_vector("axis", axis), anchor=optional_point("anchor", anchor))


@dataclass(frozen=True, init=False, eq=False)
class Cylindrical:
    """A sleeve: the child turns about and slides along the line through `anchor` (3,) along `axis` (3,)."""

    anchor: np.ndarray
    axis: np.ndarray

    def __init__(self, anchor: ArrayLike, axis: ArrayLike):
        keep(self, anchor=point("anchor", anchor), axis=unit_vector("axis", axis))


@dataclass(frozen=True, init=False, eq=False)
class Screw:
    """A nut on a thread: as it turns about the line through `anchor` along `axis`, the child slides along it.

    Parameters
    ----------
    anchor, axis : (3,)
        The line, in the world at the start.
    pitch : float
        How far the child moves along `axis` in one turn about it by the right-hand rule [m]. Negative: a
        left-hand thread. Zero is refused.
    """

    anchor: np.ndarray
    axis: np.ndarray
    pitch: float

    def __init__(self, anchor: ArrayLike, axis: ArrayLike, pitch: float):
        pitch = number("pitch", pitch, unit="m")
        if pitch == 0.0:
            raise ValueError(f"pitch must not be 0, got {shown(pitch)}; for no slide use Revolute")
        keep(self, anchor=point("anchor", anchor), axis=unit_vector("axis", axis), pitch=pitch)


@dataclass(frozen=True, init=False, eq=False)
class Universal:
    """A Cardan joint: a shared point, and two axes that stay perpendicular, one fixed in each body.

    Parameters
    ----------
    anchor : (3,)
        The shared point, in the world at the start [m].
    axis_parent, axis_child : (3,)
        Axes of the cross: of its pin in the parent and of its pin in the child. Perpendicular at the start (the
        cosine of their angle below 1e-9).
    """

    anchor: np.ndarray
    axis_parent: np.ndarray
    axis_child: np.ndarray

    def __init__(self, anchor: ArrayLike, axis_parent: ArrayLike, axis_child: ArrayLike):
        first, second = (
            unit_vector("axis_parent", axis_parent),
            unit_vector("axis_child", axis_child),
        )
        cosine = float(first @ second)
        if not abs(cosine) < ACROSS:
            raise ValueError(
                f"axis_child must be perpendicular to axis_parent, got {shown(axis_child)} and "
                f"{shown(axis_parent)}, with an angle of {np.degrees(np.arccos(cosine)):.6g} degrees"
            )
        second = unit_vector("axis_child", second - cosine * first)
        keep(self, anchor=point("anchor", anchor), axis_parent=first, axis_child=second)


@dataclass(frozen=True, init=False, eq=False)
class Planar:
    """A plate on a table: the child slides across `normal` (3,), a direction of both, and turns about it."""

    normal: np.ndarray
    anchor: np.ndarray | None

    def __init__(self, normal: ArrayLike, anchor: ArrayLike | None = None):
        keep(self, normal=unit_vector("normal", normal), anchor=optional_point("anchor", anchor))


@dataclass(frozen=True, init=False, eq=False)
class PointOnLine:
    """A bead on a wire: the point `anchor` (3,) of the child stays on a line of the parent.

    The line goes through `anchor` along `direction` (3,); the child turns freely.
    """

    anchor: np.ndarray
    direction: np.ndarray

    def __init__(self, anchor: ArrayLike, direction: ArrayLike):
        keep(self, anchor=point("anchor", anchor), direction=unit_vector("direction", direction))


@dataclass(frozen=True, init=False, eq=False)
class PointOnPlane:
    """A pin in a slot between two plates: the point `anchor` (3,) of the child stays in a plane of the parent.

    The plane goes through `anchor` across `normal` (3,), on both sides; the child turns freely.
    """

    anchor: np.ndarray
    normal: np.ndarray

    def __init__(self, anchor: ArrayLike, normal: ArrayLike):
        keep(self, anchor=point("anchor", anchor), normal=unit_vector("normal", normal))


@dataclass(frozen=True, init=False, eq=False)
class Distance:
    """A massless rod between a point of the parent and one of the child, each (3,).

    Its `length` [m] is the distance of the two at the start; zero is refused.
    """

    anchor_parent: np.ndarray
    anchor_child: np.ndarray
    length: float

    def __init__(self, anchor_parent: ArrayLike, anchor_child: ArrayLike):
        start, end, length = apart(anchor_parent, anchor_child)
        if not length > 0.0:
            raise ValueError(
                f"anchor_child must differ from anchor_parent, got {shown(anchor_child)} for both; "
                "for a shared point use Spherical"
            )
        keep(self, anchor_parent=start, anchor_child=end, length=length)


@dataclass(frozen=True, init=False, eq=False)
class KnifeEdge:
    """A blade (nonholonomic): a point of the child may not move sideways over the ground.

    Parameters
    ----------
    anchor : (3,)
        The point of the child, in the world at the start [m].
    direction : (3,)
        Of the blade; turns with the child.
    normal : (3,), default (0, 0, 1)
        Of the surface; turns with the child. Not parallel to `direction`.

    Attributes
    ----------
    lateral : (3,)
        Unit vector of ``normal x direction``, the direction without velocity.
    """

    anchor: np.ndarray
    direction: np.ndarray
    normal: np.ndarray
    lateral: np.ndarray

    def __init__(self, anchor: ArrayLike, direction: ArrayLike, normal: ArrayLike = (0, 0, 1)):
        along, up = unit_vector("direction", direction), unit_vector("normal", normal)
        across = np.cross(up, along)
        if not np.linalg.norm(across) > PARALLEL:
            raise ValueError(
                f"direction must not be parallel to normal, got {shown(direction)} and {shown(normal)}"
            )
        keep(self, anchor=point("anchor", anchor), direction=along, normal=up)
        keep(self, lateral=unit_vector("lateral", across))


@dataclass(frozen=True, init=False, eq=False)
class RollingSphere:
    """A ball that rolls on a plane of the parent without slip, and does not leave it (nonholonomic).

    Parameters
    ----------
    radius : float
        [m], above 0. The centre of the ball is the mass centre of the child.
    normal : (3,), default (0, 0, 1)
        Of the plane, towards the ball; turns with the parent. The plane touches the ball at the start.
    """

    radius: float
    normal: np.ndarray

    def __init__(self, radius: float, normal: ArrayLike = (0, 0, 1)):
        radius = number("radius", radius, above=0.0, unit="m")
        keep(self, radius=radius, normal=unit_vector("normal", normal))

    def contact(self, centre: ArrayLike) -> np.ndarray:
        """Return the point (3,) where it touches, with the centre at `centre`."""
        return point("centre", centre) - self.radius * self.normal


@dataclass(frozen=True, init=False, eq=False)
class RollingDisc:
    """A thin disc or wheel that rolls on a plane of the parent without slip (nonholonomic).

    Its lowest point has no velocity against the plane; it may lean, turn and roll. A wheel of a vehicle is
    this, with a `Revolute` to the frame.

    Parameters
    ----------
    radius : float
        [m], above 0. The centre of the disc is the mass centre of the child.
    axis : (3,)
        Of the disc, in the world at the start; turns with the child. Not parallel to `normal`.
    normal : (3,), default (0, 0, 1)
        Of the plane, towards the disc; turns with the parent. The plane touches the disc at the start.
    """

    radius: float
    axis: np.ndarray
    normal: np.ndarray

    def __init__(self, radius: float, axis: ArrayLike, normal: ArrayLike = (0, 0, 1)):
        radius = number("radius", radius, above=0.0, unit="m")
        along, up = unit_vector("axis", axis), unit_vector("normal", normal)
        if not np.linalg.norm(np.cross(along, up)) > PARALLEL:
            raise ValueError(
                f"axis must not be parallel to normal (a disc that lies flat has no lowest point), got "
                f"{shown(axis)} and {shown(normal)}"
            )
        keep(self, radius=radius, axis=along, normal=up)

    def contact(self, centre: ArrayLike) -> np.ndarray:
        """Return the point (3,) where it touches, with the centre at `centre`."""
        down = self.normal - (self.normal @ self.axis) * self.axis
        return point("centre", centre) - self.radius * down / np.linalg.norm(down)


JointDefinition = (
    Revolute | Spherical | Fixed | Prismatic | Distance | KnifeEdge
    | Cylindrical | Universal | Planar | PointOnLine | PointOnPlane | Screw
    | RollingSphere | RollingDisc
)  # fmt: skip
JOINTS = (
    Revolute, Spherical, Fixed, Prismatic, Distance, KnifeEdge,
    Cylindrical, Universal, Planar, PointOnLine, PointOnPlane, Screw,
    RollingSphere, RollingDisc,
)  # fmt: skip


@dataclass(frozen=True, eq=False, repr=False)
class Joint:
    """A joint of a scene, between `parent` and `child`. Made by `Scene.add_joint`.

    Attributes
    ----------
    index : int
        Place in `Scene.joints`.
    name : str
    definition : Revolute, Spherical, ... (one of `carom.joints`)
    parent : Body or carom.GROUND
    child : Body
    frames : None, or two pairs of arrays ((3,), (4,))
        Position and orientation of the joint's frame in the parent and in the child, in their body axes; None
        where the definition is in the world as the system stands at the start.
    """

    index: int
    name: str
    definition: JointDefinition
    parent: Body | Ground
    child: Body
    frames: tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]] | None = None

    def anchor(self) -> np.ndarray:
        """Return the anchor (3,) of the definition; where it has none that of the child, or of the frame."""
        own = getattr(self.definition, "anchor", None)
        if own is not None:
            return own
        return self.child.position if self.frames is None else np.zeros(3)

    @property
    def kind(self) -> str:
        """The class name of the definition, such as ``"Revolute"``."""
        return type(self.definition).__name__

    def __repr__(self) -> str:
        return f"Joint({self.name!r}, {self.kind}, {self.parent.name!r} -> {self.child.name!r})"


def make_joint(index, name, definition, parent, child, parent_frame, child_frame) -> Joint:
    """Return a checked `Joint`; the arguments are those of `Scene.add_joint`."""
    if isinstance(definition, KnifeEdge) and not isinstance(parent, Ground):
        raise ValueError(f"parent of a KnifeEdge must be carom.GROUND, got {shown(parent)}")
    if (parent_frame is None) != (child_frame is None):
        raise ValueError(
            f"parent_frame and child_frame must be given together, got {shown(parent_frame)} and "
            f"{shown(child_frame)}"
        )
    if parent_frame is None:
        return Joint(index, name, definition, parent, child)
    if isinstance(definition, (RollingSphere, RollingDisc)):
        raise ValueError(
            f"parent_frame must be left out of a {type(definition).__name__}, which is placed in the world, "
            f"got {shown(parent_frame)}"
        )
    frames = (frame("parent_frame", parent_frame), frame("child_frame", child_frame))
    return Joint(index, name, definition, parent, child, frames)


def frame(name: str, value) -> tuple[np.ndarray, np.ndarray]:
    """Return a frame of a body: position (3,) and unit quaternion (4,)."""
    pair = listed(name, value, "two, (position (3,), orientation (4,))")
    if len(pair) != 2:
        raise ValueError(
            f"{name} must be a pair (position (3,), orientation (4,)), got {shown(value)}"
        )
    position, orientation = pair
    position = point(f"{name} position", position)
    orientation = unit_quaternion(f"{name} orientation", orientation)
    for array in (position, orientation):
        array.setflags(write=False)
    return position, orientation
