"""The shapes of the modes of bodies as kernels read them, and the bodies that stand for modes."""

from __future__ import annotations

from itertools import accumulate

import numpy as np

from carom._compiled.record_arrays import table
from carom.flexible.grid import on_grid
from carom.model.arrays import FLEXIBLE, Flexible
from carom.model.forces import bodies_in
from carom.scene.forces import TABLES
from carom.scene.modal_spring import MODAL


def flexible_bodies(scene) -> Flexible:
    """Return the shapes of the modes of the bodies of a scene, in the order of these."""
    bent = [body for body in scene.bodies if body.modes is not None]
    rows = table(FLEXIBLE, len(bent))
    grids = [on_grid(body.modes, body.shape) for body in bent]
    masses = [
        float(body.mass) for body in bent
    ]  # coordinates have that of the body: shapes have no unit
    made = [padded(grid.coefficients) * np.sqrt(m) for grid, m in zip(grids, masses)]
    sizes = [0, *accumulate(one.size for one in made)]
    counts = [3 * -(-len(body.modes.frequencies) // 3) for body in bent]
    for k, grid in enumerate(grids):
        rows["origin"][k], rows["spacing"][k], rows["count"][k] = grid.low, grid.spacing, grid.count
    rows["fastest"] = [2.0 * np.pi * body.modes.frequencies.max() for body in bent]
    rows["first"], rows["modes"] = sizes[:-1], counts
    rows["first_most"] = [0, *accumulate(counts)][:-1]
    values = np.concatenate([np.zeros(0), *(one.ravel() for one in made)])
    most = [np.linalg.norm(one, axis=3).max(axis=(0, 1, 2)) for one in made]
    most = np.concatenate([np.zeros(0), *most])
    return Flexible(rows, values, most, np.zeros((3, max(counts, default=0))))


def bodies_of_modes(scene) -> np.ndarray:
    """Return (N,) how many bodies after each stand for its modes; check that they are there.

    Raises
    ------
    ValueError
        If one of them was removed, or has another mass than the flexible body.
    """
    bodies = scene.bodies
    counts = np.zeros(len(bodies), dtype=np.int64)
    for b, body in enumerate(bodies):
        if body.modes is None:
            continue
        counts[b] = -(-len(body.modes.frequencies) // 3)
        own = bodies[b + 1 : b + 1 + counts[b]]
        if len(own) < counts[b] or any(
            not one.name.startswith(f"{body.name} modes ") for one in own
        ):
            raise ValueError(
                f"{body.name!r} has lost bodies that stand for its modes; remove the whole body and add it anew"
            )
        w = 2.0 * np.pi * body.modes.frequencies
        stiffness = np.append(float(body.mass) * w * w, np.zeros(-len(w) % 3)).reshape(-1, 3)
        for one, k in zip(own, stiffness):
            if one.mass != body.mass:
                raise ValueError(
                    f"the mass of {one.name!r} must be that of {body.name!r}, {body.mass:g} kg, "
                    f"got {one.mass:g}"
                )
            spring = scene._parts.get(f"{one.name} stiffness")
            if spring is None or not np.array_equal(spring.definition.stiffness, k):
                raise ValueError(
                    f"modes of {body.name!r} must be those that it was made with; remove it and add it anew"
                )
    return counts


def refuse_others(scene, system) -> None:
    """Refuse what would act on a flexible body besides contacts: joints, ropes, forces at its points.

    Raises
    ------
    ValueError
        With the name of the body.
    """
    modes = system.bodies["modes"]
    bent = np.flatnonzero(modes > 0)
    if not bent.size:
        return
    held = {one.child.index for one in scene.joints if one.name == f"{one.child.name} support"}
    loose = [b for b in bent.tolist() if scene.bodies[b].modes.supported and b not in held]
    if loose:
        raise ValueError(
            f"{scene.bodies[loose[0]].name!r} has lost its support; add it anew by add_static"
        )
    bent = np.concatenate(
        [np.arange(b, b + modes[b] + 1) for b in bent]
    )  # and what stands for their modes
    sides = [system.relations.coordinates[end] for end in ("parent", "child")]
    sides += [system.relations.named]
    for kind, rows in zip(TABLES, system.forces):
        if kind is not MODAL:
            sides += [rows[name] for name in bodies_in(rows)]
    for j, one in enumerate(scene.joints):
        if one.name != f"{one.child.name} support":
            sides += [system.joints[end][j : j + 1] for end in ("parent", "child")]
    ends = np.concatenate(sides)
    touched = ends[np.isin(ends, bent)]
    if touched.size:
        raise ValueError(
            f"nothing but contacts may act on {scene.bodies[int(touched[0])].name!r}, which has modes or "
            "stands for some: joints, ropes and forces at its points do not move them"
        )


def padded(shapes: np.ndarray) -> np.ndarray:
    """Return shapes (..., n) with zeros for as many modes as fill the last body."""
    return np.concatenate([shapes, np.zeros((*shapes.shape[:-1], -shapes.shape[-1] % 3))], axis=-1)
