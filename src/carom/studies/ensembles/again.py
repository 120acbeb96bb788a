"""A run that is set up once and started many times, each time like a new run.

To set up a run takes as long as hundreds of its steps: the scene is compiled, arrays are made, compiled code is
loaded. Here all data that a run changes are reset to their values before the first step instead, so that no run
depends on the runs before it. Values of the runs of a part are converted together: NumPy takes as long for one
run as for a hundred.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from carom.model.compile import attitudes
from carom.model.kept import Snapshot
from carom.model.laws import PERSISTENT, STRIKES
from carom.run import Run
from carom.scene.scene import Scene
from carom.stepping.settings import Settings
from carom.studies.ensembles.robots import PLACED, put
from carom.studies.values import Target, check_places, may_overlap, units

STATES = {"position": "x", "orientation": "Q", "velocity": "v", "angular_velocity": "w"}
TURNING = ("rolling_friction", "pivoting_friction")


class Again:
    """A `Run` with values that differ from one start to the next."""

    def __init__(self, scene: Scene, settings: Settings, targets: list[Target]):
        self.scene, self.targets = scene, targets
        self.values: dict[str, np.ndarray] = {}
        self.run = Run(scene, settings)
        self.first = Snapshot(self.run)

    def start(self, values: dict[str, np.ndarray], k: int) -> Run:
        """Return the run, prepared to start with the values of row k of each name.

        Raises
        ------
        ValueError
            If bodies penetrate each other at the start, or the start violates a joint.
        """
        self.first.put_back()
        if values is not self.values:
            self.take(values)
        if self.near[k]:
            check_places(self.scene, self.targets, row(values, k))
        for there, rows in self.written:
            there[...] = rows[k]
        run = self.run
        put(run, self.targets, row(values, k))
        run.clock["saved"] = 0
        run.compiled.functions.forget()  # the error of a user-defined function in the last run
        run.check(run.scene)
        run.save_now()
        return run

    def take(self, values: dict[str, np.ndarray]) -> None:
        """Prepare what the runs with these values write at their start."""
        self.near = may_overlap(self.scene, self.targets, values)
        self.written = [pair for target in self.targets for pair in self.writes(target, values)]
        self.values = values

    def writes(self, target: Target, values: dict) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield arrays of the run, and rows (K, ...) of which each run writes its own there."""
        run, k, value = self.run, target.index, values[target.name]
        if target.field in PLACED:  # by `put`
            return
        if target.field in STATES:
            if target.field == "orientation":
                value = attitudes(units(value), run.to_principal[k])
            yield run.now[STATES[target.field]][k], value
            return
        law = self.scene.contacts[k]
        follows = target.field == "friction" and f"{target.part}.friction_held" not in values
        follows = follows and law.friction_held == law.friction
        name = "friction" if target.field == "friction_held" else target.field
        for which in (STRIKES, PERSISTENT):
            if name != "friction" or follows or (target.field == "friction") == (which == STRIKES):
                for column in self.of_laws(k, which, name):
                    yield column, value

    def of_laws(self, k: int, which: int, name: str) -> Iterator[np.ndarray]:
        """Yield the places (1,) of a column of the laws of contact k, in impacts or in persistent contact."""
        system = self.run.compiled.system
        rows = slice(*np.searchsorted(system.contacts["number"], (k, k + 1)))
        table = system.laws.table
        column = table["turning"][:, TURNING.index(name)] if name in TURNING else table[name]
        for law in np.unique(system.contacts["law"][rows, which]).tolist():
            yield column[law : law + 1]


def row(values: dict[str, np.ndarray], k: int) -> dict[str, np.ndarray]:
    """Return the values of one run."""
    return {name: rows[k, ...] for name, rows in values.items()}
