"""The rows of the forces of a scene, by which it states them to kernels."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom import checks
from carom._compiled.composed import is_compiled, joined, once
from carom._compiled.record_arrays import table
from carom._compiled.user_functions import Functions
from carom.model.arrays import FRICTION
from carom.model.forces import FRICTIONS, Forces, Place, bodies_in
from carom.model.laws import LawTable
from carom.model.pieces import Pieces
from carom.model.placement import Placement
from carom.scene.force_definition import ForceTable
from carom.scene.forces import TABLES
from carom.scene.friction import bound_of
from carom.scene.joint_friction import Drive, DryFriction
from carom.scene.switches import is_off


class ForceRows:
    """The rows of the forces of a scene; their definitions ask for points, coordinates and addresses."""

    def __init__(
        self, scene, placement: Placement, coordinates: Any, functions: Functions, pieces: Pieces,
        friction_laws: LawTable, implicit: bool,
    ):  # fmt: skip
        self.point, self.axes, self.curve = placement.point, placement.axes, pieces.add
        self.function = functions.address
        self.coordinates, self.implicit = coordinates, implicit
        self.frictions, self.named, self.width, self.loads = [], [], 0, 0
        self.places: dict[int, Place] = {}
        rows, numbers = [[] for _ in TABLES], {kind.name: k for k, kind in enumerate(TABLES)}
        for force in scene.forces:
            d = force.definition
            if is_off(scene, force):
                continue
            if d.table is not None:
                kind = numbers[d.table.name]
                self._place(force, kind, rows[kind], d._rows(force, self))
            elif isinstance(d, DryFriction) and bound_of(d.law) > 0.0:
                made = _friction(d, coordinates, friction_laws)
                made.load = self.loads if d.by_load else -1
                self.loads += d.by_load
                if isinstance(d, Drive) and not d.holds:
                    made.drives = 1
                    name = f"the motion of {force.name!r}"
                    write_motion(d, name, made, functions.address, pieces.add)
                    self.width = max(self.width, 3)
                self._place(force, FRICTIONS, self.frictions, [made])
        self.tables = Forces(*map(_filled, TABLES, rows))

    def turn(self, flipped: np.ndarray) -> None:
        """Note which joints, whose reactions are loads, were turned round in the tree."""
        for one in self.frictions:
            if one.joint[0] >= 0:
                one.flipped = flipped[int(one.joint[0])]

    def _place(self, force, kind: int, rows: list, made: list) -> None:
        if made:
            self.places[force.index] = Place(kind, len(rows), len(rows) + len(made))
            rows += made

    @property
    def any_apart(self) -> bool:
        """Whether there are any whose kernels are loaded only by scenes that need them."""
        apart = (len(rows) for kind, rows in zip(TABLES, self.tables) if kind.apart)
        return any(apart) or len(self.frictions) > 0

    @property
    def loaded(self) -> np.ndarray:
        """The bodies on which they act directly, -1 among them."""
        columns = [rows[name] for rows in self.tables for name in bodies_in(rows)]
        return np.concatenate([*columns, np.array(self.named, dtype=np.int64)])

    def coordinate(self, joint, number: int) -> int:
        """Return the place of a coordinate of a joint in its table."""
        return self.coordinates.number(joint, number)

    def along_joint(self, function, force) -> int | None:
        """Return the address of a function of time, coordinate and rate."""
        return self.function(of_coordinate(function), (2,), (1,), f"the force {force.name!r}")

    def list_bodies(self, bodies) -> tuple[int, int]:
        """Return the range of bodies in `Relations.named`, which are the argument of a function."""
        first = len(self.named)
        self.named += [b.index for b in bodies]
        self.width = max(self.width, 13 * len(bodies))
        return first, len(self.named)


def _filled(kind: ForceTable, rows: list[dict[str, Any]]) -> np.recarray:
    made = table(kind.columns, len(rows))
    for k, row in enumerate(rows):
        for name, value in row.items():
            made[name][k] = value
    return made


def _friction(d, coordinates, friction_laws: LawTable):
    made = table(FRICTION, 1)
    made.coordinate, made.law = (
        coordinates.number(d.joint, d.coordinate),
        friction_laws.add(d.law),
    )
    for name, value in d.load.items():
        made[name] = value
    made.joint = d.joint.index if d.by_load else -1
    return made


def write_motion(d, name: str, made, address, piece) -> None:
    """Write a prescribed motion, or its constant rate, to the columns `PRESCRIBED` of a row."""
    if d.rate is not None:
        made.rate = d.rate
    elif checks.is_polynomial(d.motion):
        made.piece, made.last_piece = piece(d.motion)
    else:
        made.address = address(of_time(d.motion), (1,), (3,), name)


@once
def of_time(function):
    """Return a function of (t, x) from a function of t."""
    if not is_compiled(function):
        return lambda t, x: function(float(t))

    def call(t, x):
        out = np.empty(3)
        out[0], out[1], out[2] = function(t)
        return out

    return joined(call, function)


@once
def of_coordinate(function):
    """Return a function of (t, x), x = (q, q'), from a function of t, q and q'."""
    if not is_compiled(function):
        return lambda t, x: function(float(t), float(x[0]), float(x[1]))

    def call(t, x):
        return function(t, x[0], x[1])

    return joined(call, function)
