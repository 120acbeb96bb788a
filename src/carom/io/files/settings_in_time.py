"""What the forces of a `carom.Run` were set to as it went, in a file."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom import checks
from carom.model.switched import NOTHING_SWITCHED, SWITCHED
from carom.scene.forces import Force, Torque
from carom.scene.switches import SWITCHABLE

#: rows that were saved before, index of the force, and its value: a number has two zeros after it
ROW = np.dtype([("row", "<i8"), ("force", "<i8"), ("value", "<f8", 3)])


def as_rows(history: list[tuple[int, int, Any]] | None) -> np.ndarray | None:
    """Return a table of the forces and controls that were set; None for the run of `simulate`."""
    if history is None:
        return None
    table = np.zeros(len(history), ROW)
    for k, (row, force, value) in enumerate(history):
        table[k] = row, force, value if np.ndim(value) else (value, 0.0, 0.0)
    return table


def from_rows(data: memoryview, note, scene) -> list[tuple[int, int, Any]] | None:
    """Return what `as_rows` has made a table of, from its length and place in a file.

    Raises
    ------
    TypeError, ValueError
        If it is not in the file, or names a force that the scene does not have.
    """
    if note is None:
        return None
    table = _table(data, note, ROW, "history")
    kinds = [type(force.definition) for force in scene.forces]
    inside = (table["force"] >= 0) & (table["force"] < len(kinds)) & (table["row"] >= 0)
    if not (inside.all() and np.isfinite(table["value"]).all()):
        raise ValueError("history must have forces of the scene and finite values")
    return [
        (row, force, np.array(value) if kinds[force] in (Force, Torque) else value[0])
        for row, force, value in zip(*(table[name].tolist() for name in ROW.names or ()))
    ]


def switched_from(data: memoryview, note, scene) -> np.ndarray:
    """Read the switches that acted in a run, in the order of time.

    Raises
    ------
    TypeError, ValueError
        If it is not in the file, or has a part or a switch that the scene does not have.
    """
    if note is None:
        return NOTHING_SWITCHED
    table, parts = _table(data, note, SWITCHED, "switched"), list(scene)
    known = (table["part"] >= 0) & (table["part"] < len(parts))
    known &= (table["switch"] >= -1) & (table["switch"] < len(scene.switches))
    known &= (table["row"] >= 1) & (table["on"] >= 0) & (table["on"] <= 1)
    finite = all(np.isfinite(table[name]).all() for name in ("time", "energy", "placed"))
    ordered = np.all(np.diff(table["row"]) >= 0) and np.all(np.diff(table["time"]) >= 0.0)
    if not (known.all() and finite and ordered):
        raise ValueError("switched must have parts and switches of the scene, in the order of time")
    if not all(isinstance(parts[k], SWITCHABLE) for k in table["part"].tolist()):
        raise ValueError("switched must have parts that a switch may take away")
    return table


def _table(data: memoryview, note, kind: np.dtype, name: str) -> np.ndarray:
    """Return a table from its length and place in a file."""
    count = checks.integer(f"length of {name}", note[0], least=0, most=len(data) // kind.itemsize)
    most = len(data) - count * kind.itemsize
    place = checks.integer(f"place of {name}", note[1], least=0, most=most)
    return np.frombuffer(data, kind, count, place)
