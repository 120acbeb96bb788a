"""Accelerations and forces of contacts of a run at the present time, for the sensors of a model."""

from __future__ import annotations

import numpy as np

from carom._compiled.record_arrays import table
from carom.control.endless import Endless
from carom.dynamics.methods import METHODS
from carom.model import records as r
from carom.model.arrays import STATE
from carom.model.compile import compiled_once
from carom.model.method import IMPLICIT, THREE_FIELD
from carom.results.assemble import acceleration
from carom.results.sensors import Measured


class Meter:
    """A second compiled scene: solving in that of the run would change what its next step begins with."""

    def __init__(self, run: Endless):
        kind = METHODS[run.how.method].kind
        ways = kind == THREE_FIELD, kind == IMPLICIT, run.apart
        self.system = compiled_once(run.scene, run.options, *ways).system
        self.work = r.new_work(self.system, run.method.b.size)

    def read(self, run: Endless) -> Measured:
        """Return what sensors read at the present time."""
        its = run.compiled.system
        self.system.loads[:], self.system.relations.pushes[:] = its.loads, its.relations.pushes
        coordinates = self.system.relations.coordinates
        coordinates["reference"] = its.relations.coordinates["reference"]
        touch = present_touches(run)
        states = table(STATE, 2, len(run.now))
        states[:] = run.now
        touch["saved"] = 1  # the second state keeps the turns that were counted
        times = np.full(2, run.reached)
        given = self.system, run.options, times, states, 1, touch, self.work
        return Measured(acceleration(*given).copy(), touch, len(run.pairs.body))


def present_touches(run: Endless) -> np.ndarray:
    """Return the forces at all points of persistent contact; where they were not saved, they are for this."""
    clock = run.clock.copy()
    if run.records.series["t"][int(clock["saved"][0]) - 1] != run.reached:
        run.records = r.with_room(run.records, int(clock["saved"][0]))
        if len(run.records.touch) < int(clock["touched"][0]) + int(run.active.count[0]):
            run.records = r.longer(run.records, run.clock)
        run.save_now()
    last, end = int(run.clock["saved"][0]) - 1, int(run.clock["touched"][0])
    first = np.searchsorted(run.records.touch["saved"][:end], last)
    touch = run.records.touch[first:end].copy()
    run.clock[:] = clock
    return touch
