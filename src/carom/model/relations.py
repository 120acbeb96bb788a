"""Coordinates of joints, their relations and rows of the user's own, as arrays."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from carom._compiled.record_arrays import Columns, table
from carom._compiled.user_functions import Functions
from carom.geometry.frames import triad
from carom.model import arrays, memory
from carom.model.actions import MODE_STICK
from carom.model.curves import Curves
from carom.model.pieces import PIECE, Pieces
from carom.model.placement import Placement, put_in
from carom.model.stated_forces import ForceRows, write_motion
from carom.scene.actuators import Controlled
from carom.scene.constraints import Coupling, Rows
from carom.scene.coordinates import (
    Axial,
    BodyTurn,
    Bush,
    Combination,
    Gap,
    Length,
    Strand,
    Wrap,
    coordinate_kind,
    counted,
    kind_of,
)
from carom.scene.forces import Spring
from carom.scene.joints import Joint
from carom.scene.more_forces import JointInertia, JointSpring
from carom.scene.switches import is_off


class Coordinates:
    """The coordinates that a scene uses, each once."""

    def __init__(self, placement: Placement):
        self.placement = placement
        self.rows: list[np.recarray] = []
        self.numbers: dict[tuple[Any, int | str], int] = {}
        # of combinations, by their terms; of ropes that rub also by their slip
        self.sums: dict[Any, int] = {}
        # combinations, with their terms
        self.listed: list[tuple[int, tuple[tuple[int, float], ...]]] = []
        self.wraps: dict[int, np.recarray] = {}  # of ropes that rub, by the index of their length
        self.curves = Curves()
        self.counted, self.used = 0, False

    def count(self, scene) -> None:
        """Add all angles, and places on closed curves, of joints: a run counts their turns, used or not.

        Those of a joint that is off have no bodies: these may move in islands of their own.
        """
        for j, k in counted(scene.joints):
            row = self.rows[self.number(scene.joints[j], k)]
            if is_off(scene, scene.joints[j]):
                row.kind, row.child, row.parent = arrays.REVOLUTE, -1, -1
        self.counted, self.used = len(self.rows), False

    def report(self, joints, stops) -> None:
        """Add all coordinates of joints and stops that are not there yet."""
        for joint in joints:
            for k in range(len(joint.definition.measured)):
                self.number(joint, k)
        for stop in stops:
            self.number(stop.joint, stop.coordinate)

    def number(self, joint: Joint | Combination | Length, coordinate: int | str) -> int:
        """Return the index of a coordinate in the table; a new one is added."""
        self.used = True
        if isinstance(joint, Combination):
            return self._of_terms(joint)
        key = joint.index, coordinate
        if key not in self.numbers:
            self.numbers[key] = len(self.rows)
            self.rows.append(self._row(joint, coordinate))
            if isinstance(joint, Joint) and joint.name in self.placement.placed:
                put_in(joint, self.placement.placed[joint.name], self.rows[-1][0])
        return self.numbers[key]

    def _of_terms(self, combination: Combination) -> int:
        """Return the index of a combination in the table; a new one is added, with its terms."""
        terms = tuple((self.number(joint, k), factor) for joint, k, factor in combination.terms)
        if isinstance(combination, Wrap):
            return self._of_wrap(combination, [k for k, _ in terms])
        if terms not in self.sums:
            self.sums[terms] = self._sum(terms)
        return self.sums[terms]

    def _of_wrap(self, wrap: Wrap, own: list[int]) -> int:
        """Return the index of the length of a rope; its slip follows, then a sum that is always 0."""
        factors, none = tuple(factor for *_, factor in wrap.terms), (0.0,) * len(own)
        key = (*own, *factors, *wrap.slip)
        if key not in self.sums:
            self.sums[key] = len(self.rows)
            for row in (factors, wrap.slip, none):
                self._sum(tuple(zip(own, row)))
            made = table(arrays.WRAP, 1)
            made.strand[0] = [own[t] if t >= 0 else -1 for t in wrap.strands]
            made.angle[0], made.friction = wrap.angles, wrap.friction
            first, *between, last = (*wrap.guides, (wrap.way, 0.0, 0.0))[: max(2, len(wrap.guides))]
            made.way[0], made.guide[0, 1] = (-first[0], last[0]), int(bool(wrap.others))
            made.arc[0] = first[1], last[1]
            made.share[0] = 1.0, last[2] / wrap.friction
            made.between = sum(arc * mu for _, arc, mu in between) / wrap.friction
            self.wraps[self.sums[key]] = made
        return self.sums[key]

    def _sum(self, terms: tuple[tuple[int, float], ...]) -> int:
        """Add the row of a combination; return its index."""
        made, ends = table(arrays.COORDINATE, 1), [self.rows[k][0] for k, _ in terms]
        moved = [int(one.child if one.child >= 0 else one.parent) for one in ends]
        other = max(int(ends[0].parent) if ends[0].child >= 0 else -1, -1)
        made.kind, made.child = arrays.COMBINATION, moved[0]
        made.parent = moved[-1] if moved[-1] != moved[0] else other
        self.listed.append((len(self.rows), terms))
        self.rows.append(made)
        return len(self.rows) - 1

    def wrap(self, number: int) -> int:
        """Return 1 + the number of the wrap of a rope that rubs; 0 for other coordinates."""
        return 1 + list(self.wraps).index(number) if number in self.wraps else 0

    def bodies(self, number: int) -> set[int]:
        """Return the bodies that a coordinate moves."""
        row = self.rows[number][0]
        return {int(row.child), int(row.parent)} - {-1}

    def table(self) -> np.recarray:
        """Return all rows."""
        return np.concatenate([table(arrays.COORDINATE, 0), *self.rows]).view(Columns)

    def _of_gap(self, gap: Gap, row: int) -> np.recarray:
        """Return the row of a gap, or of a tangential speed."""
        made = table(arrays.COORDINATE, 1)
        made.kind, made.number = arrays.OF_LIMIT["gap"], 3 * gap.number + row
        made.child, made.parent = gap.child.index, -1
        return made

    def _of_length(self, length: Length) -> np.recarray:
        """Return the row of a distance."""
        made, place = table(arrays.COORDINATE, 1), self.placement.point
        made.kind = arrays.OF_LIMIT["length"]
        if isinstance(length, Strand) and length.axis.any():
            made.kind, made.length = arrays.OF_LIMIT["strand"], length.radii[0] - length.radii[1]
            made.parent_frame[0] = triad(length.axis)
            made.begin = length.start
        if isinstance(length, (Bush, Axial, BodyTurn)):
            frame = triad(length.axis)
            kinds = {Bush: arrays.OF_LIMIT["bush"], Axial: arrays.PRISMATIC}
            made.kind = kinds.get(type(length), arrays.REVOLUTE)
            made.length = length.radius if isinstance(length, Bush) else 0.0
            made.parent_frame[0] = self.placement.axes(length.parent, frame)
            made.child_frame[0] = self.placement.axes(length.child, frame)
        made.parent, made.child = length.parent.index, length.child.index
        made.parent_anchor[0] = place(length.parent, length.ends[0])
        made.child_anchor[0] = place(length.child, length.ends[1])
        return made

    def _row(self, joint, coordinate):
        if isinstance(joint, Gap):
            return self._of_gap(joint, coordinate)
        if isinstance(joint, Length):
            return self._of_length(joint)
        d, made = joint.definition, table(arrays.COORDINATE, 1)
        row = made[0]
        if d.guide == "curve":
            self.curves.add(joint, self.placement, row)
            return made
        first, second = (self.placement.side(joint, k) for k in range(2))
        if isinstance(coordinate, str):
            row.kind, frames = arrays.OF_LIMIT[coordinate], d.frames_of_limits()
        elif not d.coordinates:  # nothing acts along these: for reports alone
            row.kind, row.number, frames = arrays.KIND[type(d)], coordinate, (np.eye(3),) * 2
        else:
            turns = coordinate_kind(joint, coordinate) == "turn"
            row.kind = arrays.REVOLUTE if turns else arrays.PRISMATIC
            frames = (d.coordinate_frame(coordinate),) * 2
        if d.turn == "cross" and coordinate == 1:  # measured from the child
            first, second = second, first
        anchors = d.anchors(joint.anchor(), joint.child.position)
        row.parent, row.child = first.body.index, second.body.index
        row.parent_anchor[:], row.child_anchor[:] = (
            first.point(anchors[0]),
            second.point(anchors[1]),
        )
        row.parent_frame[:], row.child_frame[:] = first.axes(frames[0]), second.axes(frames[1])
        return made


class Elements:
    """The rows after the joints of a scene: relations, rows of the user's, springs and inertias as rows."""

    def __init__(self, scene, coordinates, functions: Functions, pieces: Pieces, sizes: np.ndarray):
        self.coordinates, self.sizes = coordinates, sizes
        self.kinds, self.rows, self.numbers, self.touching = [], [], [], []
        self.relations, self.user, self.stiff, self.rotors = [], [], [], []
        for force in scene.forces:
            d = force.definition
            if isinstance(d, JointInertia) and d.inertia > 0.0 and not is_off(scene, force):
                self._rotor(d)
        self.terms: list[list[tuple[int, float]]] = []
        self.pieces = pieces
        self.width = 9
        for constraint in scene.constraints:
            d = constraint.definition
            if is_off(scene, constraint):
                self._add(arrays.ABSENT, 0, 0, [])
            elif isinstance(d, Rows):
                self._user(constraint, functions)
            else:
                self._relation(constraint, functions, sizes)
                if constraint.name in scene._placed:
                    self.relations[-1].constant = scene._placed[constraint.name][0]

    @property
    def present(self) -> list[list[int]]:
        """The bodies of each element, without elements that are off."""
        return [bodies for bodies in self.touching if bodies]

    def _add(self, kind, rows, number, bodies):
        self.kinds.append(kind)
        self.rows.append(rows)
        self.numbers.append(number)
        self.touching.append(bodies)

    def add_springs(self, scene, placement) -> None:
        """Add the springs of a scene, between points and along coordinates, as rows for the implicit step."""
        for force in scene.forces:
            d = force.definition
            if is_off(scene, force):
                continue
            made = table(arrays.STIFF_SPRING, 1)
            if isinstance(d, Controlled) and d.is_damped_spring:
                made.stiffness, made.damping = d.spring
            elif (isinstance(d, JointSpring) and d.is_row) or (
                isinstance(d, Spring) and d.stiffness + d.damping > 0.0
            ):
                made.stiffness, made.damping = d.stiffness, d.damping
            else:
                continue
            if isinstance(d, (Controlled, JointSpring)):
                made.coordinate = self.coordinates.number(d.joint, d.coordinate)
                made.rest = getattr(d, "rest", 0.0)
                row = self.coordinates.rows[int(made.coordinate[0])]
                made.child, made.parent = row.child, row.parent
            else:
                made.coordinate, made.rest = -1, d.rest_length
                made.parent, made.child = force.parent.index, force.child.index
                made.parent_anchor[0] = placement.point(force.parent, d.anchor_parent)
                made.child_anchor[0] = placement.point(force.child, d.anchor_child)
            bodies = sorted({int(made.child[0]), int(made.parent[0])} - {-1})
            self._add(arrays.STIFF, 1, len(self.stiff), bodies)
            self.stiff.append(made)

    def _rotor(self, d):
        made = table(arrays.ROTOR, 1)
        made.coordinate, made.inertia = self.coordinates.number(d.joint, d.coordinate), d.inertia
        self.rotors.append(made)

    def add_rotors(self) -> None:
        """Add inertias along coordinates as rows, for closed loops."""
        for rotor in self.rotors:
            coordinate = int(rotor.coordinate[0])
            bodies = sorted(self.coordinates.bodies(coordinate))
            self._add(arrays.INERTIA, 1, len(self.relations), bodies)
            self.relations.append(table(arrays.RELATION_ROW, 1))
            self.terms.append([(coordinate, 1.0)])

    def _user(self, constraint, functions):
        d, name = constraint.definition, f"the constraint {constraint.name!r}"
        n, rows = len(d.bodies), d.rows
        made = table(arrays.USER_ROW, 1)
        made.address = functions.address(d.function, (n, 7), (rows, 6 * n + 1), name)
        if d.position is not None:
            position = f"the position of {name}"
            made.position_address = functions.address(d.position, (n, 7), (rows,), position)
        self.width = max(self.width, rows * (6 * n + 1), 7 * n)
        self._add(arrays.USER_ROWS, rows, len(self.user), [b.index for b in d.bodies])
        self.user.append(made)

    def _relation(self, constraint, functions, sizes):
        d, made = constraint.definition, table(arrays.RELATION_ROW, 1)
        given = d.terms if isinstance(d, Coupling) else ((d.joint, d.coordinate, 1.0),)
        terms = [(self.coordinates.number(joint, k), factor) for joint, k, factor in given]
        lengths = [
            abs(factor) * (1.0 if kind_of(joint, k) == "turn" else sizes[joint.child.index])
            for joint, k, factor in given
        ]
        made.scale, made.constant = max(lengths), getattr(d, "start", 0.0)
        if not isinstance(d, Coupling):
            self._motion(constraint, made, functions)
        bodies = sorted(set().union(*(self.coordinates.bodies(k) for k, _ in terms)))
        self._add(arrays.RELATION, 1, len(self.relations), bodies)
        self.relations.append(made)
        self.terms.append(terms)

    def _motion(self, constraint, made, functions):
        name = f"the motion of {constraint.name!r}"
        write_motion(constraint.definition, name, made, functions.address, self.pieces.add)

    def arrays(self, solver, more: ForceRows) -> arrays.Relations:
        """Return the tables, with the sides that `solver` gave to the bodies."""
        if not (self.present or self.coordinates.rows or more.any_apart):
            return no_relations()._replace(pieces=self.pieces.rows)
        there = 1 if self.present or self.coordinates.used or more.any_apart else 0
        terms = []
        relation = iter(range(len(self.relations)))
        inertias = (float(rotor.inertia[0]) for rotor in self.rotors)
        first_side = solver.rows.first[-len(self.kinds) :] if self.present else []
        rows = self.coordinates.table()
        own = zip(first_side, self.kinds, self.touching, self.numbers)
        for j, (first, kind, bodies, number) in enumerate(own, len(solver.rows) - len(self.kinds)):
            if kind == arrays.ABSENT:
                continue
            if kind == arrays.USER_ROWS:
                self.user[number].first, self.user[number].last = first, first + len(bodies)
                continue
            if kind == arrays.STIFF:
                made = self.stiff[number]
                made.element = j
                for name, b in (("child_side", made.child[0]), ("parent_side", made.parent[0])):
                    made[name] = first + bodies.index(b) if b >= 0 else -1
                solver.rows.ignored[solver.rows.first == first] = 1
                continue
            k = next(relation)
            self.relations[k].first = len(terms)
            for coordinate, factor in self.terms[k]:
                sides = [
                    first + bodies.index(b) if b >= 0 else -1
                    for b in (rows.child[coordinate], rows.parent[coordinate])
                ]
                terms.append((coordinate, factor, *sides))
            self.relations[k].last = len(terms)
            if kind == arrays.INERTIA:
                solver.rows.compliance[solver.rows.first == first, 0] = 1.0 / next(inertias)
        for number, own in self.coordinates.listed:  # no element has them
            made = table(arrays.RELATION_ROW, 1)
            made.first, made.last = len(terms), len(terms) + len(own)
            rows.number[number] = len(self.relations)
            self.relations.append(made)
            terms += [(coordinate, factor, -1, -1) for coordinate, factor in own]
        listed = table(arrays.TERM, len(terms))
        for t, values in zip(listed, terms):
            t.coordinate, t.factor, t.child_side, t.parent_side = values
        forces = (
            (arrays.STIFF_SPRING, self.stiff), (arrays.FRICTION, more.frictions), (arrays.ROTOR, self.rotors),
        )  # fmt: skip
        curves = self.coordinates.curves
        named = np.array(more.named, np.int64)
        read, write = np.zeros((2, max(self.width, more.width)))
        rows.index = np.arange(len(rows))
        kept = new_memory(
            len(rows), len(more.frictions), len(self.stiff), len(self.rotors), len(curves.rows)
        )
        kept.coordinates.reference[:] = rows.begin
        relations = _joined(arrays.RELATION_ROW, self.relations)
        user = _joined(arrays.USER_ROW, self.user)
        tables = relations, listed, user, self.pieces.rows, *(_joined(*one) for one in forces)
        tables += _joined(arrays.CURVE, curves.rows), _joined(arrays.CURVE_PIECE, curves.pieces)
        tables += (_joined(arrays.WRAP, list(self.coordinates.wraps.values())),)
        kept = kept._replace(read=read, write=write)
        return arrays.Relations._make([there, self.coordinates.counted, rows, *tables, named, kept])


