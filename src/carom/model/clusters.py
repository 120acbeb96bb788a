"""Clusters: bodies that joints and forces connect, and the tables of each cluster by itself.

Rows of tables refer to bodies, and to rows of other tables, by number. In the tables of a cluster its bodies
have the numbers 0, 1, ... in the order of the scene, and so have its rows. Tables that kernels go through are
sorted by cluster, so that those of one are a range (`RANGES`). Others stay as they are, except for what they
refer to.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.model.arrays import (
    COMBINATION,
    FOREST,
    LINK,
    LOOPS,
    METRIC,
    ON_CURVE,
    STIFF,
    Relations,
    Solver,
    System,
)
from carom.model.contact_kinds import is_of_joint
from carom.model.forces import Forces, bodies_in
from carom.model.graph import Sets
from carom.model.memory import Memory
from carom.model.solvers import loop_solver
from carom.scene.forces import TABLES

#: ranges (first, last) of a cluster in each table that is sorted; of coordinates also how many are counted
RANGES = [
    ("body", "i8", 2),
    ("joint", "i8", 2),
    ("coordinate", "i8", 2),
    ("counted", "i8"),
    ("stiff", "i8", 2),
    ("friction", "i8", 2),
    ("rotor", "i8", 2),
    ("force", "i8", (len(TABLES), 2)),
    # of closed loops: columns and updates have an end more than there are joints
    ("column", "i8", 2),
    ("row", "i8", 2),
    ("triple", "i8", 2),
    ("term", "i8", 2),
    ("side", "i8", 2),
]
ENDS = ("child", "parent")
#: for each table of `Relations` that is sorted, the name of its range and its table in `Memory`
SORTED = {
    "coordinates": ("coordinate", "coordinates"),
    "stiff": ("stiff", "stiff"),
    "frictions": ("friction", "frictions"),
    "rotors": ("rotor", "rates"),
}
#: for each array of the solve for closed loops that is sorted, the name of its range
OF_LOOPS = {
    "order": "joint", "column": "column", "row": "row", "update": "column", "triple": "triple",
    "term": "term", "rows": "joint", "sides": "side",
}  # fmt: skip


class Connected(NamedTuple):
    """The bodies that each row of each table connects, and the number of the component of each body."""

    moved: Mapping[str, list[list[int]]]
    component: np.ndarray  # (N,) -1 for bodies on which only gravity acts

    @property
    def first(self) -> np.ndarray:
        """The cluster of each component at the start: its own; none if there is only one."""
        count = int(self.component.max(initial=-1)) + 1
        return np.arange(count if count > 1 else 0)


def connected(system: System) -> Connected:
    """Return what joints, relations, rows of the user's, and forces connect."""
    moved = moved_by(system)
    return Connected(moved, components(system, moved))


def moved_by(system: System) -> dict[str, list[list[int]]]:
    """Return the bodies that each row of a table connects, by the name of its range, or its own."""
    relations, contacts = system.relations, system.contacts
    coordinate = _lists(relations.coordinates, ENDS)
    joint, sides = _lists(system.joints, ENDS), system.solver.sides["body"].tolist()
    for one, first, last in zip(joint, *_columns(system.solver.rows, "first", "last")):
        one += sides[first:last]

    def of(rows: np.recarray, name: str = "coordinate") -> list[list[int]]:
        """Return the bodies of the coordinate of each row."""
        return [coordinate[k] if k >= 0 else [] for k in rows[name].tolist()]

    terms = of(relations.terms)
    relation = [
        list(chain(*terms[first:last]))
        for first, last in zip(*_columns(relations.relations, "first", "last"))
    ]
    combined = relations.coordinates["kind"] == COMBINATION
    for k in np.flatnonzero(combined).tolist():
        coordinate[k] = coordinate[k] + relation[int(relations.coordinates["number"][k])]
    loads = [joint[j] if j >= 0 else [] for j in relations.frictions["joint"].tolist()]
    strands = relations.wraps["strand"].tolist()
    stops: Any = contacts[is_of_joint(contacts)]
    out = {
        "joint": joint, "coordinate": coordinate, "relation": relation, "rotor": of(relations.rotors),
        "friction": [a + b for a, b in zip(of(relations.frictions), loads)],
        "stiff": [a + b for a, b in zip(of(relations.stiff), _lists(relations.stiff, ENDS))],
        "wrap": [list(chain(*(coordinate[k] for k in own if k >= 0))) for own in strands],
        "stop": [a + b for a, b in zip(of(stops, "solid"), _lists(stops, ("body", "other")))],
    }  # fmt: skip
    out["side"] = [joint[e] for e in system.solver.sides["element"].tolist()]
    named = relations.named.tolist()
    for kind, rows in zip(TABLES, system.forces):
        own, columns = _lists(rows, bodies_in(rows)), rows.dtype.names or ()
        if "coordinate" in columns:
            own = [a + b for a, b in zip(own, of(rows))]
        if "first" in columns:  # bodies that a function of the user's names
            ends = zip(own, *_columns(rows, "first", "last"))
            own = [a + named[first:last] for a, first, last in ends]
        out[kind.name] = own
    return out


