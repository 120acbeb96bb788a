"""The events that `simulate` was given, in a file: times, and the states at these times."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from carom import checks
from carom.io.files.layout import BODIES, ENERGIES, LABELS, USER_EVENT, Variable, table_variables
from carom.results.state import SystemState

DIM = "user_event"
FIELD = {"time": "t"}  # of a state, where it has another name


def user_events(solution) -> list[Variable]:
    """Return the states at all events, one event after the other; nothing for a run without events."""
    if solution.state_events is None:
        return []
    states = [(k, state) for k, some in enumerate(solution.state_events) for state in some]
    sizes = {name: len(labels) for name, (labels, _) in LABELS.items()}
    sizes["body"] = len(solution.scene.bodies)
    table = SimpleNamespace()
    for name, (dims, _, _) in USER_EVENT.items():
        column = [
            k if name == "index" else getattr(state, FIELD.get(name, name)) for k, state in states
        ]
        kind, shape = (
            "i8" if name == "index" else "f8",
            (len(states), *(sizes[dim] for dim in dims)),
        )
        setattr(table, name, np.array(column, kind).reshape(shape))
    return table_variables(DIM, DIM, USER_EVENT, table)


def index_of(solution) -> dict[str, Any] | None:
    """Return the number of events that were asked for, and which has ended the run, for the index of a file."""
    if solution.t_events is None:
        return None
    return {"count": len(solution.t_events), "stopped_by": solution._stopped_by}


def from_file(arrays, index: dict[str, Any] | None, scene) -> dict[str, Any]:
    """Return the fields of a solution about its events; none for a file of a run without events.

    Raises
    ------
    ValueError, KeyError, TypeError
        If the index and the arrays do not fit.
    """
    if index is None:
        return {}
    count = checks.integer("number of events", index["count"], least=0, most=len(arrays.data))
    columns = {
        name: arrays.array(f"{DIM}_{name}", (DIM, *dims), "i8" if name == "index" else "f8")
        for name, (dims, _, _) in USER_EVENT.items()
    }
    which = columns["index"]
    if which.size and not (which.min() >= 0 and which.max() < count):
        raise ValueError(f"{DIM}_index has numbers outside 0 to {count - 1}")
    numbers = (columns[name].tolist() for name in ("time", *ENERGIES))
    motion = zip(*(columns[name] for name in BODIES))
    states = [
        SystemState._of_file(scene, t, kinetic, potential, one)
        for t, kinetic, potential, one in zip(*numbers, motion)
    ]
    own = [[state for k, state in zip(which, states) if k == event] for event in range(count)]
    return {
        "t_events": [np.array([state.t for state in some]) for some in own],
        "state_events": own,
        "_stopped_by": str(index["stopped_by"]),
    }
