"""Bodies with joints and loads: they are all in one island, are its first bodies, and have own numbers.

Springs, joints and functions of the user's speak of bodies by number, and the back ends have a row for each.
So all this is kept a second time for the island of the joined and loaded bodies, whatever else is in it: these
have the numbers 0 .. K - 1 in each step, free bodies the numbers after them. What carries over from step to
step stays with the scene: it is copied when a step begins, and back when it has ended.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom._compiled.decorators import kernel
from carom._compiled.record_arrays import Columns
from carom.model.arrays import FOREST, STOP, Relations, Solver, System
from carom.model.solvers import no_joints


class Joined(NamedTuple):
    """What joints and loads there are between K bodies: the fields of a `System` of the same names."""

    body: np.ndarray  # (K,) their numbers in the scene
    stops: np.ndarray  # (S,) contacts that are stops in joints
    joints: np.recarray
    relations: Relations
    springs: np.recarray
    loads: np.recarray
    bushings: np.recarray
    solver: Solver


def joined_bodies(system: System) -> Joined:
    """Return the joined and loaded bodies of a scene."""
    loaded = system.bodies["ballistic"] == 0
    body = np.flatnonzero(loaded)
    if not body.size:
        return no_bodies(system)
    order = np.append(body, np.flatnonzero(~loaded))
    place = np.append(np.argsort(order), -1)  # that of the ground is -1, as its number
    relations, ends = system.relations, ("parent", "child")
    return Joined(
        body,
        np.flatnonzero(system.contacts["touches"] == STOP),
        _moved(system.joints, place, ends),
        relations._replace(
            coordinates=_moved(relations.coordinates, place, ends),
            stiff=_moved(relations.stiff, place, ends),
            frictions=relations.frictions.copy(),
            named=place[relations.named],
        ),
        _moved(system.springs, place, ends),
        _moved(system.loads, place, ("body", "frame")),
        _moved(system.bushings, place, ends),
        _solver(system.solver, order, place, len(body)),
    )


def no_bodies(system: System) -> Joined:
    """Return joints and loads of islands that have none."""
    none, relations = np.zeros(0, dtype=np.int64), system.relations
    empty = {name: a[:0].copy() for name, a in relations._asdict().items() if name != "there"}
    return Joined(
        none, none, _none(system.joints), relations._replace(there=0, **empty),
        _none(system.springs), _none(system.loads), _none(system.bushings), no_joints(),
    )  # fmt: skip


def _none(rows: np.recarray) -> np.recarray:
    """Return no rows of the same kind."""
    return rows[:0].copy().view(Columns)


def _moved(rows: np.recarray, place: np.ndarray, ends: tuple[str, ...]) -> np.recarray:
    """Return rows that speak of bodies by their place."""
    out = rows.copy()
    for end in ends:
        out[end] = place[out[end]]
    return out


def _solver(solver: Solver, order: np.ndarray, place: np.ndarray, count: int) -> Solver:
    """Return the back end for bodies in this order, with a factor of its own."""
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
    """Take over what joints have kept; forget the factor, which may be of other bodies."""
    here, there, solver = joined.relations, system.relations, joined.solver
    for i in range(here.coordinates.shape[0]):
        here.coordinates[i].reference = there.coordinates[i].reference
    for i in range(here.frictions.shape[0]):
        here.frictions[i] = there.frictions[i]
    for b in range(solver.workspace.shape[0]):
        solver.workspace[b, 0] = math.nan
    for b in range(solver.pose.shape[0]):
        solver.pose[b, 0] = math.nan


@kernel
def end_joined(system, joined):
    """Hand back what joints keep for the next step."""
    here, there = joined.relations, system.relations
    for i in range(here.coordinates.shape[0]):
        there.coordinates[i].reference = here.coordinates[i].reference
    for i in range(here.frictions.shape[0]):
        there.frictions[i] = here.frictions[i]
