"""Results by name: what a solution, or a state, has of one body, joint, force, constraint, contact or stop.

A view keeps nothing: it reads the arrays of its solution, with the time first, or those of a state at one time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar, overload

from carom import checks
from carom.results.views.body import BodyState
from carom.results.views.contact import ContactView
from carom.results.views.force import ConstraintView, ForceView
from carom.results.views.joint import JointView
from carom.scene.bodies import Body, HalfSpace, StaticBody
from carom.scene.constraints import Constraint
from carom.scene.contacts import Contact
from carom.scene.forces import AppliedForce
from carom.scene.joints import Joint
from carom.scene.stops import Stop
from carom.scene.table import first_names

if TYPE_CHECKING:
    from carom.scene.scene import Scene

Kind = TypeVar("Kind")
MOST_LISTED = 1000  # contacts whose names are completed


class Source:
    """Base class of what views read: arrays at T times, or at one time (without the first axis)."""

    t: Any
    position: Any
    orientation: Any
    velocity: Any
    angular_velocity: Any
    joint_reactions: Any
    constraint_forces: Any
    joint_coordinates: Callable
    _scene: Scene
    _numbers: Any  # of contacts by name
    _touch: Any  # active points at saved times
    _exerted_by: Callable  # rows of a force
    _report: Callable  # the same of some forces, with lengths
    _reports: Any  # the scene for reports, and the states
    _saved: Any
    _whose = "solution"  # in messages

    @overload
    def __getitem__(self, name: Body) -> BodyState: ...
    @overload
    def __getitem__(self, name: Joint) -> JointView: ...
    @overload
    def __getitem__(self, name: AppliedForce) -> ForceView: ...
    @overload
    def __getitem__(self, name: Constraint) -> ConstraintView: ...
    @overload
    def __getitem__(self, name: Contact | Stop) -> ContactView: ...
    @overload
    def __getitem__(self, name: str) -> Any: ...
    def __getitem__(self, name: Any) -> Any:
        """Return the results of one part, given by name or as the object; of a solution with the time first.

        A body is a `BodyState` (``solution["die"].velocity``), a joint a `JointView`
        (``solution["hinge"].torque``), a force a `ForceView` (``solution["motor"].power``), a constraint a
        `ConstraintView`, a contact or a stop a `ContactView` (``solution["die-ground"].force``). A name that no
        part has may be that of a sensor of the model. `body`, `joint`, `force`, `constraint` and `contact`
        return the same, of one kind, which type checkers know.

        Raises
        ------
        KeyError
            If there are no results of this name; the message suggests the nearest one.
        """
        return view(self, name, self._whose)

    def body(self, name: str | Body) -> BodyState:
        """Return the results of a body, as ``solution[name]`` does."""
        return self._of_kind(name, BodyState, "body")

    def joint(self, name: str | Joint) -> JointView:
        """Return the results of a joint, as ``solution[name]`` does."""
        return self._of_kind(name, JointView, "joint")

    def force(self, name: str | AppliedForce) -> ForceView:
        """Return the results of a force, as ``solution[name]`` does."""
        return self._of_kind(name, ForceView, "force")

    def constraint(self, name: str | Constraint) -> ConstraintView:
        """Return the results of a constraint, as ``solution[name]`` does."""
        return self._of_kind(name, ConstraintView, "constraint")

    def contact(self, name: str | Contact | Stop) -> ContactView:
        """Return the results of a contact or a stop, as ``solution[name]`` does."""
        return self._of_kind(name, ContactView, "contact or a stop")

    def _of_kind(self, name: Any, kind: type[Kind], called: str) -> Kind:
        """Return the results of a part of one kind."""
        try:
            found = view(self, name, self._whose)
        except (KeyError, ValueError) as error:
            raise ValueError(f"name must be that of a {called}: {error.args[0]}") from None
        if not isinstance(found, kind):
            raise ValueError(
                f"name must be that of a {called}, got {checks.shown(name)}, which has a "
                f"{type(found).__name__}"
            )
        return found

    def _ipython_key_completions_(self) -> list[str]:
        parts = [part.name for part in self._scene._parts if type(part) in VIEWS]
        contacts = first_names(self._numbers())
        listed = contacts if len(contacts) < MOST_LISTED else ()
        sensors = () if self._scene.robot is None else self._scene.robot.sensors
        return list(dict.fromkeys([*parts, *listed, *sensors]))


VIEWS: dict[type, Callable] = {
    Body: BodyState._of, Joint: JointView, AppliedForce: ForceView, Constraint: ConstraintView,
    Contact: lambda source, part: ContactView(source, part.index),
    Stop: lambda source, part: ContactView(source, len(source._numbers.pairs.body) + part.index),
}  # fmt: skip


def view(source: Source, key, whose: str):
    """Return the results of one part, given by name or as the object; `whose` is for messages."""
    scene = source._scene
    if isinstance(key, tuple(VIEWS)):
        if key not in scene:
            raise ValueError(
                f"{whose}[...] must belong to the scene of this {whose}, got {checks.shown(key)} of "
                f"another one; give its name: {whose}[{key.name!r}]"
            )
        return VIEWS[type(key)](source, scene[key.name])
    part = None
    if isinstance(key, str):
        try:
            part = scene[key]
        except KeyError:
            if scene.robot is not None and key in scene.robot.sensors:
                return scene.robot.sensors[key].of(source)
            number = source._numbers().get(key)
            if number is not None:
                return ContactView(source, number)
    if type(part) in VIEWS:
        return VIEWS[type(part)](source, part)
    known = source._ipython_key_completions_()
    if isinstance(part, (HalfSpace, StaticBody)):
        own = [name for name in known if name.endswith(f"-{key}")][:5]
        hint = f", but its contacts have: {', '.join(map(repr, own))}" if own else ""
        raise KeyError(f"{whose}: {key!r} never moves and has no results{hint}")
    names = dict.fromkeys([*known, *(one.name for one in scene.fixed)])
    near = checks.nearest(checks.shown(key).strip("'"), names)
    few = ", ".join(map(repr, known[:12])) + (", ..." if len(known) > 12 else "")
    raise KeyError(
        f"{whose}: the scene has no part called {checks.shown(key)}{near or f'; it has {few}'}"
    )
