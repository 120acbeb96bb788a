"""Bodies with joints and loads: in islands they are in clusters, each with its own joints, loads and back end.

A cluster begins as a component, the bodies that joints and forces connect. An island has the bodies of one
cluster, or of none, as its first ones. So clusters whose bodies may meet become one: the loop is left, and the
tables are made anew (`Run.grow`). Bodies that have met are likely to meet again, so a cluster is divided only
after many steps in which this was possible.

Tables have parts of their own for each cluster, in which its bodies have the numbers 0 .. K - 1
(`carom.model.clusters`), and free bodies of an island the numbers after them. State of joints that lasts from
step to step belongs to the scene: it is copied when a step begins, and copied back when it has ended.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from carom._compiled.decorators import kernel
from carom._compiled.record_arrays import table
from carom.geometry.rotation import norm
from carom.model.arrays import JOINT, LINK, Relations, Solver, System
from carom.model.clusters import (
    RANGES,
    Connected,
    Sorted,
    are_constant,
    connected,
    forces_of,
    joints_of,
    links_of,
    relations_of,
    solver_of,
)
from carom.model.contact_kinds import is_of_joint
from carom.model.forces import Forces, no_forces
from carom.model.graph import Sets
from carom.model.memory import Memory
from carom.model.relations import no_relations
from carom.model.solvers import no_joints
from carom.model.workspace import RESTS


class Joined(NamedTuple):
    """The joints and loads of K bodies, cluster by cluster; `joints` to `solver` are those of a `System`."""

    body: np.ndarray  # (K,) their numbers in the scene
    component: np.ndarray  # (N,) the component of each body of the scene, -1 of free ones
    cluster: np.ndarray  # (N,) its cluster
    stops: np.ndarray  # (S,) contacts that are stops in joints
    solid: (
        np.ndarray
    )  # (M,) of each contact: of a stop, the number of its coordinate in the cluster
    ranges: np.recarray  # RANGES, of each cluster
    constant: np.ndarray  # 1 for each cluster on which nothing acts that changes with time
    first: np.ndarray  # (C,) workspace: first body of each component, or cluster
    rests: np.ndarray  # 1 for each cluster that is at rest in the present step
    turns: np.ndarray  # (C,) number in the scene of each coordinate
    rubs: np.ndarray  # (F,) number in the scene of each friction
    placed: Forces  # of each row of a table of the scene, its place among those of `forces`
    links: np.recarray  # (N,) LINK of each body of the scene, and inertia along its freedoms
    rotor: np.ndarray
    joints: np.recarray
    relations: Relations
    forces: Forces
    solver: Solver


def joined_bodies(system: System, united: np.ndarray, known: Connected | None = None) -> Joined:
    """Return the joined and loaded bodies of a scene; `united` has the cluster of each component."""
    if system.bodies["ballistic"].all():
        return no_bodies()
    moved, component = known or connected(system)
    number = np.unique(united, return_inverse=True)[1] if united.size else np.zeros(1, np.int64)
    of = Sorted(np.where(component >= 0, number[component], -1), moved)
    stops = np.flatnonzero(is_of_joint(system.contacts))
    solid = system.contacts["solid"].copy()
    solid[stops] = of.number["coordinate"][solid[stops]]
    counted = of.rows["coordinate"] < system.relations.counted
    ends = of.ranges["coordinate"]
    of.ranges["counted"] = [int(counted[first:last].sum()) for first, last in ends.tolist()]
    solver = solver_of(system, of)
    return Joined(
        body=of.rows["body"], component=component, cluster=of.cluster, stops=stops, solid=solid,
        ranges=of.ranges, constant=are_constant(system, of, moved),
        first=np.zeros(component.max() + 1, dtype=np.int64), rests=np.zeros(len(of.ranges), dtype=np.int64),
        turns=of.rows["coordinate"], rubs=of.rows["friction"], placed=of.places(),
        links=links_of(system.solver, of), rotor=system.solver.rotor.copy(),
        joints=joints_of(system, of), relations=relations_of(system.relations, of),
        forces=forces_of(system.forces, of), solver=solver,
    )  # fmt: skip


@cache
def no_bodies() -> Joined:
    """Return the empty joints and loads of islands without any."""
    none = np.zeros(0, dtype=np.int64)
    placed = Forces(*(none for _ in Forces._fields))
    return Joined(
        body=none, component=none, cluster=none, stops=none, solid=none, ranges=table(RANGES, 0),
        constant=none, first=none, rests=none, turns=none, rubs=none, placed=placed, links=table(LINK, 0),
        rotor=np.zeros((0, 0)), joints=table(JOINT, 0), relations=no_relations(), forces=no_forces(),
        solver=no_joints(),
    )  # fmt: skip


def clusters_that_meet(joined: Joined, before: np.ndarray, parent: np.ndarray) -> np.ndarray:
    """Return the cluster of each component: the sets of bodies, by the `parent` of each, and those `before`."""
    sets, known = Sets(len(before)), {}
    for one, k in enumerate(before.tolist()):
        sets.join(k, one)
    for b in joined.body.tolist():
        root = b
        while parent[root] != root:
            root = int(parent[root])
        one = int(joined.component[b])
        sets.join(known.setdefault(root, one), one)
    roots = [sets.find(one) for one in range(len(before))]
    return np.array([roots.index(root) for root in roots])


@kernel
def enter_joined(joined, k, n):
    """Begin with cluster k in an island of n bodies: write the walk of its joints, drop the last factor."""
    solver, first = joined.solver, joined.ranges[k].body[0]
    count = joined.ranges[k].body[1] - first
    for i in range(n if solver.links.shape[0] > 0 else 0):
        link = solver.links[i]
        if i < count:
            solver.links[i] = joined.links[joined.body[first + i]]
            for f in range(solver.rotor.shape[1]):
                solver.rotor[i, f] = joined.rotor[joined.body[first + i], f]
        else:
            link.order, link.joint, link.parent, link.freedoms, link.has_child = i, -1, -1, 6, 0
    for b in range(min(n, solver.workspace.shape[0])):
        solver.workspace[b, 0] = math.nan
    for b in range(min(n, solver.pose.shape[0])):
        solver.pose[b, 0] = math.nan


@kernel
def rest_whole(joined, work):
    """Let a cluster rest in the step if an active point of it does: it has come to rest as a whole."""
    for k in range(joined.rests.shape[0]):
        joined.rests[k] = 0
    for b in joined.body:
        if work.body[b].status == RESTS:
            joined.rests[joined.cluster[b]] = 1
    for b in joined.body:
        if joined.rests[joined.cluster[b]] == 1:
            work.body[b].status = RESTS


@kernel
def wake(own, work):
    """Let the joined bodies of an island move: something may have come near, or touched them."""
    for i in range(own.count[0]):
        if work.body[own.points[i].body].label == work.body.shape[0]:
            own.points[i].rest, own.points[i].comes_to_rest = 0, 0


@kernel
def let_rest(own):
    """Let the joined bodies of an island rest if they have not moved in the last step: no force changes."""
    work, n, points, still = own.work, own.state.shape[0], own.active.points, False
    for b in range(n):
        if work.body[b].label == n and norm(own.state[b].v) + norm(own.state[b].w) > 0.0:
            return
    for i in range(own.active.count[0]):
        joined = work.body[points[i].body].label == n
        still = still or (joined and points[i].comes_to_rest == 1)
    for i in range(own.active.count[0] if still else 0):
        if work.body[points[i].body].label == n:
            points[i].rest = 1


@kernel
def begin_joined(system, joined):
    """Copy the state of joints from the scene."""
    there, here = system.relations.memory, joined.relations.memory
    for i in range(joined.turns.shape[0]):
        here.coordinates[i] = there.coordinates[joined.turns[i]]
    for i in range(joined.rubs.shape[0]):
        here.frictions[i] = there.frictions[joined.rubs[i]]


@kernel
def end_joined(system, joined):
    """Copy the state of joints back to the scene."""
    here, there = joined.relations.memory, system.relations.memory
    for i in range(joined.turns.shape[0]):
        there.coordinates[joined.turns[i]] = here.coordinates[i]
    for i in range(joined.rubs.shape[0]):
        there.frictions[joined.rubs[i]] = here.frictions[i]


@kernel
def part_memory(joined, r):
    """Return the memory of a cluster whose ranges are r."""
    memory = joined.relations.memory
    return Memory(
        coordinates=memory.coordinates[r.coordinate[0] : r.coordinate[1]],
        frictions=memory.frictions[r.friction[0] : r.friction[1]],
        stiff=memory.stiff[r.stiff[0] : r.stiff[1]], rates=memory.rates[r.rotor[0] : r.rotor[1]],
        feet=memory.feet, read=memory.read, write=memory.write,
    )  # fmt: skip


@kernel
def part_relations(joined, r, memory):
    """Return the relations of a cluster whose ranges are r."""
    a = joined.relations
    return Relations(
        there=a.there, counted=r.counted, coordinates=a.coordinates[r.coordinate[0] : r.coordinate[1]],
        relations=a.relations, terms=a.terms, user=a.user, pieces=a.pieces,
        stiff=a.stiff[r.stiff[0] : r.stiff[1]], frictions=a.frictions[r.friction[0] : r.friction[1]],
        rotors=a.rotors[r.rotor[0] : r.rotor[1]], curves=a.curves, curve_pieces=a.curve_pieces,
        wraps=a.wraps, named=a.named, memory=memory,
    )  # fmt: skip


@kernel
def part_solver(joined, k, n):
    """Return the back end of cluster k in an island of n bodies."""
    s, r = joined.solver, joined.ranges[k]
    blocks = r.joint[1] - r.joint[0] + r.row[1] - r.row[0]
    return Solver(
        kind=s.kind, links=s.links[:n], rotor=s.rotor[:n], workspace=s.workspace[:n],
        order=s.order[r.joint[0] : r.joint[1]],
        column=s.column[r.column[0] : r.column[1]], row=s.row[r.row[0] : r.row[1]],
        update=s.update[r.column[0] : r.column[1]], triple=s.triple[r.triple[0] : r.triple[1]],
        term=s.term[r.term[0] : r.term[1]], rows=s.rows[r.joint[0] : r.joint[1]],
        sides=s.sides[r.side[0] : r.side[1]], block=s.block[:blocks], drop=s.drop, pose=s.pose[:n],
        usual=s.usual[k : k + 1], fine=s.fine, digits=s.digits, scaled=s.scaled[:n],
    )  # fmt: skip
