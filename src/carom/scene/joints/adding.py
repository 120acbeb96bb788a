"""The methods of `Scene` for joints."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, overload

from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.scene.bodies import Body, Ground
from carom.scene.coordinates import Length
from carom.scene.joints import JOINTS, Joint, JointDefinition, Tether
from carom.scene.stops import Stop
from carom.scene.values import MethodsOfScene

if TYPE_CHECKING:
    from carom.geometry.attitude import Orientation


class SceneJoints(MethodsOfScene):
    """The methods of `Scene` for joints."""

    @overload
    def add_joint(
        self,
        definition: Tether,
        parent: Body | Ground | str | None = None,
        child: Body | str | None = None,
        *,
        name: str | None = None,
        replace: bool = False,
    ) -> Stop: ...

    @overload
    def add_joint(
        self,
        definition: JointDefinition,
        parent: Body | Ground | str | None = None,
        child: Body | str | None = None,
        *,
        parent_frame: tuple[ArrayLike, Orientation] | None = None,
        child_frame: tuple[ArrayLike, Orientation] | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> Joint: ...

    @arguments.known
    def add_joint(
        self,
        definition: JointDefinition | Tether,
        parent: Body | Ground | str | None = None,
        child: Body | str | None = None,
        *,
        parent_frame: tuple[ArrayLike, Orientation] | None = None,
        child_frame: tuple[ArrayLike, Orientation] | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> Joint | Stop:
        """Join two bodies, or a body and the ground.

        Parameters
        ----------
        definition
            A joint of `carom.joints`; of a `carom.joints.Tether` a `Stop` is made. Its points and axes are in
            the world at the start; with frames, they are in a frame that is fixed in both bodies.
        parent
            A body or its name, or `carom.GROUND`.
        child
            Another body, or its name.
        parent_frame, child_frame
            Position and orientation of this frame in the parent and in the child: a pair (position (3,),
            orientation as for `add_body`), relative to the mass centre, in body axes; for the ground, in the
            world. The coordinates of the joint are 0 where the two frames agree. If the initial positions
            do not fit the joint, `Options(project_start=True)` moves the bodies so that they do; otherwise
            `simulate` refuses them. Default None: the definition is in the world.
        name
            Name in the scene. Default ``"joint1"``, ``"joint2"``, ...
        replace : bool
            True: a joint that has this name is replaced, and what refers to it then refers to the new one.
            Default False: a name that is taken is refused.

        Examples
        --------
        >>> scene = carom.Scene()
        >>> rod = scene.add_body(carom.Box(1, 0.1, 0.1), mass=1.0, position=(0.5, 0, 0), name="rod")
        >>> hinge = carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 1, 0))
        >>> scene.add_joint(hinge, carom.GROUND, rod, name="hinge")
        Joint('hinge', Revolute, 'GROUND' -> 'rod')
        """
        if isinstance(definition, Tether):
            return self._add_tether(
                definition, parent, child, name, replace, (parent_frame, child_frame)
            )
        order = "; the order is add_joint(definition, parent, child)"
        checks.instance("definition", definition, JOINTS, order if _is_side(definition) else "")
        if parent is None or child is None:
            raise TypeError(
                "parent and child must be given: add_joint(definition, carom.GROUND, body) joins a body to the "
                "world, add_joint(definition, parent, child) two bodies; got "
                f"{checks.shown(parent)} and {checks.shown(child)}"
            )
        parent, child = self._parts.pair(parent, child)
        return self._parts.make(
            Joint, "joint", name, replace, definition=definition, parent=parent, child=child,
            frames=(parent_frame, child_frame),
        )  # fmt: skip

    def _add_tether(self, tether: Tether, parent, child, name, replace: bool, frames) -> Stop:
        """Make the stop of a tether."""
        if frames != (None, None):
            raise ValueError(
                "parent_frame and child_frame must be left out of a Tether, which has anchors"
            )
        if parent is None or child is None:
            raise TypeError("parent and child must be given: add_joint(Tether(...), parent, child)")
        parent, child = self._parts.pair(parent, child)
        if isinstance(parent, Ground) and tether.anchor_parent is None:
            raise ValueError("anchor_parent must be given for a point of the ground, got None")
        of = Length(parent, child, tether.anchor_parent, tether.anchor_child)
        distance = math.dist(*of.ends)
        if tether.length is None and distance == 0.0:
            raise ValueError(
                "length must be given if both points are the same at the start, got None"
            )
        return self._parts.make(
            Stop, "tether", name, replace, joint=of, coordinate=0,
            upper=distance if tether.length is None else tether.length, restitution=tether.restitution,
            impact_law=tether.impact_law,
        )  # fmt: skip

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Joints, in the order in which they were added."""
        return self._parts.parts(Joint)


def _is_side(part) -> bool:
    """Return whether an object is a parent or child of a joint, not its definition."""
    return isinstance(part, (Body, Ground, str))
