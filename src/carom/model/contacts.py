"""The contacts of a scene as arrays."""

from __future__ import annotations

import numpy as np

from carom._compiled.record_arrays import table
from carom.collision.layout import SOLID, no_hulls, solid_table
from carom.geometry.frames import contact_axes
from carom.model.arrays import CONTACT
from carom.model.contact_rows import Rows, contact_rows, touching_pairs
from carom.model.cores import Cores, new_cores, singly, swollen_alike
from carom.options import Options
from carom.scene.all_pairs import PairTable
from carom.scene.contacts import IMPACT_LAWS
from carom.scene.materials import MULTIPLE
from carom.scene.scene import Scene
from carom.scene.shapes import Shape


def compile_contacts(scene: Scene, to_principal, options: Options):
    """Return contacts, vertices, and the solids and hulls of bodies whose points the kernels of pairs find.

    A contact of the scene has a row for each pair of pieces; against a half-space one for all vertices that
    are swollen alike, and one for each curved piece.
    """
    pairs = touching_pairs(scene)
    meets = pairs.other >= 0
    grounded = new_cores(_shapes(scene, pairs.body[~meets]), swollen_alike, to_principal)
    meeting = _shapes(scene, pairs.body[meets], pairs.other[meets])
    single = new_cores(meeting, singly, to_principal)
    which = contact_rows(pairs, grounded, single)
    rows = table(CONTACT, len(which.number))
    rows["number"], rows["body"] = which.number, pairs.body[which.number]
    rows["other"] = pairs.other[which.number]
    _write_half_spaces(rows, scene, pairs.plane[which.number])
    _write_shapes(rows, which)
    vertices = _write_vertices(rows, which, grounded, single)
    solids, hulls = _write_solids(rows, which, scene, to_principal)
    _write_laws(rows, pairs, which)
    extent = rows["extent"]
    rows["still"] = 1e-14 * _speed(scene, extent)
    rows["width"] = 1e-5 * extent if options.layer_width is None else options.layer_width
    rows["penetration"] = options.penetration
    return rows, vertices, solids, hulls


def _speed(scene: Scene, extent: np.ndarray) -> np.ndarray | float:
    """Return the speed that gravity gives over the size of a body, or the greatest at the start without it."""
    if np.any(scene.gravity):
        return np.sqrt(np.linalg.norm(scene.gravity) * extent)
    return max((float(np.linalg.norm(body.velocity)) for body in scene.bodies), default=0.0)


def _shapes(scene: Scene, *chosen: np.ndarray) -> list[Shape | None]:
    """Return the shape of each body, None for those that are not chosen."""
    bodies = {b for some in chosen for b in some.tolist()}
    return [body.shape if body.index in bodies else None for body in scene.bodies]


def _write_half_spaces(rows: np.recarray, scene: Scene, plane: np.ndarray) -> None:
    """Write how the half-space of each row lies; `plane` is its index, -1 for none."""
    for h, half_space in enumerate(scene.half_spaces):
        here = plane == h
        rows["axes"][here] = contact_axes(half_space.normal)
        rows["offset"][here] = half_space.point @ half_space.normal


def _write_shapes(rows: np.recarray, which: Rows) -> None:
    """Write of which form and size the two are, and who finds the points where they touch."""
    core, other = which.core, which.other
    rows["touches"] = np.where(rows["other"] >= 0, 1, core["curved"])
    rows["ball_like"] = np.maximum(core["ball_like"], other["ball_like"])
    rows["part"] = np.maximum(core["several"], other["several"])
    rows["extent"], rows["other_extent"] = core["extent"], other["extent"]
    rows["radius"], rows["core"] = core["radius"] + other["radius"], core["reach"]


def _write_vertices(rows: np.recarray, which: Rows, grounded: Cores, single: Cores) -> np.ndarray:
    """Write the ranges of vertices, and return these (V, 3).

    A vertex on a half-space is a feature that a contact is held at: each contact has its own. Points of two
    bodies are found anew in each state, and all contacts of a piece share its vertices.
    """
    core, other, flat = which.core, which.other, rows["touches"] == 0
    length = np.where(flat, core["last"] - core["first"], 0)
    last = np.cumsum(length)
    first = last - length
    own = np.repeat(core["first"] - first, length) + np.arange(length.sum())
    rows["first"][flat], rows["last"][flat] = first[flat], last[flat]
    pair, shared = rows["other"] >= 0, len(own)
    if not pair.any():
        return grounded.vertices[own]
    for name, end, body in (
        ("first", "first", core), ("last", "last", core),
        ("other_first", "first", other), ("other_last", "last", other),
    ):  # fmt: skip
        rows[name][pair] = body[end][pair] + shared
    return np.concatenate([grounded.vertices[own], single.vertices])


def _write_solids(rows: np.recarray, which: Rows, scene: Scene, to_principal: np.ndarray):
    """Write the solids of each row, and return the table of all, with their hulls."""
    rows["solid"] = which.core["piece"]
    if not rows["touches"].any():
        return table(SOLID, 0), no_hulls()
    found = np.append(rows.body[rows.touches == 1], rows.other[rows.other >= 0])
    bodies, first = np.unique(found, return_index=True)
    shaped = bodies[np.argsort(first)]
    solids, hulls = solid_table([scene.bodies[b].shape for b in shaped], to_principal[shaped])
    place = np.zeros(len(scene.bodies), dtype=np.int64)
    place[shaped] = np.searchsorted(solids.body, np.arange(len(shaped)))
    rows["solid"] += place[rows.body]
    rows["other_solid"] = np.where(rows.other >= 0, place[rows.other] + which.other.piece, 0)
    return solids, hulls


def _write_laws(rows: np.recarray, pairs: PairTable, which: Rows) -> None:
    """Write the law of each contact to its rows."""
    numbers = [
        (
            one.friction, one.friction_held, one.restitution, one.stiffness, one.rolling_friction,
            one.pivoting_friction, IMPACT_LAWS.index(one.impact_law), MULTIPLE.index(one.multiple),
        )
        for one in pairs.laws
    ]  # fmt: skip
    law = np.array(numbers, dtype=float).reshape(-1, 8)[pairs.law[which.number]]
    for k, name in enumerate(("friction", "friction_held", "restitution", "stiffness")):
        rows[name] = law[:, k]
    rows["turning"], rows["law"], rows["multiple"] = law[:, 4:6], law[:, 6], law[:, 7]
