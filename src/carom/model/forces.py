"""The tables of forces, one for each kind, as their definitions state them (`carom.scene.forces`)."""

from __future__ import annotations

from collections import namedtuple
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.scene.force_definition import BODIES
from carom.scene.forces import TABLES

#: the forces of a scene, which kernels read: a table of records for each kind, of its name
Forces = namedtuple("Forces", [kind.name for kind in TABLES])
#: dry friction is no table here: it acts through the rows of joints
FRICTIONS = -1


class Place(NamedTuple):
    """Where kernels find a force: its rows in the table of its kind."""

    kind: int  # place of the table in `Forces`, or `FRICTIONS`
    first: int
    last: int


def no_forces() -> Forces:
    """Return the tables of a scene without forces."""
    return Forces(*(table(kind.columns, 0) for kind in TABLES))


def bodies_in(rows: np.recarray) -> list[str]:
    """Return the columns of a table that are numbers of bodies."""
    return [name for name in BODIES if name in (rows.dtype.names or ())]


def renumbered(forces: Forces, place: np.ndarray) -> Forces:
    """Return a copy of all tables with each number of a body replaced by its place."""
    copies = [rows.copy() for rows in forces]
    for rows in copies:
        for name in bodies_in(rows):
            rows[name] = place[rows[name]]
    return Forces(*copies)


def settable(forces: Forces) -> list[np.ndarray]:
    """Return the columns that a run may set between two steps."""
    pairs = zip(TABLES, forces, strict=True)
    return [rows[name] for kind, rows in pairs for name in kind.settable]
