"""Results by name: what a solution, or a state, has of one body, joint, force, constraint, contact or stop.

A view keeps nothing: it reads the arrays of its solution, with the time first, or those of a state at one time.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, overload

import numpy as np

from carom import arguments, checks
from carom.geometry import quaternion
from carom.results.names import UNITS
from carom.scene.bodies import Body, HalfSpace, StaticBody
from carom.scene.constraints import Constraint, Driver
from carom.scene.contacts import Contact, gap_between
from carom.scene.coordinates import kind_of, terms_of
from carom.scene.forces import AppliedForce, CurveSpring, Spring
from carom.scene.joints import Joint
from carom.scene.more_forces import AlongJoint, UserForce
from carom.scene.stops import RailContact, Stop
from carom.scene.table import first_names

if TYPE_CHECKING:
    from carom.results.event_tables import (
        ContactTable,
        EventTable,
        ImpactTable,
        JointImpulseTable,
    )
    from carom.scene.scene import Scene

Kind = TypeVar("Kind")
MODES = np.array(["open", "slipping", "sticking"])
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


class _Motion(NamedTuple):
    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray


@arguments.attributes()
class BodyState(_Motion):
    """Position, orientation and velocities of one body, in world axes: at one time, or at T saved times.

    Attributes
    ----------
    position : (3,) or (T, 3)
        Mass centre [m].
    orientation : (4,) or (T, 4)
        Unit quaternion (w, x, y, z), body to world.
    velocity, angular_velocity : (3,) or (T, 3)
        [m/s] and [rad/s].
    """

    _source: Source
    _part: Body

    @classmethod
    def _of(cls, source: Source, part: Body) -> BodyState:
        k = part.index
        made = cls(*(getattr(source, name)[..., k, :] for name in cls._fields))
        made._source, made._part = source, part
        return made

    def __repr__(self) -> str:
        if self.position.ndim == 1:
            return super().__repr__()
        listed = (f"{name} {getattr(self, name).shape}" for name in self._fields)
        return f"<BodyState of {self._part.name!r}: {', '.join(listed)}, energies>"

    @property
    def kinetic_energy(self):
        """Kinetic energy [J], a number or (T,)."""
        w = quaternion.rotate_back(self.orientation, self.angular_velocity)
        turning = np.sum(w * (w @ self._part.inertia), axis=-1)
        return 0.5 * (self._part.mass * np.sum(self.velocity**2, axis=-1) + turning)

    @property
    def potential_energy(self):
        """Potential energy of gravity [J], a number or (T,); 0 where the mass centre is at the origin."""
        return -self._part.mass * (self.position @ self._source._scene.gravity)

    @property
    def energy(self):
        """Kinetic energy plus the potential energy of gravity [J], a number or (T,)."""
        return self.kinetic_energy + self.potential_energy


@arguments.attributes()
class View:
    """Base class of the results of a part that is no body."""

    def __init__(self, source: Source, part):
        self._source, self._part = source, part

    @property
    def name(self) -> str:
        """Name of the part."""
        return self._part.name

    def _table(self, name: str):
        """Return the rows of a table of the solution that belong to this part."""
        table = getattr(self._source, name, None)
        if table is None or np.ndim(self._source.t) == 0:
            raise AttributeError(
                f"{name} are those of a whole run: solution[{self.name!r}], not of a state"
            )
        return table[self.name]

    def _drawn(self, kind: str, options: dict) -> Any:
        """Return the axes of a plot of this part over a run."""
        plot = getattr(self._source, "plot", None)
        if plot is None:
            raise AttributeError(
                f"a plot is of a whole run: solution[{self.name!r}], not of a state"
            )
        return plot(kind, self.name, **options)

    def __repr__(self) -> str:
        listed = ", ".join(n for n in dir(type(self)) if not n.startswith("_") and n != "name")
        return f"<{type(self).__name__} of {self.name!r}: {listed}>"


def _alone(values: np.ndarray):
    """Return values (..., n) without the last axis if there is only one."""
    return values[..., 0][()] if values.shape[-1] == 1 else values


@arguments.attributes()
class JointView(View):
    """Results of one joint: ``solution["hinge"]``, or ``state["hinge"]`` at one time (without T)."""

    @arguments.known
    def coordinates(self, *, degrees: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Return coordinates and rates, (T, n) each, as `Solution.joint_coordinates` does.

        Parameters
        ----------
        degrees : bool
            Whether angles are in degrees. Default False: radians.
        """
        return self._source.joint_coordinates(self._part, degrees=degrees)

    @property
    def coordinate(self):
        """Coordinates [rad or m], (T, n); (T,) if the joint has one. See `Solution.joint_coordinates`."""
        return _alone(self.coordinates()[0])

    @property
    def rate(self):
        """Rates of the coordinates [rad/s or m/s], (T, n); (T,) if the joint has one."""
        return _alone(self.coordinates()[1])

    @property
    def force(self) -> np.ndarray:
        """Force on the child at its anchor (T, 3), world axes [N]: see `Solution.joint_reactions`."""
        return self._source.joint_reactions[..., self._part.index, :3]

    @property
    def torque(self) -> np.ndarray:
        """Torque on the child about its anchor (T, 3), world axes [N m]."""
        return self._source.joint_reactions[..., self._part.index, 3:]

    @arguments.known
    def to_pandas(self, *, degrees: bool = False) -> Any:
        """Return a `pandas.DataFrame` with one row for each saved time, indexed by the time [s].

        Columns are ``coordinate`` and ``rate`` (with an index if there are several: ``coordinate[0]``), and the
        components of force and torque, ``fx``, ``fy``, ``fz``, ``tx``, ``ty``, ``tz``, as in
        `Solution.to_pandas`.

        Parameters
        ----------
        degrees : bool
            Whether angles are in degrees. Default False: radians.
        """
        pandas = checks.need("pandas", "to_pandas", "files")
        columns = {}
        for name, values in zip(("coordinate", "rate"), self.coordinates(degrees=degrees)):
            rows = np.reshape(values, (-1, np.shape(values)[-1])).T
            columns |= {
                f"{name}[{k}]" if len(rows) > 1 else name: one for k, one in enumerate(rows)
            }
        for name, values in (("f", self.force), ("t", self.torque)):
            columns |= {name + axis: one for axis, one in zip("xyz", np.reshape(values, (-1, 3)).T)}
        return pandas.DataFrame(
            columns, index=pandas.Index(np.atleast_1d(self._source.t), name="time")
        )

    def plot(self, **options) -> Any:
        """Draw coordinates, rates, forces and torques over time, as `carom.plots.joints` does."""
        return self._drawn("joints", options)

    @property
    def impulses(self) -> JointImpulseTable:
        """Impulses of the joint in impacts: rows of `Solution.joint_impulses`."""
        return self._table("joint_impulses")