def components(system: System, moved: Mapping[str, list[list[int]]]) -> np.ndarray:
    """Return (N,) the number of the component of each body, -1 for bodies on which only gravity acts.

    A component has all bodies that joints, relations, rows of the user's, or forces connect.
    """
    loaded = system.bodies["ballistic"] == 0
    out, body = np.where(loaded, 0, -1), np.flatnonzero(loaded)
    if system.solver.kind == METRIC or not body.size:  # the user's coordinates move any body
        return out
    sets = Sets(len(loaded))
    for rows in moved.values():
        for one in rows:
            for b in one[1:]:
                sets.join(one[0], b)
    roots = [sets.find(b) for b in body.tolist()]
    number = {root: k for k, root in enumerate(dict.fromkeys(roots))}
    out[body] = [number[root] for root in roots]
    return out


class Sorted:
    """The rows of all tables, sorted by cluster: where each row of the scene stands, and its number there."""

    def __init__(self, cluster: np.ndarray, moved: Mapping[str, list[list[int]]]):
        count = int(cluster.max(initial=-1)) + 1
        self.cluster, self.ranges = cluster, table(RANGES, count)
        self._ranges: dict[str, np.ndarray] = {}
        self.rows: dict[str, np.ndarray] = {}  # of the scene, in the order of the clusters
        # of each row of the scene in its cluster; -1 stays -1
        self.number: dict[str, np.ndarray] = {}
        self.sort("body", np.where(cluster >= 0, cluster, count))
        none = np.zeros(0, np.int64), np.full(1, -1), np.zeros((count, 2), np.int64)
        for name, rows in moved.items():
            if not rows:
                self.rows[name], self.number[name], self._ranges[name] = none
                continue
            own = [max((cluster[b] for b in one), default=0) for one in rows]
            self.sort(name, np.maximum(np.array(own, dtype=np.int64), 0))
        self.ranges["force"] = np.stack([self._ranges[kind.name] for kind in TABLES], axis=1)

    def sort(self, name: str, own: np.ndarray) -> None:
        """Sort the rows of a table; `own` is the cluster of each, and those without bodies are in the first."""
        rows = np.argsort(own, kind="stable")
        rows = rows[own[rows] < len(self.ranges)]
        first = np.searchsorted(own[rows], np.arange(len(self.ranges) + 1))
        number = np.full(len(own) + 1, -1)
        number[rows] = np.arange(len(rows)) - first[own[rows]]
        self.rows[name], self.number[name] = rows, number
        self._ranges[name] = np.column_stack([first[:-1], first[1:]])
        if name in (self.ranges.dtype.names or ()):
            self.ranges[name] = self._ranges[name]

    def places(self) -> Forces:
        """Return the place of each row of each table of forces."""
        return Forces(*(np.argsort(self.rows[kind.name]) for kind in TABLES))

    def taken(self, name: str, rows: Any, **columns: str) -> Any:
        """Return a copy of the rows of a table, sorted; `columns` name the table to which each refers."""
        return self.renumbered(rows[self.rows[name]], **columns)

    def renumbered(self, rows: Any, **columns: str) -> Any:
        """Return a copy of rows with the numbers in some columns as they are in the clusters."""
        out = rows.copy()
        for column, name in columns.items() if len(rows) else ():
            out[column] = self.number[name][out[column]]
        return out


def _columns(rows: np.ndarray, *names: str) -> list[list[int]]:
    return [rows[name].tolist() for name in names]


def _lists(rows: np.recarray, names: Sequence[str]) -> list[list[int]]:
    """Return the numbers in some columns of each row, without -1."""
    if not names:
        return [[] for _ in range(len(rows))]
    return [[b for b in one if b >= 0] for one in zip(*_columns(rows, *names))]


def are_constant(system: System, of: Sorted, moved: Mapping[str, list[list[int]]]) -> np.ndarray:
    """Return (K,) 1 for each cluster on which nothing acts that changes with time: at rest it stays so."""
    relations, out = system.relations, np.ones(len(of.ranges), dtype=np.int64)
    driven = [
        ("relation", _is_driven(relations.relations)),
        ("friction", _is_driven(relations.frictions)),
    ]
    for kind, rows in zip(TABLES, system.forces):
        if "address" in (rows.dtype.names or ()):
            driven.append((kind.name, rows["address"] != 0))
    touched = [moved[name][k] for name, rows in driven for k in np.flatnonzero(rows).tolist()]
    sides = system.solver.sides["body"].tolist()
    touched += [sides[row["first"] : row["last"]] for row in relations.user]
    for one in touched:
        out[of.cluster[one[:1]]] = 0
    return out


