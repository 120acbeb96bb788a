"""What the forces of a `carom.Run` were set to as it went, in a file."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom import checks
from carom.scene.forces import Force, Torque

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
    count = checks.integer("length of history", note[0], least=0, most=len(data) // ROW.itemsize)
    most = len(data) - count * ROW.itemsize
    table = np.frombuffer(
        data, ROW, count, checks.integer("place of history", note[1], least=0, most=most)
    )
    kinds = [type(force.definition) for force in scene.forces]
    inside = (table["force"] >= 0) & (table["force"] < len(kinds)) & (table["row"] >= 0)
    if not (inside.all() and np.isfinite(table["value"]).all()):
        raise ValueError("history must have forces of the scene and finite values")
    return [
        (row, force, np.array(value) if kinds[force] in (Force, Torque) else value[0])
        for row, force, value in zip(*(table[name].tolist() for name in ROW.names or ()))
    ]
