"""The method of `Scene` for switches, and a scene as it is while some of its parts are off."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType
from typing import Any

from carom import arguments, checks
from carom.scene.changes import dependents
from carom.scene.constraints import Constraint, Driver, Rows
from carom.scene.contacts import Contact
from carom.scene.forces import AppliedForce
from carom.scene.joints import Belt, Clearance, Joint, Tether
from carom.scene.joints.rolling import RollingDisc, RollingSphere
from carom.scene.more_forces import JointInertia
from carom.scene.stops import Stop
from carom.scene.switch import LIMITS, Switch
from carom.scene.values import MethodsOfScene

#: kinds of parts that a switch may take out of a motion
SWITCHABLE = (Joint, AppliedForce, Constraint, Stop, Contact)
#: how the names of events begin, as of `simulate`
EVENTS = "at rest", "first impact of "


class SceneSwitches(MethodsOfScene):
    """The method of `Scene` for switches."""

    @arguments.known
    def switch(
        self,
        part,
        at: float | str | Callable | None = None,
        *,
        off: bool = True,
        name: str | None = None,
    ) -> Switch:
        """Take a part out of the motion, or put it into it, at a time or at an event.

        From then on the motion is that of the scene without the part, or with it. What refers to a joint (its
        stops, its motors, a gear) goes and comes with it. A part whose first switch is one that puts it into
        the motion is out of it at the start. How to: [switches and breaking joints](../howto/switches.md).

        A joint, gear or motor that is put into the motion takes the bodies as they stand then: their places
        stay, its coordinates are 0, and the velocities that it forbids vanish by an impulse, whose loss of
        energy is in `ledger.impacts`. Energy of a spring that is switched is in `ledger.loads`.

        Parameters
        ----------
        part
            A joint, force, constraint, stop or contact, its name, or a tuple of them (such as what `add_play`
            returns).
        at : float, str or callable, optional
            A time [s]; an event as of `simulate`: ``"first impact of A and B"``, ``"at rest"``, or a function
            ``f(t, state)``, which acts at each zero (with the attribute ``direction`` at those where it rises
            or falls). Default None: only `carom.Run.switch` acts.
        off : bool
            True (default): the part is taken out of the motion. False: it is put into it.
        name
            Name in the scene. Default ``"switch1"``, ``"switch2"``, ...

        Returns
        -------
        Switch

        Raises
        ------
        TypeError, ValueError
            If the part is none that can be switched, or `at` is no time, event or function.

        Examples
        --------
        A pendulum that is released at the bottom of its swing:

        >>> import carom
        >>> scene = carom.Scene()
        >>> bob = scene.add_body(carom.Sphere(0.05), mass=1.0, position=(-1.0, 0, 0), name="bob")
        >>> hinge = carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 1, 0))
        >>> scene.add_joint(hinge, carom.GROUND, bob, name="hinge")
        Joint('hinge', Revolute, 'GROUND' -> 'bob')
        >>> scene.switch("hinge", at=lambda t, state: state["bob"].position[0])
        Switch('switch1', 'hinge', off at <lambda>)
        """
        parts = tuple(self._switched(one) for one in each(part))
        off = checks.flag("off", off)
        values = _moment(at)
        if not off:
            for one in parts:
                check_on(one)
        return self._parts.make(Switch, "switch", name, False, parts=parts, off=off, **values)

    def _switched(self, part) -> Any:
        found = self._parts.named("part", part)
        checks.instance("part", found, SWITCHABLE)
        if isinstance(found, AppliedForce) and isinstance(found.definition, JointInertia):
            raise ValueError(f"part must not be an inertia, got {found.name!r}")
        return found

    def _breaks(self, made, limits: dict[str, float]) -> Any:
        """Make the switches of what breaks beyond some limits; return what was made."""
        for one in each(made) if limits else ():
            self._parts.make(
                Switch, "switch", f"{one.name}.breaks", False, parts=(one,), off=True, **limits
            )
        return made

    @property
    def switches(self) -> tuple[Switch, ...]:
        """Switches, in the order in which they were added."""
        return self._parts.parts(Switch)


def limits_of(definition, breaks_at) -> dict[str, float]:
    """Return the limits of a joint by name, none of one that does not break: a number is one of the force."""
    if breaks_at is None:
        return {}
    if isinstance(definition, Belt):
        raise ValueError(
            f"breaks_at must be left out of a Belt, got {checks.shown(breaks_at)}; take its parts out by "
            "scene.switch(belt, at=)"
        )
    if not isinstance(breaks_at, Mapping):
        return {"force": checks.number("breaks_at", breaks_at, above=0.0, unit="N")}
    unknown = [name for name in breaks_at if name not in LIMITS]
    if unknown or not breaks_at:
        raise ValueError(
            f"breaks_at must be a force [N], or have some of {', '.join(map(repr, LIMITS))}, got "
            f"{checks.shown(breaks_at)}"
        )
    stops = isinstance(definition, (Tether, Clearance)) or getattr(
        definition, "limits_of_length", None
    )
    if stops and "torque" in breaks_at:
        raise ValueError(
            f"breaks_at must have no torque for a {type(definition).__name__}, which has none, got "
            f"{checks.shown(breaks_at)}"
        )
    return {
        name: checks.number(f"breaks_at[{name!r}]", limit, above=0.0, unit=LIMITS[name])
        for name, limit in breaks_at.items()
    }


def _moment(at) -> dict[str, Any]:
    """Return the field of a switch that says when it acts."""
    if at is None:
        return {}
    if isinstance(at, str):
        if at != EVENTS[0] and not at.startswith(EVENTS[1]):
            raise ValueError(
                f'at must be a time [s], "{EVENTS[0]}", "{EVENTS[1]}A and B" or a function f(t, state), got '
                f"{checks.shown(at)}"
            )
        return {"event": at}
    if callable(at):
        return {"when": at}
    return {"time": checks.number("at", at, least=0.0, unit="s")}


def check_on(part) -> None:
    """Refuse to put a part into the motion whose place does not follow from that of the bodies."""
    d = getattr(part, "definition", None)
    if isinstance(d, (RollingSphere, RollingDisc)) or getattr(d, "guide", "") == "curve":
        why = f"a {part.kind}, whose place is stated at the start"
    elif isinstance(d, Rows):
        why = "rows of your own, whose error only you know"
    elif isinstance(part, Constraint) and isinstance(d, Driver) and d.rate is None:
        why = "a motion that is a function of time; give rate=, or a forces.PositionServo"
    else:
        return
    raise ValueError(f"off must be True for {part.name!r}, {why}; got False")


def each(parts) -> Iterator[Any]:
    """Yield parts that stand alone or in tuples, such as those of a play, a pin or a belt; None is none."""
    if isinstance(parts, tuple):
        for one in parts:
            yield from each(one)
    elif parts is not None:
        yield parts


def off_at_start(scene) -> frozenset[str]:
    """Return the names of parts that a run begins without: their first switch puts them in, or acts at 0."""
    on: dict[str, bool] = {}
    for switch in scene.switches:
        for part in switch.parts:
            if switch.time == 0.0:
                on[part.name] = not switch.off
            on.setdefault(part.name, switch.off)
    return frozenset(name for name, there in on.items() if not there)


def view_of(scene, off: frozenset[str], placed: Mapping[str, Any] = MappingProxyType({})):
    """Return a scene as a run sees it that is without some parts, and what refers to them.

    It has all parts, with their numbers. `placed` has by name (7,) how joints stand that were put in (position
    and attitude of the child from the parent, of principal axes), and the constant of such a relation.
    """
    found = set(off)
    for name in off:
        others = dependents(scene._parts, scene._parts[name])
        found |= {one.name for one in others if isinstance(one, SWITCHABLE)}
    made = scene.copy()
    made._parts.changes()
    made._off, made._placed = frozenset(found), placed
    made._parts.sealed = True
    return made


def is_off(scene, part) -> bool:
    """Return whether a run with this view of a scene is without a part."""
    return scene._off is not None and part.name in scene._off
