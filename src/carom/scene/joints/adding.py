"""The methods of `Scene` for joints."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import count
from typing import TYPE_CHECKING, Any, NamedTuple, cast, overload

from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.scene.belts import BeltDrive, add_belt
from carom.scene.bodies import Body, Ground
from carom.scene.coordinates import Axial, Bush, Length
from carom.scene.flexible_bodies import rigid
from carom.scene.joints import JOINTS, Belt, Clearance, Distance, Joint, JointDefinition, Tether
from carom.scene.stops import Stop
from carom.scene.switches import SceneSwitches, limits_of

if TYPE_CHECKING:
    import numpy as np

    from carom.geometry.attitude import Orientation


class Rod(NamedTuple):
    """The stops of a rod with two limits."""

    lower: Stop
    upper: Stop


class SceneJoints(SceneSwitches):
    """The methods of `Scene` for joints, of which some may break."""

    @overload
    def add_joint(
        self,
        definition: Tether,
        parent: Body | Ground | str | None = None,
        child: Body | str | None = None,
        *,
        breaks_at: float | Mapping[str, float] | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> Stop: ...

    @overload
    def add_joint(
        self,
        definition: Belt,
        parent: Body | str | None = None,
        child: Body | str | None = None,
        *,
        name: str | None = None,
    ) -> BeltDrive: ...

    @overload
    def add_joint(
        self,
        definition: Distance | Clearance,
        parent: Body | Ground | str | None = None,
        child: Body | str | None = None,
        *,
        parent_frame: tuple[ArrayLike, Orientation] | None = None,
        child_frame: tuple[ArrayLike, Orientation] | None = None,
        breaks_at: float | Mapping[str, float] | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> Any: ...

    @overload
    def add_joint(
        self,
        definition: JointDefinition,
        parent: Body | Ground | str | None = None,
        child: Body | str | None = None,
        *,
        parent_frame: tuple[ArrayLike, Orientation] | None = None,
        child_frame: tuple[ArrayLike, Orientation] | None = None,
        breaks_at: float | Mapping[str, float] | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> Joint: ...

    @arguments.known
    def add_joint(
        self,
        definition: JointDefinition | Tether | Clearance | Belt,
        parent: Body | Ground | str | None = None,
        child: Body | str | None = None,
        *,
        parent_frame: tuple[ArrayLike, Orientation] | None = None,
        child_frame: tuple[ArrayLike, Orientation] | None = None,
        breaks_at: float | Mapping[str, float] | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> Any:
        """Join two bodies, or a body and the ground.

        Parameters
        ----------
        definition
            A joint of `carom.joints`; of a `carom.joints.Tether`, and of a `carom.joints.Distance` with limits,
            stops are made, of a `carom.joints.Belt` a constraint, stops or forces. Its points and axes are in
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
        breaks_at
            Force [N] beyond which the joint breaks: from then on the bodies move without it. A mapping has some
            of ``"force"`` [N], ``"torque"`` [N m] (about the anchor) and ``"impulse"`` [N s] (in an impact). It
            makes a switch, ``"<name>.breaks"``: see `switch`. Default None: it never breaks.
        name
            Name in the scene. Default ``"joint1"``, ``"joint2"``, ...
        replace : bool
            True: a joint that has this name is replaced, and what refers to it then refers to the new one.
            Default False: a name that is taken is refused.

        Returns
        -------
        Joint
            The joint; of a tether, or a distance with one limit, a `Stop`; of a distance with a lower and an
            upper limit a pair of them, with the names ``"<name>.lower"`` and ``"<name>.upper"``; of a belt its
            parts, `relation`, `strands` and `pretension`.

        Examples
        --------
        >>> scene = carom.Scene()
        >>> rod = scene.add_body(carom.Box(1, 0.1, 0.1), mass=1.0, position=(0.5, 0, 0), name="rod")
        >>> hinge = carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 1, 0))
        >>> scene.add_joint(hinge, carom.GROUND, rod, name="hinge")
        Joint('hinge', Revolute, 'GROUND' -> 'rod')
        """
        limits = limits_of(definition, breaks_at)
        if isinstance(definition, (Tether, Clearance, Belt)) or (
            isinstance(definition, Distance) and definition.limits_of_length
        ):
            placed = parent_frame is not None or child_frame is not None
            made = self._add_length(definition, parent, child, name, replace, placed)
            return self._breaks(made, limits)
        order = "; the order is add_joint(definition, parent, child)"
        checks.instance("definition", definition, JOINTS, order if _is_side(definition) else "")
        if parent is None or child is None:
            raise TypeError(
                "parent and child must be given: add_joint(definition, carom.GROUND, body) joins a body to the "
                "world, add_joint(definition, parent, child) two bodies; got "
                f"{checks.shown(parent)} and {checks.shown(child)}"
            )
        parent, child = self._parts.pair(parent, child)
        rigid(parent, child)
        made = self._parts.make(
            Joint, "joint", name, replace, definition=definition, parent=parent, child=child,
            frames=(parent_frame, child_frame),
        )  # fmt: skip
        return self._breaks(made, limits)

    def _add_length(
        self,
        d: Tether | Distance | Clearance | Belt,
        parent,
        child,
        name,
        replace: bool,
        placed: bool,
    ) -> Any:
        """Make the stops of a distance, one or a pair, those of a clearance, or the parts of a belt."""
        if placed:
            raise ValueError(
                f"parent_frame and child_frame must be left out of a {type(d).__name__}, which has anchors"
            )
        if parent is None or child is None:
            raise TypeError(
                f"parent and child must be given: add_joint({type(d).__name__}(...), parent, child)"
            )
        parent, child = self._parts.pair(parent, child)
        rigid(parent, child)
        if isinstance(d, Belt):
            if replace:
                raise ValueError(
                    "replace must be left out of a Belt, which has several parts, got True"
                )
            return add_belt(self._parts, d, parent, child, name)
        if isinstance(d, Clearance):
            return self._add_clearance(d, parent, child, name, replace)
        if isinstance(parent, Ground) and d.anchor_parent is None:
            raise ValueError("anchor_parent must be given for a point of the ground, got None")
        of = Length(parent, child, d.anchor_parent, d.anchor_child)
        if isinstance(d, Tether):
            return self._add_limit(d, of, "tether", name, replace, upper=_length(d, of))
        ends = d.limits_of_length
        if len(ends) == 1:
            return self._add_limit(d, of, "rod", name, replace, **ends)
        if name is None:
            own = {stop.name for stop in self._parts.parts(Stop)}
            name = next(f"rod{k}" for k in count(1) if f"rod{k}.lower" not in own)
        made = [
            self._add_limit(d, of, "rod", f"{name}.{side}", replace, **{side: end})
            for side, end in ends.items()
        ]
        return Rod(*made)

    def _add_clearance(self, d: Clearance, parent, child, name, replace: bool) -> Any:
        """Make the stops of a pin in its bush: one, or all of them in a tuple."""
        limits: dict[str, tuple[Length, dict[str, float]]] = {}
        axis = cast("np.ndarray", d.axis)  # None without any of the places
        if d.axis is None:
            limits[""] = Length(parent, child, d.anchor, d.anchor), {"upper": d.radial}
        for end, at in d.places.items():
            bush = Bush(parent, child, d.anchor, at, axis, d.radius, d.friction)
            limits[end] = bush, {"upper": d.radial}
        if d.axial is not None:
            along = Axial(parent, child, d.anchor, d.anchor, axis)
            limits |= {
                ".lower": (along, {"lower": -d.axial}),
                ".upper": (along, {"upper": d.axial}),
            }
        if name is None:
            own = {stop.name for stop in self._parts.parts(Stop)}
            first = next(iter(limits))
            name = next(f"pin{k}" for k in count(1) if f"pin{k}{first}" not in own)
        made = [
            self._add_limit(d, of, "pin", f"{name}{end}", replace, **ends)
            for end, (of, ends) in limits.items()
        ]
        return made[0] if len(made) == 1 else tuple(made)

    def _add_limit(self, d, of: Length, default: str, name, replace: bool, **end: float) -> Stop:
        return self._parts.make(
            Stop, default, name, replace, joint=of, coordinate=0, restitution=d.restitution,
            impact_law=d.impact_law, **end,
        )  # fmt: skip

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Joints, in the order in which they were added."""
        return self._parts.parts(Joint)


def _length(tether: Tether, of: Length) -> float:
    """Return the length of a tether: by default the distance of its ends at the start."""
    distance = math.dist(*of.ends)
    if tether.length is None and distance == 0.0:
        raise ValueError("length must be given if both points are the same at the start, got None")
    return distance if tether.length is None else tether.length


def _is_side(part) -> bool:
    """Return whether an object is a parent or child of a joint, not its definition."""
    return isinstance(part, (Body, Ground, str))
