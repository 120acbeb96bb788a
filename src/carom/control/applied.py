"""Forces of a scene whose values are set as a run goes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from carom import checks
from carom.geometry import quaternion
from carom.model.compile import Compiled, attitudes
from carom.results.robot import columns, commands, first_controls
from carom.scene.forces import AppliedForce, Force, Torque
from carom.scene.more_forces import Actuator, JointForce, JointSpring, Law

HINT = "; state one by Scene.add_force, and give it or its name"
UNITS = {Force: "N", Torque: "N m"}

#: rows that were saved before, index of the force, and the value: what was set as a run went
History = list[tuple[int, int, Any]]


class Place(NamedTuple):
    """Where kernels find a force: rows of `loads` with their signs, or a row of `pushes`."""

    column: str  # force, torque or push
    rows: tuple[int, ...]
    frame: np.ndarray | None = None  # of the body at the start, where the vector turns with it
    actuator: Actuator | None = None  # whose control is set


class Applied:
    """The forces of a run that may be set, and what they have been set to."""

    def __init__(self, run, implicit: bool, history: History | None = None):
        self.run, self.places = run, places(run.scene, run.compiled, implicit)
        self.history: History = list(history or ())
        self.commands = commands(run.scene)
        self.ctrl = first_controls(self.commands)
        self._column = columns(self.commands)
        for index, value in {index: value for _, index, value in self.history}.items():
            self._put(index, value)

    def set(self, force, value) -> None:
        """Set a force, given itself or by its name."""
        scene = self.run.scene
        force = scene._parts.member("force", force, (AppliedForce,), HINT)
        place = self.places.get(force.index)
        if place is None or place.actuator is not None:
            hint = "" if place is None else f", whose control is run.ctrl[{force.name!r}]"
            raise ValueError(
                "force must be a Force, a Torque or a JointForce with a number, got "
                f"{force.name!r}, a {force.kind}{hint}"
            )
        if place.column == "push":
            value = checks.number("value", value)
        else:
            value = checks.finite_array("value", value, (3,), unit=UNITS[type(force.definition)])
        self.note(force.index, value)

    def note(self, index: int, value) -> None:
        """Set the force with this index to a value, which was checked, or the control of an actuator."""
        self.history.append((int(self.run.clock["saved"][0]), index, value))
        self._put(index, value)

    def _put(self, index: int, value) -> None:
        compiled, place = self.run.compiled, self.places[index]
        if index in self._column:
            self.ctrl[self._column[index]] = value
        put(compiled.system, compiled.laws.get(index), place, value)
        if self.run.islands.joined.loads.size:  # a second time, for the island of loaded bodies
            put(self.run.islands.joined, None, place, value)


def put(system, law: Law | None, place: Place, value) -> None:
    """Write the value of a force where kernels find it, or a control into its law."""
    if law is not None:
        law.set(value)
    elif place.column == "push":
        if place.actuator is not None:
            value = place.actuator.constant(value)
        system.relations.pushes["force"][place.rows[0]] = value
    else:
        if place.frame is not None:
            value = quaternion.rotate_back(place.frame, value)
        column = system.loads[place.column]
        for sign, row in zip((1.0, -1.0), place.rows):
            column[row] = sign * value


def places(scene, compiled: Compiled, implicit: bool) -> dict[int, Place]:
    """Return where the forces of a scene are, by their index: in the order in which they were compiled."""
    out, loads, pushes = {}, 0, 0
    for force in scene.forces:
        d = force.definition
        if isinstance(d, (Force, Torque)):
            both = isinstance(d, Torque) and force.parent.index >= 0
            rows = (loads, loads + 1) if both else (loads,)
            at = compiled.to_principal[[force.child.index]]
            frame = attitudes(force.child.orientation[None], at)[0] if d.follow else None
            out[force.index] = Place(type(d).__name__.lower(), rows, frame)
            loads += len(rows)
        elif isinstance(d, (Actuator, JointForce)):
            if isinstance(d, Actuator):
                out[force.index] = Place("push", (pushes,), actuator=d)
            elif not callable(d.force):
                out[force.index] = Place("push", (pushes,))
            pushes += 1
        elif isinstance(d, JointSpring) and not implicit:
            pushes += 1
    return out


def rows_of_forces(
    history: History, places: dict[int, Place], compiled: Compiled, saved: int
) -> Iterator[tuple[int, int]]:
    """Go through ranges of saved rows in which forces stay as they are; write them into the scene."""
    first = 0
    for row, index, value in history:
        if min(row, saved) > first:
            yield first, min(row, saved)
            first = min(row, saved)
        put(compiled.system, compiled.laws.get(index), places[index], value)
    if saved > first:
        yield first, saved
