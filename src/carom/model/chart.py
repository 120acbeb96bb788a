"""A system in coordinates of the user's own, as arrays: body b of its scene stands for coordinate b.

Its place along the first axis is the coordinate by its size, x[0] = q_b / scale_b; nothing else of it moves.
The functions of the system are called as ``f(t, x, out)`` with x = (q, v) (`carom._compiled.user_functions`);
the layout of their results is defined here. Each keeps its results with the state that they belong to, so they
are called once for a state.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from carom._compiled.record_arrays import table

#: the four functions, by their place in `Chart.functions`
CALL_INERTIA = 0  # M (n, n), Gamma_kij v_i v_j (n,), first kind
CALL_LOADS = 1  # V, generalised forces Q - dV (n,), power Q.v of those that have no potential
CALL_ROWS = 2  # phi (h,), A (k, n), (dA/dt) v (k,)
CALL_CONTACTS = 3  # gap (C,), G (C, 3, n), (dG/dt) v (C, 3)

#: the user's functions that make them, by their place in `parts`; at the end gap and tangents of each contact
OF_METRIC, OF_POTENTIAL, OF_FORCE, OF_CONSTRAINT, OF_ROWS, OF_CONTACT = range(6)

ROWS_OF_ELEMENT = 6  # constraints are elements of at most so many rows each

#: a function, 0 if the system lacks it, or has parts
FUNCTION = [("address", "i8")]

#: a part of one: a function and its derivative, 0 for none, and the number of results
PART = [("address", "i8"), ("slope_address", "i8"), ("results", "i8")]


class Chart(NamedTuple):
    """A system of n coordinates with k rows of constraints and C contacts; empty for scenes of bodies."""

    n: int
    holonomic: int  # constraints phi
    rows: int  # of all constraints
    contacts: int
    drop: float  # a row is left out if its pivot is below this part of its diagonal
    functions: np.recarray  # (4,) FUNCTION
    parts: np.recarray  # (P,) PART
    scale: np.ndarray  # (n,) size of each coordinate in its unit
    # workspace: what the functions returned, then views of it
    arguments: np.ndarray  # (4, 2n+1) arguments (q, v, t) of the last calls
    inertia: np.ndarray
    loads: np.ndarray
    constraints: np.ndarray
    touching: np.ndarray
    M: np.ndarray  # (n, n)
    c: np.ndarray  # (n,)
    load: np.ndarray  # (n,) generalised forces Q - dV
    phi: np.ndarray  # (h,)
    A: np.ndarray  # (k, n)
    A_rate: np.ndarray  # (k,)
    gap: np.ndarray  # (C,)
    G: np.ndarray  # (C, 3, n)
    G_rate: np.ndarray  # (C, 3)
    # of the solve
    pose: np.ndarray  # (n,) coordinates of the factors
    L: np.ndarray  # (n, n) M = L D L^T, D on the diagonal
    Z: np.ndarray  # (k, n) M^-1 A
    K: np.ndarray  # (k, k) A M^-1 A^T and its factor
    singular: np.ndarray  # (1,) 1 if M was singular, though finite, when it was factored last
    a: np.ndarray  # (n,)
    multiplier: np.ndarray  # (k,)
    # of calls and differences
    x: np.ndarray  # (2n,) the state (q, v), in the units of the user
    point: np.ndarray  # (n,)
    axis: np.ndarray  # (n,) 0, or one axis
    sample: np.ndarray  # results there
    slope: np.ndarray  # (n, m) derivatives of m results


def new_chart(sizes: tuple[int, ...], scale: np.ndarray, drop: float, functions, parts) -> Chart:
    """Return the arrays of a system; `sizes` are n, h, k and C, the last two rows of FUNCTION and PART."""
    n, h, k, C = sizes
    most, row, touch = max(n, k, 2) * n, h + k * n, C * (1 + 3 * n)
    inertia, loads = np.zeros(n * n + n), np.zeros(n + 2)
    constraints, touching = np.zeros(row + k), np.zeros(touch + 3 * C)
    called, listed = table(FUNCTION, len(functions)), table(PART, len(parts))
    called["address"] = functions
    for (name, _), column in zip(PART, zip(*parts)):
        listed[name] = column
    views: dict[str, Any] = {
        "inertia": inertia, "M": inertia[: n * n].reshape(n, n), "c": inertia[n * n :],
        "loads": loads, "load": loads[1 : n + 1],
        "constraints": constraints, "phi": constraints[:h], "A": constraints[h:row].reshape(k, n),
        "A_rate": constraints[row:],
        "touching": touching, "gap": touching[:C], "G": touching[C:touch].reshape(C, 3, n),
        "G_rate": touching[touch:].reshape(C, 3),
    }  # fmt: skip
    shapes = {
        "pose": n, "singular": 1, "L": (n, n), "Z": (k, n), "K": (k, k), "a": n, "multiplier": k, "x": 2 * n,
        "point": n, "axis": n, "sample": most, "slope": n * most,
    }  # fmt: skip
    chart = {name: np.zeros(shape) for name, shape in shapes.items()}
    made = Chart(
        n=n, holonomic=h, rows=k, contacts=C, drop=drop, functions=called, parts=listed,
        scale=scale,
        arguments=np.zeros((4, 2 * n + 1 if n > 0 else 0)), **views, **chart,
    )  # fmt: skip
    forget_state(made)
    return made


def forget_state(chart: Chart) -> None:
    """Forget all results: functions that Python calls may have changed."""
    chart.arguments[:], chart.pose[:] = np.nan, np.nan


@cache
def no_chart() -> Chart:
    """Return the arrays of a scene of bodies."""
    return new_chart((0, 0, 0, 0), np.zeros(0), 0.0, [], [])
