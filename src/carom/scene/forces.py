"""Forces on bodies other than gravity: springs with dampers, elastic mounts, forces and torques.

Pass a definition to `Scene.add_force`. Points are given in world coordinates at the start, and are then
fixed in their body. Vectors are given in world axes; they stay constant, or turn with the body.
"""

from __future__ import annotations

from dataclasses import dataclass

from carom import arguments, checks
from carom.scene.bodies import GROUND, Body, Ground
from carom.scene.constraints import with_parts
from carom.scene.coordinates import Combination
from carom.scene.flexible_bodies import rigid
from carom.scene.force_definition import ForceDefinition
from carom.scene.values import MethodsOfScene, PartOfScene, in_scene, subclasses_in

# isort: off
# The registry: a line a force; the order is that of the tables of kernels. A new one comes last.
from carom.scene.body_forces import Spring as Spring
from carom.scene.body_forces import Torque as Torque
from carom.scene.body_forces import Force as Force
from carom.scene.body_forces import Bushing as Bushing
from carom.scene.more_forces import JointSpring as JointSpring
from carom.scene.more_forces import JointForce as JointForce
from carom.scene.actuators import Actuator as Actuator
from carom.scene.joint_friction import JointFriction as JointFriction
from carom.scene.joint_friction import Drive as Drive
from carom.scene.more_forces import JointInertia as JointInertia
from carom.scene.more_forces import CurveSpring as CurveSpring
from carom.scene.more_forces import UserForce as UserForce
from carom.scene.fluids import Drag as Drag
from carom.scene.fluids import Wind as Wind
from carom.scene.fluids import Magnus as Magnus
from carom.scene.fluids import Buoyancy as Buoyancy
from carom.scene.actuators import PositionServo as PositionServo
from carom.scene.actuators import VelocityServo as VelocityServo
from carom.scene.strand_force import BeltStrand as BeltStrand
from carom.scene.modal_spring import ModalSpring as ModalSpring
# isort: on

FORCES = subclasses_in(globals(), ForceDefinition)
#: tables of kernels, in this order
TABLES = tuple(dict((one.table.name, one.table) for one in FORCES if one.table).values())


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
    """Return the joints or the bodies that a definition contains; None if it contains none."""
    if hasattr(definition, "joint"):
        joint = definition.joint
        return joint.joints if isinstance(joint, Combination) else (joint,)
    return getattr(definition, "bodies", None)


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
        rigid(parent, child)
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
