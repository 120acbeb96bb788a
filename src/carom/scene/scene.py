"""`Scene`: the description of a system."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.scene.bodies import SceneBodies
from carom.scene.changes import KINDS, list_of, renewed
from carom.scene.changes import dependents as dependents_of
from carom.scene.constraints import Constraint, SceneConstraints, with_parts
from carom.scene.contacts import Contact, check_gap
from carom.scene.flexible_bodies import bodies_of_modes
from carom.scene.forces import AppliedForce
from carom.scene.joints.adding import SceneJoints
from carom.scene.look import Look, checked_look
from carom.scene.pairs import Pairs
from carom.scene.play import ScenePlay
from carom.scene.registry import Derived, Registry
from carom.scene.shapes import Shape
from carom.scene.shown import Shown
from carom.scene.solids import SceneSolids
from carom.scene.summary import counts, summary
from carom.scene.switch import Switch
from carom.scene.touching import SceneContacts
from carom.scene.values import in_scene

if TYPE_CHECKING:
    from carom.results.robot import Robot
    from carom.scene.coordinates import SystemOfScene


@in_scene
@arguments.known
class Scene(
    SceneBodies, SceneSolids, SceneContacts, SceneJoints, ScenePlay, SceneConstraints, Shown
):  # fmt: skip
    """A system of bodies, half-spaces, contacts, joints and forces, with its initial state.

    The ``add_*`` methods check their arguments at once and return the new part, a read-only object. Each part
    has a name that is unique in the scene: ``scene["die"]`` is the part with the name "die", ``"die" in scene``
    says whether there is one, and ``for part in scene`` goes through all. With ``replace=True`` they put the
    new part in the place of the one that has its name. `replace` and `remove` change a scene too; a solution
    keeps the scene as it was.

    Parameters
    ----------
    gravity : (3,), default (0, 0, -9.81)
        Acceleration in world axes [m/s^2]. It may be set later: ``scene.gravity = (0, 0, -1.62)``.

    Attributes
    ----------
    look : tuple of Look
        What is seen in pictures, pages and films besides the parts of the scene, in world axes. It touches
        nothing. It may be set: ``scene.look = [carom.Look(...)]``.

    Examples
    --------
    >>> import carom
    >>> scene = carom.Scene()
    >>> ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    >>> ball = scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 1), name="ball")
    >>> scene.add_contact(ball, ground, restitution=0.8)
    Contact('ball-ground', restitution=0.8, friction=0, impact_law='newton')
    """

    #: the system in coordinates of the user's own for which the bodies stand
    _chart: SystemOfScene | None = None
    #: parts that a run is without, by name, and where it has put others in; None: what the scene states
    _off: frozenset[str] | None = None
    _placed: Mapping[str, np.ndarray] = MappingProxyType({})

    def __init__(self, gravity: ArrayLike = (0.0, 0.0, -9.81)):
        self._parts = Registry()
        self._pairs = Pairs(self._parts)
        self.gravity = gravity
        #: the scene for solutions, and the results of this one when it was made
        self._snapshot: tuple = None, None
        self._in_radians: set[str] = set()  # stops whose file has radians
        self._robot: Robot | None = None
        self._look: tuple[Look, ...] = ()

    @arguments.known
    def replace(self, part, **values) -> Any:
        """Replace a part by one with other values, and return it; what refers to it then refers to the new one.

        Values that are not given stay as they are. Joints and forces stay where they are in the world at the
        start, and contacts keep their laws. Positions are checked when the scene is simulated.

        Parameters
        ----------
        part
            The part, or its name.
        **values
            Arguments of the method that adds such parts. For a contact: values of its law. For a joint, force
            or constraint: `definition`, or fields of its definition, as in
            ``scene.replace("spring", stiffness=200)``. A new mass scales the inertia of a body, and a new shape
            has the inertia of the solid, unless `inertia` is given.

        Raises
        ------
        TypeError
            If such a part has no value of a given name.
        ValueError
            If there is no such part, or a value is outside its range; the scene is then as before.

        Examples
        --------
        >>> scene = carom.Scene()
        >>> die = scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.016, name="die")
        >>> print(scene.replace("die", mass=0.008, color="red").inertia[0, 0] / die.inertia[0, 0])
        0.5
        """
        old = self._parts.named("part", part)
        if not values:
            raise TypeError(f"replace needs a value, such as {KINDS[type(old)].example}=...")
        if "definition" in values and isinstance(old, (AppliedForce, Constraint)):
            values["definition"] = with_parts(values["definition"], self._parts.member)
        self._parts.exchange({id(old): renewed(old, values)})
        if isinstance(old, Contact) and values.keys() & {"restitution", "friction"}:
            self._pairs.state(old)
        return self._parts[old.name]

    @arguments.known
    def remove(self, part, *, dependents: bool = False) -> tuple:
        """Remove a part, and return all parts that were removed.

        Contacts of a body, half-space or static body, and switches of a part, are removed with it. Bodies of a
        joint that is removed may touch again by `set_contact_default`.

        Parameters
        ----------
        part
            The part, or its name.
        dependents : bool
            True: joints of a body are removed with it, and also forces, constraints and stops that refer to
            the part or to these joints. Default False: a part that has such dependents is not removed.

        Raises
        ------
        ValueError
            If there is no such part, or joints, forces, constraints or stops refer to it and `dependents` is
            False; the message names them.
        """
        part = self._parts.named("part", part)
        found = list(dependents_of(self._parts, part))
        others = [one for one in found if not isinstance(one, (Contact, Switch))]
        if others and not checks.flag("dependents", dependents):
            raise ValueError(
                f"dependents must be True to remove {part.name!r} together with what refers to it: "
                f"{list_of(others)}"
            )
        for one in bodies_of_modes(self, part):  # nothing else refers to them
            found += [one, *dependents_of(self._parts, one)]
        found = list(dict.fromkeys(found))
        removed = part, *found
        self._parts.exchange({id(one): None for one in removed})
        for one in removed:
            self._pairs.forget(one)
        return removed

    def copy(self) -> Scene:
        """Return a copy of the scene; a change of one of the two does not change the other.

        Parts of one may be given to methods of the other, where they stand for the parts with their names.
        """
        return self._with(self._parts.copied())

    def _with(self, parts: Registry) -> Scene:
        made: Any = object.__new__(type(self))
        own = {"_parts": parts, "_pairs": self._pairs.copied(parts), "_snapshot": (None, None)}
        vars(made).update(vars(self), **own, _in_radians=set(self._in_radians))
        return made

    def _as_it_is(self) -> Scene:
        """Return the scene for solutions, which cannot be changed: the same one until this scene changes."""
        if self._parts.sealed:
            return self
        if self._snapshot[1] is not self._derived:  # which each change makes anew
            self._snapshot = self._with(self._parts.copied(sealed=True)), self._derived
        return self._snapshot[0]

    def __copy__(self) -> Scene:
        return self.copy()

    def __getstate__(self) -> dict:  # of deep copies, whose parts may be changed, and pickles
        return {**vars(self), "_snapshot": (None, None)}

    @property
    def _derived(self) -> Derived:
        return self._parts.derived

    @property
    def robot(self) -> Robot | None:
        """The model in its own coordinates, where `load_model` has made the scene; else None.

        It is also None when one of its bodies, joints or actuators has been removed.
        """
        robot = self._robot
        if robot is None:
            return None
        return self._derived.once("robot", lambda: robot._followed(self._parts.get))

    @property
    def gravity(self):
        """Acceleration of gravity (3,), world axes [m/s^2]."""
        return self._gravity

    @gravity.setter
    def gravity(self, value) -> None:
        gravity = checks.finite_array("gravity", value, (3,), unit="m/s^2")
        self._parts.changes()
        gravity.setflags(write=False)
        self._gravity = gravity

    @property
    def look(self) -> Any:
        """What is seen besides the parts of the scene: a tuple of `Look`, in world axes."""
        return self._look

    @look.setter
    def look(self, value: Look | Shape | Sequence[Look | Shape] | None) -> None:
        look = () if value is None else checked_look("look", value)
        self._parts.changes()
        self._look = look

    def __getitem__(self, name: str):
        """Return the part with this name; the message of a `KeyError` suggests the nearest name.

        A contact is found as ``"die-ground"`` and as ``"ground-die"``.
        """
        return self._parts[name]

    def __iter__(self) -> Iterator:
        """Go through all parts by kind: bodies, half-spaces, static bodies, joints, forces, ..., contacts."""
        return iter([part for kind in KINDS for part in self._parts.parts(kind)])

    def __contains__(self, name) -> bool:
        """Return whether a part has this name; or, of a part, whether it is one of this scene."""
        return self._parts.has(name)

    def _ipython_key_completions_(self) -> list[str]:
        return [part.name for part in self._parts]

    def validate(self) -> None:
        """Check that the scene can start: it has bodies, and no body penetrates another one or a half-space.

        Raises
        ------
        ValueError
            If it cannot; the message gives the pair, the penetration, and the remedy.
        """
        if not self.bodies:
            raise ValueError("scene must have at least one body, got none; add it with add_body")
        for contact in self.contacts:
            check_gap(contact)
        self._pairs.check_all(self.bodies, self.fixed)

    def check(self):
        """Return the degrees of freedom of the scene, its redundant constraints, and likely mistakes.

        Returns
        -------
        carom.dynamics.mobility.Mobility
            The values for the initial position; in singular positions a mechanism may have more degrees of
            freedom. Print it for a summary.

        Raises
        ------
        ValueError
            As for `validate`.

        Examples
        --------
        A door on two hinges:

        >>> scene = carom.Scene()
        >>> door = scene.add_body(carom.Box(0.9, 0.04, 2), mass=20, position=(0.45, 0, 1), name="door")
        >>> for name, z in (("lower", 0.2), ("upper", 1.8)):
        ...     hinge = carom.joints.Revolute(anchor=(0, 0, z), axis=(0, 0, 1))
        ...     joint = scene.add_joint(hinge, carom.GROUND, door, name=name)
        >>> print(scene.check())
        1 bodies, 10 constraint rows: 1 degrees of freedom
        5 redundant rows, among lower, upper
        """
        from carom.dynamics.mobility import mobility

        self.validate()
        return mobility(self)

    def __repr__(self) -> str:
        return f"<Scene: {counts(self)}>"

    def __str__(self) -> str:
        return summary(self)
