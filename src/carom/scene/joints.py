"""Joints, placed in the world as the system stands at the start.

Give a definition to `Scene.add_joint` with the two bodies it joins. Anchors are points [m], axes
directions (made unit vectors; the zero vector is refused), all in world axes. Where an anchor
may be left out, it is the mass centre of the child.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom.check import unit_vector
from carom.scene.bodies import Body, Ground
from carom.scene.values import keep, optional_point, point

PARALLEL = 1e-9  # sine of the angle between two directions below which they count as parallel


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
class Distance:
    """A massless rod between a point of the parent and one of the child, each (3,).

    Its `length` [m] is the distance of the two at the start; zero is refused.
    """

    anchor_parent: np.ndarray
    anchor_child: np.ndarray
    length: float

    def __init__(self, anchor_parent: ArrayLike, anchor_child: ArrayLike):
        start, end = point("anchor_parent", anchor_parent), point("anchor_child", anchor_child)
        length = float(np.linalg.norm(end - start))
        if not length > 0.0:
            raise ValueError(
                f"anchor_child must differ from anchor_parent, got {anchor_child!r} for both; "
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
                f"direction must not be parallel to normal, got {direction!r} and {normal!r}"
            )
        keep(self, anchor=point("anchor", anchor), direction=along, normal=up)
        keep(self, lateral=unit_vector("lateral", across))


JointDefinition = Revolute | Spherical | Fixed | Prismatic | Distance | KnifeEdge
JOINTS = (Revolute, Spherical, Fixed, Prismatic, Distance, KnifeEdge)


@dataclass(frozen=True, eq=False, repr=False)
class Joint:
    """A joint of a scene, between `parent` and `child`. Made by `Scene.add_joint`.

    Attributes
    ----------
    index : int
        Place in `Scene.joints`.
    name : str
    definition : Revolute, Spherical, Fixed, Prismatic, Distance or KnifeEdge
    parent : Body or carom.GROUND
    child : Body
    """

    index: int
    name: str
    definition: JointDefinition
    parent: Body | Ground
    child: Body

    @property
    def kind(self) -> str:
        """The class name of the definition, such as ``"Revolute"``."""
        return type(self.definition).__name__

    def __repr__(self) -> str:
        return f"Joint({self.name!r}, {self.kind}, {self.parent.name!r} -> {self.child.name!r})"


def make_joint(index, name, definition, parent, child) -> Joint:
    """Return a checked `Joint`; the arguments are those of `Scene.add_joint`."""
    if isinstance(definition, KnifeEdge) and not isinstance(parent, Ground):
        raise ValueError(f"parent of a KnifeEdge must be carom.GROUND, got {parent!r}")
    return Joint(index, name, definition, parent, child)
