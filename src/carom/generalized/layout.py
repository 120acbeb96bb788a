"""The arrays of a `GeneralizedSystem` for the kernels: the system, the modes of its contacts, workspace.

A state is one array ``x = (q, v)`` of 2n numbers. The kernels call the functions of the user as four functions
``f(t, x, out)`` (`carom._compiled.user_functions`); the layout of their results is defined here.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.model.actions import NO_EVENT
from carom.model.laws import Laws
from carom.model.method import Method
from carom.model.workspace import SEARCH
from carom.stepping.grid import Grid

# The four functions, by their place in `Coordinates.address`.
CALL_INERTIA = 0  #: M (n, n), Gamma_kij v_i v_j (n,), first kind
CALL_LOADS = 1  #: V, generalised forces Q - dV (n,), power Q.v of those that have no potential
CALL_ROWS = 2  #: phi (h,), A (k, n), (dA/dt) v (k,)
CALL_CONTACTS = 3  #: gap (C,), G (C, 3, n), (dG/dt) v (C, 3)

# The user's functions that make them, by their place in `Coordinates.part`; at the end gap and tangents of each
# contact.
OF_METRIC, OF_POTENTIAL, OF_FORCE, OF_CONSTRAINT, OF_ROWS, OF_CONTACT = range(6)

# An event ended a call of the loop; other codes are `carom.model.records.PAUSE`, and those of `carom.status`.
EVENT = 100


class Coordinates(NamedTuple):
    """A system: its functions, sizes, and the laws of its contacts, by their number."""

    address: np.ndarray  # (4,) int64; 0 for a function that the system lacks, or that has parts
    # (P, 3) int64 addresses of a function and of its derivative, 0 for none, and the number of results
    part: np.ndarray
    n: int  # coordinates
    holonomic: int  # constraints phi
    rows: int  # of all constraints
    contacts: int
    laws: Laws
    drop: float  # a row is left out if its pivot is below this part of its diagonal


class Work(NamedTuple):
    """Workspace. The first four arrays are results of the functions, the next nine are views of them."""

    inertia: np.ndarray
    loads: np.ndarray
    rows: np.ndarray
    contacts: np.ndarray
    M: np.ndarray  # (n, n)
    c: np.ndarray  # (n,)
    load: np.ndarray  # (n,) generalised forces Q - dV
    phi: np.ndarray  # (h,)
    A: np.ndarray  # (k, n)
    A_rate: np.ndarray  # (k,)
    gap: np.ndarray  # (C,)
    G: np.ndarray  # (C, 3, n)
    G_rate: np.ndarray  # (C, 3)
    L: np.ndarray  # (n, n) M = L D L^T, D on the diagonal
    a: np.ndarray  # (n,)
    sum: (
        np.ndarray
    )  # (n,) greatest sum of the terms of each acceleration, in the stages of the last step
    R: np.ndarray  # (m, n) rows that must keep their rate
    D: np.ndarray  # (m, n) directions of their reactions: R itself, except for a slipping contact
    Z: np.ndarray  # (m, n) M^-1 D
    K: np.ndarray  # (m, m) R M^-1 D and its factors
    inverse: np.ndarray  # (m,) inverse pivots, 0 for a row left out
    rhs: np.ndarray  # (m,), then the multipliers
    stages: np.ndarray  # (S, 2n)
    trial: np.ndarray  # (2n,)
    end: np.ndarray  # (2n,)
    margin: np.ndarray  # (NO_EVENT, C) the function of each kind of event
    nothing: np.ndarray  # (NO_EVENT, C) what is round-off of it
    before: np.ndarray  # (2, C) gaps and their rates at the start of a step
    row_scale: np.ndarray  # (h,) greatest sum |A_j q_j|
    gap_scale: np.ndarray  # (C,) the same of the gaps, or the greatest gap
    point: np.ndarray  # (n,) of differences
    axis: np.ndarray  # (n,) 0, or one axis
    sample: np.ndarray  # results there
    slope: np.ndarray  # (n, m) derivatives of m results
    search: np.recarray  # (1,) SEARCH, of an event
    spent: (
        np.ndarray
    )  # (3,) work of loads and of friction in the last step, kinetic energy at its start


#: a contact: its mode; while it persists, first row of R, direction of slip, force with the normal first,
#: and W_nn - mu W_nt.heading of one that slips
CONTACT = [
    ("mode", "i8"), ("row", "i8"), ("heading", "f8", 2), ("force", "f8", 3), ("yields", "f8"),
]  # fmt: skip


class Motion(NamedTuple):
    """The data of a step other than the state: the system, the method, the modes of contacts, workspace."""

    system: Coordinates
    method: Method
    active: np.recarray  # (C,) CONTACT
    work: Work


class Plan(NamedTuple):
    """The length of a run, its steps, and which states it saves."""

    duration: float
    step: float  # the longest
    grid: Grid
    order: int  # of the method, if tolerances choose the steps; else 0
    rtol: float
    atol: float


#: progress of a run, of which a copy is kept for each saved state: time, counts, energies and works
CLOCK = [
    ("now", "f8"), ("step", "i8"), ("saved", "i8"), ("kind", "i8"), ("index", "i8"), ("trials", "i8"),
    ("kinetic", "f8"), ("potential", "f8"), ("loads", "f8"), ("impacts", "f8"), ("friction", "f8"),
    ("bounces", "f8"),
    ("exchanged", "f8"),  # greatest kinetic energy, and greatest work, so far
    ("given", "f8"),  # energy that impacts have added where their law allows it (V8)
    # the next step by tolerances, the length that fitted them last, number of steps with too large an error,
    # and of those in a row that failed at a kink (`carom.dynamics.adapt`)
    ("ahead", "f8"), ("fits", "f8"), ("rejected", "i8"), ("kinks", "i8"),
    ("slow", "i8"),  # trial steps so short that the run would not end
]  # fmt: skip


class Record(NamedTuple):
    """The clock of a run and the states that it has saved."""

    clock: np.recarray  # (1,) CLOCK
    series: np.recarray  # (rows,) CLOCK
    states: np.ndarray  # (rows, 2n)


def new_work(system: Coordinates, stages: int) -> Work:
    """Return workspace for a system and a method with this number of stages."""
    n, holonomic, rows, contacts = system.n, system.holonomic, system.rows, system.contacts
    m, most = rows + 3 * contacts, max(n, rows, 2) * n
    k, g = holonomic + rows * n, contacts * (1 + 3 * n)
    inertia, loads = np.zeros(n * n + n), np.zeros(n + 2)
    row, touch = np.zeros(k + rows), np.zeros(g + 3 * contacts)
    results = {
        "inertia": inertia, "M": inertia[: n * n].reshape(n, n), "c": inertia[n * n :],
        "loads": loads, "load": loads[1:-1],
        "rows": row, "phi": row[:holonomic], "A": row[holonomic:k].reshape(rows, n), "A_rate": row[k:],
        "contacts": touch, "gap": touch[:contacts], "G": touch[contacts:g].reshape(contacts, 3, n),
        "G_rate": touch[g:].reshape(contacts, 3),
    }  # fmt: skip
    shapes = {
        "L": (n, n), "a": n, "sum": n, "R": (m, n), "D": (m, n), "Z": (m, n), "K": (m, m), "inverse": m,
        "rhs": m, "stages": (stages, 2 * n), "trial": 2 * n, "end": 2 * n, "row_scale": holonomic,
        "gap_scale": contacts, "margin": (NO_EVENT, contacts), "nothing": (NO_EVENT, contacts),
        "before": (2, contacts), "point": n, "axis": n, "sample": most, "slope": n * most, "spent": 3,
    }  # fmt: skip
    own = {name: np.zeros(shape) for name, shape in shapes.items()}
    return Work(**results, **own, search=table(SEARCH, 1))
