"""Bodies with joints and loads: all of them are in one island, as its first bodies, with their own numbers.

Springs, joints and functions of the user refer to bodies by number, and the back ends have a row for each body.
So the island of the joined and loaded bodies has its own copy of all these: in each step these bodies have the
numbers 0 .. K - 1, and free bodies the numbers after them. State of joints that lasts from step to step belongs
to the scene: it is copied when a step begins, and copied back when it has ended.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from carom._compiled.decorators import kernel
from carom._compiled.record_arrays import table
from carom.model.arrays import FOREST, JOINT, Relations, Solver, System
from carom.model.contact_kinds import is_of_joint
from carom.model.forces import Forces, no_forces, renumbered
from carom.model.memory import Memory
from carom.model.relations import no_relations
from carom.model.solvers import no_joints


class Joined(NamedTuple):
    """The joints and loads of K bodies; fields are those of a `System` with the same names."""

    body: np.ndarray  # (K,) their numbers in the scene
    stops: np.ndarray  # (S,) contacts that are stops in joints
    joints: np.recarray
    relations: Relations
    forces: Forces
    solver: Solver


def joined_bodies(system: System) -> Joined:
    """Return the joined and loaded bodies of a scene."""
    loaded = system.bodies["ballistic"] == 0
    body = np.flatnonzero(loaded)
    if not body.size:
        return no_bodies()
    order = np.append(body, np.flatnonzero(~loaded))
    place = np.append(np.argsort(order), -1)  # the ground has place -1, like its number
    relations, ends = system.relations, ("parent", "child")
    return Joined(
        body,
        np.flatnonzero(is_of_joint(system.contacts)),
        _moved(system.joints, place, ends),
        relations._replace(
            coordinates=_moved(relations.coordinates, place, ends),
            stiff=_moved(relations.stiff, place, ends),
            named=place[relations.named],
            memory=Memory._make(kept.copy() for kept in relations.memory),
        ),
        renumbered(system.forces, place),
        _solver(system.solver, order, place, len(body)),
    )


@cache
def no_bodies() -> Joined:
    """Return the empty joints and loads of islands without any."""
    none = np.zeros(0, dtype=np.int64)
    return Joined(none, none, table(JOINT, 0), no_relations(), no_forces(), no_joints())


def _moved(rows: np.recarray, place: np.ndarray, ends: tuple[str, ...]) -> np.recarray:
    """Return the rows with each number of a body replaced by its place."""
    out = rows.copy()
    for end in ends:
        out[end] = place[out[end]]
    return out


def _solver(solver: Solver, order: np.ndarray, place: np.ndarray, count: int) -> Solver:
    """Return the back end for bodies in this order, with its own factor."""
    own = {name: a.copy() for name, a in solver._asdict().items() if isinstance(a, np.ndarray)}
    own |= {"usual": solver.usual, "sides": _moved(solver.sides, place, ("body",))}
    out = solver._replace(**own)
    if solver.kind != FOREST:
        return out
    links, walk = solver.links[order], place[solver.links.order]
    links["order"] = np.append(walk[walk < count], np.arange(count, len(order)))
    links["parent"] = place[links["parent"]]
    return out._replace(links=links, rotor=solver.rotor[order])


@kernel
def enter_joined(system, joined):
    """Copy the state of joints from the scene; drop the factor, which may belong to other bodies."""
    a, b = system.relations.memory, joined.relations.memory
    copy_memory(a.coordinates, a.frictions, b.coordinates, b.frictions)
    solver = joined.solver
    for b in range(solver.workspace.shape[0]):
        solver.workspace[b, 0] = math.nan
    for b in range(solver.pose.shape[0]):
        solver.pose[b, 0] = math.nan


@kernel
def end_joined(system, joined):
    """Copy the state of joints back to the scene."""
    a, b = joined.relations.memory, system.relations.memory
    copy_memory(a.coordinates, a.frictions, b.coordinates, b.frictions)


@kernel
def copy_memory(turns, frictions, kept_turns, kept_frictions):
    """Copy what a step of joints goes on from."""
    for i in range(turns.shape[0]):
        kept_turns[i] = turns[i]
    for i in range(frictions.shape[0]):
        kept_frictions[i] = frictions[i]
