"""Build the arrays of the back end that a scene needs."""

from __future__ import annotations

from functools import cache

import numpy as np

from carom._compiled.record_arrays import table
from carom.model.arrays import (
    FOREST,
    HEAD,
    LINK,
    LOOPS,
    METRIC,
    NO_JOINTS,
    ROW,
    SIDE,
    WIDTH,
    Solver,
)
from carom.model.graph import Sets, elimination


@cache
def no_joints() -> Solver:
    """Return the back end of bodies without joints: nothing is written to it."""
    number = np.zeros(0, dtype=np.int64)
    return Solver(
        kind=NO_JOINTS, links=table(LINK, 0), rotor=np.zeros((0, 0)), workspace=np.zeros((0, 0)),
        order=number, column=number, row=number, update=number, triple=number.reshape(0, 3),
        term=number.reshape(0, 3), rows=table(ROW, 0), sides=table(SIDE, 0),
        block=np.zeros((0, 6, 6)), drop=0.0, pose=np.zeros((0, 7)), usual=np.full(1, -1),
        fine=np.zeros((2, 0, 6, 6)), digits=np.zeros((0, 4, 6)), scaled=np.zeros((0, 3, 6)),
    )  # fmt: skip


def metric_solver(constraints: int) -> Solver:
    """Return the back end of coordinates of the user's own, with so many elements of constraints."""
    return no_joints()._replace(kind=METRIC, rows=table(ROW, constraints), usual=np.full(1, -1))


def tree_solver(
    joints: np.recarray, order: np.ndarray, joint: np.ndarray, rotor: np.ndarray
) -> Solver:
    """Return the solver of a forest; `order` and `joint` are those of `forest_order`.

    `rotor` (J, 6) has the inertia along each freedom of each joint.
    """
    links = table(LINK, order.size)
    links.order, links.joint = order, joint
    links["parent"], links["freedoms"] = -1, 6
    for b, j in enumerate(joint):
        if j >= 0:
            links.parent[b] = p = joints.parent[j]
            links.freedoms[b] = 6 - joints.rows[j]
            if p >= 0:
                links.has_child[p] = 1
    # as narrow as possible: memory access limits the speed of a solve of 1000 links
    most = max(
        1, int(np.max(links.freedoms[(links.joint >= 0) | (links.has_child == 1)], initial=0))
    )
    workspace = np.full((order.size, HEAD + WIDTH * most), np.nan)
    own = np.where(joint[:, None] >= 0, rotor[joint, :most], 0.0)
    return no_joints()._replace(
        kind=FOREST, links=links, rotor=own, workspace=workspace, usual=np.full(1, -1)
    )


def spread(touching: list[list[int]], mass, moments, extent) -> tuple[float, int, int]:
    """Return the greatest ratio of masses, or moments over squared sizes, in a mechanism, and its two bodies.

    `touching` is that of `loop_solver`; mass (N,), principal moments (N, 3) and size (N,) are those of all
    bodies. The two bodies are the lightest and the heaviest of that mechanism.
    """
    mechanisms = Sets(len(mass))
    for bodies in touching:
        for b in bodies[1:]:
            mechanisms.join(bodies[0], b)
    inertia = np.column_stack([mass, moments / extent[:, None] ** 2])
    least, most = inertia.min(axis=1), inertia.max(axis=1)
    own: dict[int, list[int]] = {}
    for b in {b for bodies in touching for b in bodies}:
        own.setdefault(mechanisms.find(b), []).append(b)
    ends = [
        (min(group, key=least.__getitem__), max(group, key=most.__getitem__))
        for group in own.values()
    ]
    return max(((float(most[k] / least[i]), i, k) for i, k in ends), default=(1.0, 0, 0))


def loop_solver(touching: list[list[int]], drop: float, poses: int, bodies: int) -> Solver:
    """Return the solver of a scene with closed loops: the symbolic factor of A M^-1 A^T.

    `touching` has the bodies of each element, joints first: the child, then the parent if it is a body. `poses`
    is the number of bodies if the rows depend on nothing but their poses, else 0; `bodies` is that number if
    their masses differ much, else 0.
    """
    number = len(touching)
    order, later = elimination(touching)
    place = np.empty(number, dtype=np.int64)
    place[order] = np.arange(number)
    column, row, slot = [0], [], {(j, j): j for j in range(number)}
    for k in order:
        for i in sorted(later[k], key=lambda j: place[j]):
            slot[i, k] = number + len(row)
            row.append(i)
        column.append(len(row))
    update, triple = [0], []
    for n in range(number):
        below = range(column[n], column[n + 1])
        for s in below:
            for t in below:
                if place[row[s]] >= place[row[t]]:
                    triple.append((s, t, slot[row[s], row[t]]))
        update.append(len(triple))
    rows = table(ROW, number)
    count = np.array([len(bodies) for bodies in touching], dtype=np.int64)
    rows.last = np.cumsum(count)
    rows.first = rows.last - count
    sides = table(SIDE, int(count.sum()))
    sides.element = np.repeat(np.arange(number), count)
    sides.body = [b for bodies in touching for b in bodies]
    by_body: dict[int, list[int]] = {}
    for s, b in enumerate(sides.body):
        by_body.setdefault(int(b), []).append(s)
    element = sides.element
    term = [
        (slot[element[s], element[t]], s, t)
        for near in by_body.values()
        for s in near
        for t in near
        if place[element[s]] >= place[element[t]]
    ]
    order, column, row, update, triple, term = (
        np.array(one, dtype=np.int64) for one in (order, column, row, update, triple, term)
    )
    return no_joints()._replace(
        kind=LOOPS, order=order, column=column, row=row, update=update, triple=triple.reshape(-1, 3),
        term=term.reshape(-1, 3), rows=rows, sides=sides, block=np.zeros((number + len(row), 6, 6)),
        drop=drop, pose=np.full((poses, 7), np.nan), usual=np.full(1, -1),
        fine=np.zeros((2, number + len(row) if bodies else 0, 6, 6)),
        digits=np.zeros((number if bodies else 0, 4, 6)), scaled=np.zeros((bodies, 3, 6)),
    )  # fmt: skip