def new_memory(
    coordinates: int = 0, frictions: int = 0, stiff: int = 0, rotors: int = 0, curves: int = 0
) -> memory.Memory:
    """Return the memory of a run that has not begun: friction sticks, and has no time to its stop."""
    rubs = table(memory.ACTIVE_POINT, frictions)
    for name in ("mode", "next"):
        rubs[name] = MODE_STICK
    turns, stretch = table(memory.TURN_OF_JOINT, coordinates), table(memory.STRETCH, stiff)
    none = np.zeros(0)
    return memory.Memory(
        turns, rubs, stretch, np.zeros(rotors), table(memory.FOOT, curves), none, none
    )


@cache
def no_relations() -> arrays.Relations:
    """Return the tables of a scene without coordinates."""
    a = arrays
    kinds = a.COORDINATE, a.RELATION_ROW, a.TERM, a.USER_ROW, PIECE
    kinds += a.STIFF_SPRING, a.FRICTION, a.ROTOR, a.CURVE, a.CURVE_PIECE, a.WRAP
    named = np.zeros(0, dtype=np.int64)
    return a.Relations._make([0, 0, *(table(kind, 0) for kind in kinds), named, new_memory()])


def _joined(fields, rows) -> np.recarray:
    return np.concatenate([table(fields, 0), *rows]).view(Columns)


def is_inertia(joints: np.recarray) -> np.ndarray:
    """Return which elements are inertias along coordinates, which are no constraints."""
    return joints.kind == arrays.INERTIA


def is_joint(joints: np.recarray) -> np.ndarray:
    """Return which elements are joints of the scene."""
    return joints.kind < arrays.RELATION