class _Coordinate(ABC):
    """What acts along a coordinate of a joint."""

    _source: Source
    name: str

    @property
    @abstractmethod
    def _along(self) -> Any:
        """The definition with the joint."""

    @property
    @abstractmethod
    def _value(self) -> Any:
        """The force or torque along the coordinate."""

    def _coordinate(self, which: int):
        if self._along is None:
            raise AttributeError(f"{self.name!r} acts along no coordinate of a joint")
        read = self._source.joint_coordinates
        terms = terms_of(self._along.joint, self._along.coordinate)
        found = [factor * read(joint)[which][..., k] for joint, k, factor in terms]
        return np.sum(found, axis=0)[()]

    @property
    def coordinate(self):
        """Coordinate of the joint along which it acts [rad or m], (T,)."""
        return self._coordinate(0)

    @property
    def rate(self):
        """Rate of this coordinate [rad/s or m/s], (T,)."""
        return self._coordinate(1)

    def _acts(self, kind: str):
        """Return the force or torque along the coordinate; refuse the other one."""
        own = kind_of(self._along.joint, self._along.coordinate)
        if own != kind:
            asked, has = ("torque", "force") if kind == "turn" else ("force", "torque")
            raise AttributeError(
                f"{self.name!r} acts along a coordinate in {UNITS[own]}: it has a {has}, no {asked}"
            )
        return self._value


