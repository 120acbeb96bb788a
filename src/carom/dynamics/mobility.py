"""Degrees of freedom and redundant constraints of a scene, from its constraint rows at the start."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.dynamics.thresholds import PARTICIPATION, RANK
from carom.geometry import quaternion
from carom.model.relations import is_inertia, is_joint
from carom.options import Options
from carom.scene.remarks import remarks


@dataclass(frozen=True)
class Mobility:
    """Degrees of freedom and constraints of a scene in its initial position. Print it for a summary.

    Attributes
    ----------
    bodies : int
        Number of bodies.
    rows : int
        Number of constraint rows of all joints and constraints.
    redundant : int
        Number of redundant rows, which follow from the others; their reactions are not unique.
    degrees_of_freedom : int
        Number of independent velocities: 6 bodies - rows + redundant.
    nonholonomic : int
        Number of independent rows that restrict only velocities (blades, rolling). There are
        `degrees_of_freedom` + `nonholonomic` independent displacements.
    redundant_joints : tuple of str
        Names of the joints that take part in a redundancy; one of them could be left out.
    velocity_errors : dict of str to float
        Error of the initial velocities in each joint [m/s; angular ones times the size of the body].
        `Options(project_start=True)` removes it.
    remarks : tuple of str
        Sentences about input that is nearly always a mistake; `simulate` warns about it.
    """

    bodies: int
    rows: int
    redundant: int
    degrees_of_freedom: int
    nonholonomic: int
    redundant_joints: tuple[str, ...]
    velocity_errors: dict[str, float]
    remarks: tuple[str, ...] = ()

    def __str__(self) -> str:
        lines = [
            f"{self.bodies} bodies, {self.rows} constraint rows: {self.degrees_of_freedom} degrees of freedom"
        ]
        if self.nonholonomic:
            lines.append(f"{self.nonholonomic} rows restrict only velocities")
        if self.redundant:
            lines.append(
                f"{self.redundant} redundant rows, among {', '.join(self.redundant_joints)}"
            )
        worst = max(self.velocity_errors, key=self.velocity_errors.__getitem__, default=None)
        if worst is not None and self.velocity_errors[worst] > 0.0:
            lines.append(
                f"initial velocities violate {worst} most, by {self.velocity_errors[worst]:.3g} m/s"
            )
        return "\n".join([*lines, *self.remarks])


def mobility(scene) -> Mobility:
    """Return the degrees of freedom of a scene and which rows are redundant."""
    from carom.dynamics.reactions import start_errors
    from carom.model.compile import compile_scene
    from carom.model.records import new_work

    n, joints = len(scene.bodies), (*scene.joints, *scene.constraints)
    if not joints:
        return Mobility(n, 0, 0, 6 * n, 0, (), {}, remarks(scene))
    compiled = compile_scene(scene, Options(), loops=True)  # no joint is flipped
    system, start = compiled.system, compiled.start
    work = new_work(system, 1)
    A, owner = dense_rows(system, start, work)
    errors = np.zeros((2, len(system.joints), 6))
    start_errors(system, start, work, *errors)
    if compiled.functions.failed is not None:
        raise compiled.functions.failed
    speeds = np.concatenate([errors[1, j, : system.joints.rows[j]] for j in range(len(joints))])
    turning = ~np.any(A[..., :3], axis=(1, 2))
    speeds[turning] *= system.bodies.extent[system.joints.child[owner[turning]]]
    dependent, involved = _dependent(A / np.sqrt(mass_matrix(system)), owner, system)
    rolling = sum(_nonholonomic(joint) for joint in joints)
    return Mobility(
        bodies=n,
        rows=len(A),
        redundant=dependent,
        degrees_of_freedom=6 * n - len(A) + dependent,
        nonholonomic=rolling,
        redundant_joints=tuple(joints[j].name for j in np.flatnonzero(involved)),
        velocity_errors={
            joint.name: float(np.max(np.abs(speeds[owner == j]))) for j, joint in enumerate(joints)
        },
        remarks=remarks(scene),
    )


def mass_matrix(system) -> np.ndarray:
    """Return the diagonal of the metric (N, 6) in the left-invariant frame."""
    bodies = system.bodies
    return np.concatenate([np.repeat(bodies.mass[:, None], 3, axis=1), bodies.inertia], axis=1)


def dense_rows(system, start, work, rotors: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Return all rows (K, N, 6), linear in world axes and angular in principal ones, and their elements.

    Rotors have rows too, which are no constraints.
    """
    from carom.dynamics.reactions import write_rows

    write_rows(system, start, work)
    count = system.joints.rows.copy()
    count[is_inertia(system.joints) & (not rotors)] = 0
    first = np.cumsum(count) - count
    A = np.zeros((int(count.sum()), len(system.bodies), 6))
    for side in system.solver.sides:
        j, b = int(side.element), int(side.body)
        rows = side.A[: count[j]].copy()
        rows[:, 3:] = quaternion.rotate_back(start.Q[b], rows[:, 3:])
        A[first[j] : first[j] + count[j], b] = rows
    return A, np.repeat(np.arange(len(count)), count)


def _nonholonomic(element) -> int:
    """Return how many rows of an element restrict velocities only."""
    if element.kind == "Rows":
        return element.rows if element.definition.position is None else 0
    return getattr(element.definition, "nonholonomic", 0)


def _dependent(A, owner, system) -> tuple[int, np.ndarray]:
    """Return how many rows (K, N, 6) depend on others, and (J,) which joints take part in this.

    Only elements in loops can. A joint is in no loop if no other element acts on one of its bodies; it is
    removed, and then further joints may be in no loop.
    """
    kept = ~is_inertia(system.joints)
    parent, child = system.joints.parent, system.joints.child
    joint = is_joint(system.joints)
    while True:
        degree = np.zeros(len(system.bodies) + 1, dtype=np.int64)
        sides = system.solver.sides[kept[system.solver.sides.element]]
        np.add.at(degree, sides.body, 1)
        degree[-1] = 2  # the ground is fixed by itself
        loose = kept & joint & ((degree[parent] == 1) | (degree[child] == 1))
        if not loose.any():
            break
        kept &= ~loose
    involved = np.zeros(len(kept), dtype=bool)
    rows = np.flatnonzero(kept[owner])
    if rows.size == 0:
        return 0, involved
    matrix = A[rows].reshape(len(rows), -1)
    matrix = matrix / np.linalg.norm(matrix, axis=1, keepdims=True)
    left, size, _ = np.linalg.svd(matrix)
    rank = int(np.sum(size > RANK * size[0]))
    part = np.linalg.norm(left[:, rank:], axis=1) > PARTICIPATION
    involved[owner[rows[part]]] = True
    return len(rows) - rank, involved
