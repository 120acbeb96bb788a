"""Degrees of freedom and redundant constraints of a scene, from its constraint rows at the start."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.geometry import quaternion
from carom.options import Options

DEPENDENT = 1e-8  # of the largest singular value of rows of length 1
TAKES_PART = 1e-6  # of a vector of length 1


@dataclass(frozen=True)
class Mobility:
    """How a scene can move at its start. Print it for a summary.

    Attributes
    ----------
    bodies : int
    rows : int
        Constraint rows of all joints.
    redundant : int
        How many of them follow from the others: their reactions are not unique.
    degrees_of_freedom : int
        6 bodies - rows + redundant: independent velocities.
    nonholonomic : int
        Of the independent rows, those that restrict velocities only (`KnifeEdge`): with them there are
        `degrees_of_freedom` + `nonholonomic` independent displacements.
    redundant_joints : tuple of str
        Names of the joints that have a part in a redundancy: any one of it could be given up.
    velocity_errors : dict of str to float
        How much the initial velocities break each joint [m/s; angular ones times the size of the body].
        `Options(project_start=True)` takes that out.
    """

    bodies: int
    rows: int
    redundant: int
    degrees_of_freedom: int
    nonholonomic: int
    redundant_joints: tuple[str, ...]
    velocity_errors: dict[str, float]

    def __str__(self) -> str:
        lines = [
            f"{self.bodies} bodies, {self.rows} constraint rows: {self.degrees_of_freedom} degrees of freedom"
        ]
        if self.nonholonomic:
            lines.append(f"{self.nonholonomic} rows restrict velocities only")
        if self.redundant:
            lines.append(
                f"{self.redundant} redundant rows, among {', '.join(self.redundant_joints)}"
            )
        worst = max(self.velocity_errors, key=self.velocity_errors.__getitem__, default=None)
        if worst is not None and self.velocity_errors[worst] > 0.0:
            lines.append(
                f"initial velocities break {worst} most, by {self.velocity_errors[worst]:.3g} m/s"
            )
        return "\n".join(lines)


def mobility(scene) -> Mobility:
    """Return the degrees of freedom of a scene and which rows are redundant."""
    from carom.motion.multipliers import constraint_rows, mass_matrix
    from carom.system.compile import compile_scene

    n, joints = len(scene.bodies), scene.joints
    if not joints:
        return Mobility(n, 0, 0, 6 * n, 0, (), {})
    compiled = compile_scene(scene, Options(), loops=True)  # no joint is flipped
    system, start = compiled.system, compiled.start
    state = [np.array(a)[None] for a in (start.x, start.Q, start.v, start.w)]
    A, _, owner = constraint_rows(system, *state)
    A = A[0]
    spin = quaternion.rotate_back(start.Q, start.w)
    speeds = np.einsum("knc,nc->k", A, np.concatenate([start.v, spin], axis=1))
    turning = ~np.any(A[..., :3], axis=(1, 2))
    speeds[turning] *= system.bodies.extent[system.joints.child[owner[turning]]]
    dependent, involved = _dependent(A / np.sqrt(mass_matrix(system)), owner, system)
    blades = np.array([joint.kind == "KnifeEdge" for joint in joints])[owner]
    return Mobility(
        bodies=n,
        rows=len(A),
        redundant=dependent,
        degrees_of_freedom=6 * n - len(A) + dependent,
        nonholonomic=int(np.sum(blades)),
        redundant_joints=tuple(joints[j].name for j in np.flatnonzero(involved)),
        velocity_errors={
            joint.name: float(np.max(np.abs(speeds[owner == j]))) for j, joint in enumerate(joints)
        },
    )


def _dependent(A, owner, system) -> tuple[int, np.ndarray]:
    """Return how many rows (K, N, 6) depend on others, and (J,) which joints have a part in that.

    Only joints in loops can; a joint with a side that nothing else holds is none, and leaves others so.
    """
    kept = np.ones(len(system.joints), dtype=bool)
    parent, child = system.joints.parent, system.joints.child
    while True:
        degree = np.zeros(len(system.bodies) + 1, dtype=np.int64)
        np.add.at(degree, parent[kept], 1)
        np.add.at(degree, child[kept], 1)
        degree[-1] = 2  # the ground holds by itself
        loose = kept & ((degree[parent] == 1) | (degree[child] == 1))
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
    rank = int(np.sum(size > DEPENDENT * size[0]))
    part = np.linalg.norm(left[:, rank:], axis=1) > TAKES_PART
    involved[owner[rows[part]]] = True
    return len(rows) - rank, involved
