"""The elements of a mechanism that lock: where a run failed their rows depend on each other, as in a dead end.

With the rows A (K, 6 N) of joints and drivers, each of length 1 in the kinetic metric, a position is singular
if the smallest of the singular values of A that are not zero at the start becomes zero. The rows in its left
singular vector y take part: y A = 0. If one of them is that of a driver, y A v = 0 forbids the motion that the
driver prescribes: the mechanism has come to the end of its reach.
"""

from __future__ import annotations

import numpy as np

from carom.dynamics.mobility import dense_rows, mass_matrix
from carom.dynamics.thresholds import RANK
from carom.model.compile import compile_scene
from carom.model.records import new_work
from carom.options import Options
from carom.scene.constraints import Driver, Rows
from carom.status import Status

#: failures that a singular position may have caused
OF_ROWS = (Status.CONSTRAINTS_LOST, Status.STEP_TOO_SMALL, Status.UNSTABLE, Status.NO_CONVERGENCE)
#: smallest singular value, relative to that at the start, below which a position counts as singular: a run ends
#: at a distance d before a dead end, where it is sqrt(2 d), 1e-5 to 8e-2 for steps up to 1e-2 s
SINGULAR = 0.2
PART = 0.03  # least component of an element that takes part, in a vector of length 1
MOST_ROWS = 1000  # for more nothing is said, because the decomposition takes seconds


def locked(run, status: Status) -> str:
    """Return a sentence about the elements that lock where a run has ended; "" if none do."""
    elements = (*run.scene.joints, *run.scene.constraints)
    if status not in OF_ROWS or not elements:
        return ""
    compiled = compile_scene(run.scene, Options(), loops=True)
    if not 0 < sum(compiled.system.joints.rows) <= MOST_ROWS:
        return ""
    size, _, owner = decomposed(compiled.system, compiled.start, 0.0)
    rank = int(np.sum(size > RANK * size[0]))
    now, left, _ = decomposed(compiled.system, run.now, run.reached)
    if not now[rank - 1] < SINGULAR * size[rank - 1]:
        return ""
    part = np.sqrt(np.bincount(owner, left[:, rank - 1] ** 2, minlength=len(elements)))
    found = [element for element, size in zip(elements, part) if size > PART]
    drivers = [one for one in found if isinstance(one.definition, (Driver, Rows))]
    names = ", ".join(repr(one.name) for one in found if one not in drivers)
    where = f"the mechanism locks at t = {run.reached:.9g} s"
    if not drivers:
        return (
            f"{where}: in this singular position the constraints of {names} depend on each other. Change "
            "lengths or initial positions, so that the motion does not come here."
        )
    named = " and ".join(repr(one.name) for one in drivers)
    return (
        f"{where}: {named} can be followed no further, because {names} have come to the end of their reach (a "
        f"dead end). End the motion of {named} before it, change the lengths of the parts between them, or "
        "use a force (forces.JointForce) instead."
    )


def decomposed(system, state, t: float):
    """Return the singular values, left vectors and elements of the rows at a state, each row of length 1."""
    work = new_work(system, 1)
    work.moment[0].time = t
    A, owner = dense_rows(system, state, work)
    rows = (A / np.sqrt(mass_matrix(system))).reshape(len(A), -1)
    length = np.linalg.norm(rows, axis=1, keepdims=True)
    left, size, _ = np.linalg.svd(rows / np.maximum(length, 1e-300))
    return size, left, owner
