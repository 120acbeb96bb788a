"""The records of a run as plain arrays: what derived properties of a solution are made from.

Columns that are bit for bit equal to a labelled variable are not written a second time.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table as new_table
from carom.model import records as r
from carom.model.arrays import STATE
from carom.scene.materials import IMPACT_LAWS

GROUP = "records"
FIELDS = {
    "series": r.SERIES, "state": STATE, "turn": r.TURN, "touch": r.TOUCH, "impact": r.IMPACTS, "event": r.EVENT,
    "snapshot": r.SNAPSHOT,
}  # fmt: skip
#: first dimensions; those of vectors follow
DIMS = {
    "series": ("time",), "state": ("time", "body"), "turn": ("time", "turn"), "touch": ("held",),
    "impact": ("impact",), "event": ("event",), "snapshot": ("snapshot",),
}  # fmt: skip
TAILS = {(): (), (3,): ("axis",), (4,): ("quaternion",), (3, 3): ("axis", "contact_axis")}
#: where a labelled variable may hold a column
SAME = {
    "series_t": "time", "series_residual": "held_residual",
    **{f"series_{name}": f"{name}_energy" for name, _ in r.ENERGIES},
    **{f"series_{name}": f"ledger_{name}" for name, _ in r.LEDGER},
    "state_x": "position", "state_Q": "orientation", "state_v": "velocity",
    "state_w": "angular_velocity",
    "impact_W": "impact_inverse_mass", "impact_before": "impact_relative_velocity_before",
    "impact_after": "impact_relative_velocity_after",
    **{
        f"impact_{name}": f"impact_{name}"
        for name in (
            "time", "contact", "point", "normal", "impulse", "energy_change", "duration",
            "together", "compression_work", "restitution_work", "friction_loss",
        )
    },
    "event_time": "event_time", "event_contact": "event_contact",
    **{f"touch_{name}": f"held_{name}" for name in ("saved", "contact", "body", "other", "point")},
    "touch_force": "held_force", "touch_push": "held_vector",
}  # fmt: skip
#: columns that files of earlier versions do not have, and that are 0 where they are left out
LATER = ("touch_power",)
#: variables of words, of which there are ten at most
WORDS = {
    "impact_law": IMPACT_LAWS, "event_kind": r.EVENTS, "interval_mode": ("open", "slipping", "sticking"),
}  # fmt: skip


class Column(NamedTuple):
    """A column of a table of records."""

    name: str
    dims: tuple[str, ...]
    data: np.ndarray


def columns(records: r.Records, labelled: Mapping[str, np.ndarray]) -> list[Column]:
    """Return the columns of `records` that are not in `labelled`."""
    out = []
    for table, fields in FIELDS.items():
        for field in fields:
            name, data = f"{table}_{field[0]}", getattr(records, table)[field[0]]
            same = labelled.get(SAME.get(name, ""))
            if (same is not None and _same_bits(data, same)) or (name in LATER and not data.any()):
                continue
            tail = TAILS[data.shape[len(DIMS[table]) :]]
            out.append(Column(name, (*DIMS[table], *tail), np.ascontiguousarray(data)))
    return out


def from_columns(read, sizes: Mapping[str, int]) -> r.Records:
    """Return records; `read` gives a column of a shape and a type by its name, or that of the same variable."""
    tables = {}
    for table, fields in FIELDS.items():
        made = new_table(fields, *(sizes[dim] for dim in DIMS[table]))
        for field in fields:
            name, column = f"{table}_{field[0]}", made[field[0]]
            made[field[0]] = read(name, SAME.get(name, ""), column.shape, column.dtype)
        tables[table] = made
    return r.Records(**tables)


def _same_bits(a: np.ndarray, b: np.ndarray) -> bool:
    if a.shape != b.shape or a.dtype != b.dtype:
        return False
    a, b = np.ascontiguousarray(a), np.ascontiguousarray(b)
    return bool(np.array_equal(a.reshape(-1).view("u8"), b.reshape(-1).view("u8")))
