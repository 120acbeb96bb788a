"""Forces of a scene whose values are set as a run goes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from carom import checks
from carom.geometry import quaternion
from carom.scene.forces import AppliedForce, Force, Torque
from carom.scene.more_forces import JointForce, JointSpring

HINT = "; state one by Scene.add_force, and give it or its name"
UNITS = {Force: "N", Torque: "N m"}


class Place(NamedTuple):
    """Where kernels find a force: rows of `loads` with their signs, or a row of `pushes`."""

    column: str  # force, torque or push
    rows: tuple[int, ...]
    frame: np.ndarray | None  # quaternion of the body at the start, where the vector turns with it


class Applied:
    """The forces of a run that may be set, and what they have been set to."""

    def __init__(self, run, implicit: bool):
        self.run, self.places = run, places(run, implicit)
        # rows that were saved before, and the value
        self.history: list[tuple[int, Place, Any]] = []
        self.values: list[tuple[int, int, Any]] = []  # the same with indices and given values
        self.given: dict[int, Any] = {}  # the present ones, by index; replaced with each

    def set(self, force, value) -> None:
        """Set a force, given itself or by its name."""
        scene = self.run.scene
        force = scene._parts.member("force", force, (AppliedForce,), HINT)
        place = self.places.get(force.index)
        if place is None:
            raise ValueError(
                "force must be a Force, a Torque or a JointForce with a number, got "
                f"{force.name!r}, a {force.kind}"
            )
        push = place.column == "push"
        unit = "" if push else UNITS[type(force.definition)]
        value = (
            checks.number("value", value)
            if push
            else checks.finite_array("value", value, (3,), unit)
        )
        self.given = {**self.given, force.index: value}
        self.values.append((int(self.run.clock["saved"][0]), force.index, value))
        if not push:
            if place.frame is not None:
                value = quaternion.rotate_back(place.frame, value)
        self.history.append((int(self.run.clock["saved"][0]), place, value))
        put(self.run.compiled.system, place, value)
        if self.run.islands.joined.loads.size:  # a second time, for the island of loaded bodies
            put(self.run.islands.joined, place, value)


def put(system, place: Place, value) -> None:
    """Write the value of a force where kernels find it."""
    if place.column == "push":
        system.relations.pushes["force"][place.rows[0]] = value
        return
    column = system.loads[place.column]
    for sign, row in zip((1.0, -1.0), place.rows):
        column[row] = sign * value


def places(run, implicit: bool) -> dict[int, Place]:
    """Return where the forces of a scene are, by their index: in the order in which they were compiled."""
    out, loads, pushes = {}, 0, 0
    for force in run.scene.forces:
        d = force.definition
        if isinstance(d, (Force, Torque)):
            both = isinstance(d, Torque) and force.parent.index >= 0
            rows = (loads, loads + 1) if both else (loads,)
            frame = run.compiled.start.Q[force.child.index].copy() if d.follow else None
            out[force.index] = Place(type(d).__name__.lower(), rows, frame)
            loads += len(rows)
        elif isinstance(d, JointForce):
            if not callable(d.force):
                out[force.index] = Place("push", (pushes,), None)
            pushes += 1
        elif isinstance(d, JointSpring) and not implicit:
            pushes += 1
    return out


def rows_of_forces(
    history: list[tuple[int, Place, Any]], system, saved: int
) -> Iterator[tuple[int, int]]:
    """Go through ranges of saved rows in which forces stay as they are; write them into the system."""
    first = 0
    for row, place, value in history:
        if min(row, saved) > first:
            yield first, min(row, saved)
            first = min(row, saved)
        put(system, place, value)
    if saved > first:
        yield first, saved


def values_of_forces(
    scene, values: list[tuple[int, int, Any]], saved: int
) -> dict[int, np.ndarray]:
    """Return the values at saved times, (T,) or (T, 3), of the forces that were set, by index."""
    out: dict[int, np.ndarray] = {}
    for row, index, value in values:
        if index not in out:
            d = scene.forces[index].definition
            first = d.force if isinstance(d, JointForce) else d.vector
            out[index] = np.repeat(np.array(first, dtype=float)[None], saved, axis=0)
        out[index][row:] = value
    return out
