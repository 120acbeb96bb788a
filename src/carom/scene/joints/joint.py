"""`Joint`: a definition of a joint together with its two bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.checks import finite_array, listed, shown
from carom.fields import keep
from carom.geometry.attitude import attitude
from carom.scene.bodies import Body, Ground
from carom.scene.joints.definition import JointDefinition
from carom.scene.joints.rolling import KnifeEdge, RollingDisc, RollingSphere
from carom.scene.joints.special import Distance
from carom.scene.values import PartOfScene, in_scene


@in_scene
@dataclass(frozen=True, eq=False, repr=False)
class Joint(PartOfScene):
    """A joint of a scene, between `parent` and `child`. `Scene.add_joint` makes it.

    Attributes
    ----------
    definition : Revolute, Spherical, ... (one of `carom.joints`)
    parent : Body or carom.GROUND
    child : Body
    frames : None, or two pairs of arrays ((3,), (4,))
        Position and orientation of the frame of the joint in the parent and in the child, in their body axes;
        None if the definition is in the world at the start.
    """

    definition: JointDefinition
    parent: Body | Ground
    child: Body
    frames: tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]] | None = None

    def __post_init__(self):
        if isinstance(self.definition, KnifeEdge) and not isinstance(self.parent, Ground):
            raise ValueError(
                f"parent of a KnifeEdge must be carom.GROUND, got {shown(self.parent)}"
            )
        if isinstance(self.definition, Distance) and self.definition.limits_of_length:
            raise ValueError(
                "lower and upper must be left out of a rod that is rigid, got "
                f"{shown(self.definition.limits_of_length)}; remove it, and add one with limits"
            )
        parent, child = self.frames or (None, None)
        if (parent is None) != (child is None):
            raise ValueError(
                f"parent_frame and child_frame must be given together, got {shown(parent)} and {shown(child)}"
            )
        if parent is None:
            keep(self, frames=None)
            self._check_side()
            return
        if isinstance(self.definition, (RollingSphere, RollingDisc)):
            raise ValueError(
                f"parent_frame must be left out of a {self.kind}, which is placed in the world, "
                f"got {shown(parent)}"
            )
        keep(self, frames=(frame("parent_frame", parent), frame("child_frame", child)))
        self._check_side()

    def _check_side(self) -> None:
        """Refuse a rail that can be left without a free side at the anchor."""
        if self.can_be_left:
            self.definition.across(self.anchor())  # pyright: ignore[reportAttributeAccessIssue]

    def anchor(self) -> np.ndarray:
        """Return the anchor (3,): of the definition, or the child's mass centre, or the origin of the frame."""
        own = getattr(self.definition, "anchor", None)
        if own is not None:
            return own
        return self.child.position if self.frames is None else np.zeros(3)

    @property
    def can_be_left(self) -> bool:
        """Whether it is a rail with a free side."""
        return getattr(self.definition, "side", None) is not None

    @property
    def kind(self) -> str:
        """The class name of the definition, such as ``"Revolute"``."""
        return type(self.definition).__name__

    def __repr__(self) -> str:
        return f"Joint({self.name!r}, {self.kind}, {self.parent.name!r} -> {self.child.name!r})"


def frame(name: str, value) -> tuple[np.ndarray, np.ndarray]:
    """Return a frame of a body: position (3,) and unit quaternion (4,)."""
    pair = listed(name, value, "two, (position (3,), orientation (4,))")
    if len(pair) != 2:
        raise ValueError(
            f"{name} must be a pair (position (3,), orientation (4,)), got {shown(value)}"
        )
    position, orientation = pair
    position = finite_array(f"{name} position", position, (3,))
    orientation = attitude(f"{name} orientation", orientation)
    for array in (position, orientation):
        array.setflags(write=False)
    return position, orientation