@arguments.attributes()
class ForceView(_Coordinate, View):
    """Results of one force: ``solution["motor"]``, or ``state["motor"]`` at one time (without T).

    They are computed from the states and the law of the force when they are asked for; those of `JointFriction`
    with the reactions of joints. Those of `JointInertia`, which need accelerations, are NaN.
    """

    @property
    def _along(self):
        d = self._part.definition
        return d if isinstance(d, AlongJoint) else None

    def plot(self, **options) -> Any:
        """Draw the force over time, as `carom.plots.forces` does."""
        return self._drawn("forces", options)

    @property
    def _rows(self) -> np.ndarray:
        return self._source._exerted_by(self._part)

    @property
    def _value(self):
        return self._rows[..., 0, 6][()]

    def _vector(self, first: int) -> np.ndarray:
        rows = self._rows[..., first : first + 3]
        return rows if isinstance(self._part.definition, UserForce) else rows[..., 0, :]

    @property
    def force(self) -> np.ndarray:
        """Force on the child (T, 3), world axes [N].

        Along a displacement of a joint: the force along it (T,). Of a `UserForce`: (T, n, 3) on its n bodies.
        """
        return self._vector(0) if self._along is None else self._acts("slide")

    @property
    def torque(self) -> np.ndarray:
        """Torque on the child (T, 3), world axes [N m].

        Along an angle of a joint: the torque about its axis (T,). Of a `UserForce`: (T, n, 3) on its n bodies.
        """
        return self._vector(3) if self._along is None else self._acts("turn")

    @property
    def power(self):
        """Power that it gives to the bodies [W], (T,): negative for a damper."""
        return np.sum(self._rows[..., 7], axis=-1)

    def _line(self) -> np.recarray:
        """Return what it exerts (T,), with its length, or that of one time."""
        if not isinstance(self._part.definition, (Spring, CurveSpring)):
            raise AttributeError(f"{self.name!r} has no length: it is no Spring or CurveSpring")
        found = self._source._report((self._part,))[:, 0]
        return found[0] if np.ndim(self._source.t) == 0 else found

    @property
    def length(self):
        """Distance of the ends of a spring [m], (T,)."""
        return self._line().length

    @property
    def length_rate(self):
        """Rate of this distance [m/s], (T,)."""
        return self._line().stretching

    @property
    def tension(self):
        """Force with which a spring, and its damper, pull the ends together [N], (T,)."""
        return self._line().value


@arguments.attributes()
class ConstraintView(_Coordinate, View):
    """Results of one constraint: a motor (`Driver`), a gear, rows of one's own."""

    @property
    def _along(self):
        d = self._part.definition
        return d if isinstance(d, Driver) else None

    @property
    def multipliers(self) -> np.ndarray:
        """Multipliers of its rows, (T, n); (T,) if it has one. See `Solution.constraint_forces`."""
        before = self._source._scene.constraints[: self._part.index]
        first = sum(one.rows for one in before)
        return _alone(self._source.constraint_forces[..., first : first + self._part.rows])

    @property
    def _value(self):
        return self.multipliers

    @property
    def force(self):
        """Force of a `Driver` along a displacement [N], (T,)."""
        return self._driven("slide")

    @property
    def torque(self):
        """Torque of a `Driver` about an angle [N m], (T,)."""
        return self._driven("turn")

    def _driven(self, kind: str):
        if self._along is None:
            raise AttributeError(f"{self.name!r} is no Driver: it has multipliers, and no force")
        return self._acts(kind)

    @property
    def power(self):
        """Power of a `Driver` [W], (T,)."""
        return self.rate * self.multipliers