def _is_driven(rows: np.recarray) -> np.ndarray:
    """Return which rows have a motion that is no constant."""
    return (rows["address"] != 0) | (rows["rate"] != 0.0) | (rows["last_piece"] > rows["piece"])


def relations_of(relations: Relations, of: Sorted) -> Relations:
    """Return the relations of a scene, sorted by cluster."""
    own = {name: of.taken(key, getattr(relations, name)) for name, (key, _) in SORTED.items()}
    coordinates, c = own["coordinates"], {"coordinate": "coordinate"}
    coordinates["index"] = of.number["coordinate"][of.rows["coordinate"]]
    own["coordinates"] = of.renumbered(coordinates, parent="body", child="body")
    own["stiff"] = of.renumbered(
        own["stiff"], parent="body", child="body", element="joint", child_side="side",
        parent_side="side", **c,
    )  # fmt: skip
    own["frictions"] = of.renumbered(own["frictions"], joint="joint", **c)
    own["rotors"] = of.renumbered(own["rotors"], **c)
    user = of.renumbered(relations.user, first="side")
    user["last"] = user["first"] + relations.user["last"] - relations.user["first"]
    memory = relations.memory._asdict()
    memory |= {kept: memory[kept][of.rows[key]] for key, kept in SORTED.values()}
    return relations._replace(
        **own, user=user, named=of.number["body"][relations.named],
        terms=of.renumbered(relations.terms, child_side="side", parent_side="side", **c),
        wraps=of.renumbered(relations.wraps, strand="coordinate"),
        memory=Memory(**{name: rows.copy() for name, rows in memory.items()}),
    )  # fmt: skip


def joints_of(system: System, of: Sorted) -> np.recarray:
    """Return the joints of a scene, sorted by cluster."""
    joints = of.taken("joint", system.joints, parent="body", child="body")
    if not (joints["kind"] >= min(*ON_CURVE, STIFF)).any():
        return joints
    for kinds, name in ((ON_CURVE, "coordinate"), ((STIFF,), "stiff")):
        those = np.isin(joints["kind"], kinds)
        joints["number"][those] = of.number[name][joints["number"][those]]
    return joints


def forces_of(forces: Forces, of: Sorted) -> Forces:
    """Return the forces of a scene, sorted by cluster."""
    out = []
    for kind, rows in zip(TABLES, forces):
        if not len(rows):
            out.append(rows)
            continue
        columns = dict.fromkeys(bodies_in(rows), "body")
        if "coordinate" in (rows.dtype.names or ()):
            columns["coordinate"] = "coordinate"
        out.append(of.taken(kind.name, rows, **columns))
    return Forces(*out)


def links_of(solver: Solver, of: Sorted) -> np.recarray:
    """Return (N,) the links of a forest by body; the walk of a cluster is at its bodies in turn."""
    if solver.kind != FOREST:
        return table(LINK, 0)
    links = of.renumbered(solver.links, joint="joint", parent="body")
    walk = solver.links["order"]
    for first, last in of.ranges["body"].tolist():
        body = of.rows["body"][first:last]
        own = walk[np.isin(walk, body)]
        links["order"][body] = of.number["body"][own]
    return links


def solver_of(system: System, of: Sorted) -> Solver:
    """Return the back end, with workspace of its own, which clusters share, and what each needs in ranges."""
    solver, count = system.solver, len(of.ranges)
    made = solver._replace(
        **{name: a.copy() for name, a in solver._asdict().items() if isinstance(a, np.ndarray)}
    )._replace(usual=np.full(count, int(solver.usual[0])))
    if solver.kind != LOOPS:
        return made
    parts = [_loops(system, of, k) for k in range(count)]
    for name, key in OF_LOOPS.items():
        rows = [getattr(part, name) for part in parts]
        last = np.cumsum([len(one) for one in rows])
        of.ranges[key] = np.column_stack([last - [len(one) for one in rows], last])
        made = made._replace(**{name: np.concatenate(rows).view(type(rows[0]))})
    return made


def _loops(system: System, of: Sorted, k: int) -> Solver:
    """Return the solver for the closed loops of a cluster."""
    solver, (first, last) = system.solver, of.ranges["joint"][k].tolist()
    rows = of.rows["joint"][first:last]
    sides, place = solver.sides["body"], of.number["body"]
    ends = zip(*_columns(solver.rows[rows], "first", "last"))
    touching = [place[sides[one:end]].tolist() for one, end in ends]
    made = loop_solver(touching, solver.drop, 0, 0)
    for name in ("ignored", "compliance"):
        made.rows[name] = solver.rows[name][rows]
    return made
