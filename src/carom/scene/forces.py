"""Forces on bodies, beyond gravity: springs with dampers, constant forces and torques.

Give a definition to `Scene.add_force`. Points are in the world as the system stands at the start,
and then fixed in their body; vectors are in world axes and stay as they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom import check
from carom.scene.bodies import Body, Ground
from carom.scene.values import keep, optional_point, point


@dataclass(frozen=True, init=False, eq=False)
class Spring:
    """A spring and damper on the line between a point of the parent and one of the child.

    At distance d, which grows at d', it pulls the two points together with the force
    ``stiffness (d - rest_length) + damping d'``.

    Parameters
    ----------
    stiffness
        [N/m], at least 0.
    anchor_parent, anchor_child : (3,)
        The two points, in the world at the start [m]. They must differ: where they coincide the
        line has no direction.
    rest_length
        [m], at least 0. Default: the distance of the anchors at the start.
    damping
        [N s/m], at least 0. Default 0.
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
        start, end = point("anchor_parent", anchor_parent), point("anchor_child", anchor_child)
        distance = float(np.linalg.norm(end - start))
        if not distance > 0.0:
            raise ValueError(
                f"anchor_child must differ from anchor_parent, got {anchor_child!r} for both"
            )
        rest = distance if rest_length is None else rest_length
        keep(
            self,
            stiffness=check.number("stiffness", stiffness, least=0, unit="N/m"),
            anchor_parent=start,
            anchor_child=end,
            rest_length=check.number("rest_length", rest, least=0, unit="m"),
            damping=check.number("damping", damping, least=0, unit="N s/m"),
        )


@dataclass(frozen=True, init=False, eq=False)
class Torque:
    """A constant torque `vector` (3,) [N m] on the child, in world axes.

    Its opposite acts on the parent; the ground takes it without moving.
    """

    vector: np.ndarray

    def __init__(self, vector: ArrayLike):
        keep(self, vector=check.finite_array("vector", vector, (3,), unit="N m"))


@dataclass(frozen=True, init=False, eq=False)
class Force:
    """A constant force `vector` (3,) [N], world axes, on a point of the child.

    `anchor` (3,) is the point, in the world at the start [m]; None is the mass centre.
    """

    vector: np.ndarray
    anchor: np.ndarray | None

    def __init__(self, vector: ArrayLike, anchor: ArrayLike | None = None):
        vector = check.finite_array("vector", vector, (3,), unit="N")
        keep(self, vector=vector, anchor=optional_point("anchor", anchor))


ForceDefinition = Spring | Torque | Force
FORCES = (Spring, Torque, Force)


@dataclass(frozen=True, eq=False, repr=False)
class AppliedForce:
    """A force of a scene, from `parent` on `child`. Made by `Scene.add_force`.

    Attributes
    ----------
    index : int
        Place in `Scene.forces`.
    name : str
    definition : Spring, Torque or Force
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


def make_force(index, name, definition, parent, child) -> AppliedForce:
    """Return a checked `AppliedForce`; the arguments are those of `Scene.add_force`."""
    if isinstance(definition, Force) and not isinstance(parent, Ground):
        raise ValueError(
            f"parent of a Force must be carom.GROUND, got {parent!r}; "
            "for a force between two bodies use Spring, or two Forces"
        )
    return AppliedForce(index, name, definition, parent, child)
