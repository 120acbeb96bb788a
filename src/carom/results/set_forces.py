"""Where kernels find the forces that a `carom.Run` sets, and what they were set to at its saved times."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from carom.geometry import quaternion
from carom.model.compile import Compiled, attitudes
from carom.scene.actuators import Controlled
from carom.scene.forces import Force, Torque
from carom.scene.more_forces import JointForce

#: rows that were saved before, index of the force, and the value: what was set as a run went
History = list[tuple[int, int, Any]]


class Place(NamedTuple):
    """Where kernels find the value of a force: rows of a column, which have it in turn with both signs."""

    kind: int  # of the table in `System.forces`
    column: str
    rows: tuple[int, ...]
    frame: np.ndarray | None = None  # of the body at the start, where the vector turns with it
    actuator: Controlled | None = None  # whose control is set


def put(system, place: Place, value) -> None:
    """Write the value of a force, or what a control gives, where kernels find it."""
    if place.actuator is not None:
        value = place.actuator.constant(value)
    if place.frame is not None:
        value = quaternion.rotate_back(place.frame, value)
    column = system.forces[place.kind][place.column]
    for sign, row in zip((1.0, -1.0), place.rows):
        column[row] = sign * value


def places(scene, compiled: Compiled) -> dict[int, Place]:
    """Return where the forces of a scene are that a run may set, by their index."""
    out = {}
    for force in scene.forces:
        d, at = force.definition, compiled.places.get(force.index)
        if at is None:
            continue
        rows = tuple(range(at.first, at.last))
        if isinstance(d, (Force, Torque)):
            turn = compiled.to_principal[[force.child.index]]
            frame = attitudes(force.child.orientation[None], turn)[0] if d.follow else None
            out[force.index] = Place(at.kind, type(d).__name__.lower(), rows, frame)
        elif isinstance(d, Controlled):
            out[force.index] = Place(at.kind, "force", rows, actuator=d)
        elif isinstance(d, JointForce) and not callable(d.force):
            out[force.index] = Place(at.kind, "force", rows)
    return out


def rows_of_forces(
    history: History, scene, compiled: Compiled, saved: int
) -> Iterator[tuple[int, int]]:
    """Go through ranges of saved rows in which forces stay as they are; write them into the compiled scene."""
    first, at = 0, places(scene, compiled)
    for index in {index for _, index, _ in history}:
        put(compiled.system, at[index], stated(scene, index))
    for row, index, value in history:
        if min(row, saved) > first:
            yield first, min(row, saved)
            first = min(row, saved)
        put(compiled.system, at[index], value)
    if saved > first:
        yield first, saved


def stated(scene, index: int):
    """Return the value of a force, or the control of an actuator, until it is set."""
    d = scene.forces[index].definition
    if isinstance(d, Controlled):
        return d.control
    return d.force if isinstance(d, JointForce) else d.vector