@arguments.attributes()
class ContactView(View):
    """Results of one contact, or stop of a joint: ``solution["die-ground"]``, or of a state (without T)."""

    def __init__(self, source: Source, number: int):
        super().__init__(source, None)
        scene, pairs = source._scene, source._numbers.pairs
        self._number, self._stop = number, number - len(pairs.body)
        if self._stop >= 0:
            self._part = scene.stops[self._stop]
        elif number < len(scene.contacts):
            self._part = scene.contacts[number]
        else:
            plane = pairs.plane[number]
            other = scene.fixed[plane] if plane >= 0 else scene.bodies[pairs.other[number]]
            self._part = _Pair(scene.bodies[pairs.body[number]], other)

    @property
    def _turns(self) -> bool:
        """Whether it is the stop of an angle, whose force is a torque."""
        stop = self._part
        return isinstance(stop, Stop) and stop.turns

    @cached_property
    def _sums(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The greatest mode, and the forces in contact axes and in the world."""
        touch = self._source._touch
        own, times = touch[touch["contact"] == self._number], np.size(self._source.t)
        mode, force, vector = np.zeros(times, dtype=np.int64), *np.zeros((2, times, 3))
        np.maximum.at(mode, own["saved"], own["mode"])
        np.add.at(force, own["saved"], own["force"])
        np.add.at(vector, own["saved"], own["push"])
        if np.ndim(self._source.t) == 0:
            return mode[0], force[0], vector[0]
        return mode, force, vector

    @property
    def mode(self):
        """Mode "open", "slipping" or "sticking" (or rolling, or at rest), (T,)."""
        return MODES[self._sums[0]]

    @property
    def force(self) -> np.ndarray:
        """Force on the body (T, 3), contact axes (normal, tangent 1, tangent 2) [N]; 0 while it is open.

        Of the stop of an angle: the torque about its axis [N m], in the first column.
        """
        return self._sums[1]

    @property
    def vector(self) -> np.ndarray:
        """Force on the body (T, 3), world axes [N]."""
        return self._sums[2]

    @cached_property
    def gap(self):
        """Distance of the two [m], (T,), negative inside; of a stop that of the coordinate [rad or m].

        It is computed from the states when it is asked for, some 20 microseconds for each time.
        """
        source, part = self._source, self._part
        if isinstance(part, RailContact):
            gaps = source._reports.motion(part.joint, source._saved).gap
            return np.reshape(gaps, np.shape(source.t))[()]
        if isinstance(part, Stop):
            q = source._reports.motion(part.joint, source._saved, part.coordinate).value
            return part.side * (np.reshape(q, np.shape(source.t))[()] - part.end)
        x, Q = (np.reshape(a, (-1, *a.shape[-2:])) for a in (source.position, source.orientation))
        gaps = [
            gap_between(*(_pose(one, x[k], Q[k]) for one in (part.body, part.other)))[0]
            for k in range(len(x))
        ]
        return np.reshape(np.array(gaps), np.shape(source.t))[()]

    @property
    def impacts(self) -> ImpactTable:
        """Its impacts: rows of `Solution.impacts`."""
        return self._table("impacts")

    @property
    def events(self) -> EventTable:
        """Its events: rows of `Solution.events`."""
        return self._table("events")

    @property
    def intervals(self) -> ContactTable:
        """Its intervals of persistent contact: rows of `Solution.contacts`."""
        return self._table("contacts")


class _Pair(NamedTuple):
    """A pair that touches by the default of the scene."""

    body: Body
    other: Body | HalfSpace | StaticBody

    @property
    def name(self) -> str:
        return f"{self.body.name}-{self.other.name}"


class _Posed(NamedTuple):
    """A body elsewhere."""

    shape: Any
    position: np.ndarray
    orientation: np.ndarray


def _pose(part, x: np.ndarray, Q: np.ndarray):
    return _Posed(part.shape, x[part.index], Q[part.index]) if isinstance(part, Body) else part


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
