"""A run at one time: what forces and reactions at this time are computed from, after the run has gone on."""

from __future__ import annotations

import numpy as np

from carom._compiled.record_arrays import copied, table
from carom.model.arrays import STATE
from carom.model.forces import settable


class Instant:
    """The forces of a run between two steps: `given` has those that were set, by index.

    Contact points, forces that were set and whole turns are copied, which takes some microseconds. Reactions of
    joints are solved for when they are asked for. `known` keeps what the next instant may need again.
    """

    def __init__(self, run, states: np.ndarray, t: float, given: dict, known: dict):
        self.run, self.states, self.t, self.given, self.pairs = run, states, t, given, run.pairs
        self.scene, self.compiled, self.options = (
            run.stands.view(run.scene),
            run.compiled,
            run.options,
        )
        system = run.compiled.system
        self.touch = touches(run)
        self.turns = system.relations.memory.coordinates["reference"].copy()
        self.numbers, self.counted = run.compiled.numbers, system.relations.counted
        if known.get("given") is not given:  # it is replaced where a force is set
            known["given"], known["loads"] = given, tuple(map(np.array, settable(system.forces)))
        self.loads = known["loads"]

    def solved(self, state) -> tuple[np.ndarray, dict[int, np.ndarray]]:
        """Return reactions of joints on their children, multipliers of constraints (1, E, 6); dry frictions."""
        from carom.results.dry_friction import with_dry_friction

        return with_dry_friction(self, state, self.touch, lambda *given: self.solve(*given)[0])

    def accelerations(self, state) -> np.ndarray:
        """Return the accelerations (N, 6) of all bodies, linear and angular, world axes."""
        from carom.results.dry_friction import with_forces

        forced = with_forces(state, state._solved[1], self.touch)
        return self.solve(self.compiled, forced)[1]

    def solve(self, compiled, touch) -> tuple[np.ndarray, np.ndarray]:
        """Return reactions on children (1, E, 6) and accelerations under forces at active points."""
        from carom.dynamics.reactions import reactions
        from carom.model.kept import Kept
        from carom.model.records import SERIES, TURN, new_work
        from carom.results.assemble import on_children

        run, system, touch = self.run, compiled.system, copied(touch)
        touch["saved"] = 1
        # the second of two equal states: whole turns are counted from those of the first
        states, series = table(STATE, 2, len(self.states)), table(SERIES, 2)
        states[:], series["t"] = self.states, self.t
        out = np.zeros((2, system.joints.size, 6))
        kept = Kept((system,))  # the run may go on
        reference = system.relations.memory.coordinates["reference"]
        for coordinate, number in self.numbers.items():
            reference[compiled.numbers[coordinate]] = self.turns[number]
        for there, was in zip(settable(system.forces), self.loads):
            there[:] = was
        work = new_work(system, run.method.b.size)
        turn = table(TURN, 2, 0)  # those that are known are in the system
        saved = run.records._replace(series=series, state=states, turn=turn, touch=touch)
        reactions(system, run.options.augmentation, saved, (1, 2), work, out)
        kept.restore()
        return on_children(compiled, states[1:], out[1:]), np.array(work.body["motion"])


def touches(run) -> np.recarray:
    """Return the active points of a run as it stands, as they are saved: rows of saved time 0."""
    count, clock, records = int(run.active.count[0]), run.clock, run.records
    if count == 0:
        return records.touch[:0]
    saved, end = int(clock["saved"][0]), int(clock["touched"][0])
    if records.series["t"][saved - 1] != clock["now"][0] or not end >= count:
        from carom.model.records import with_room

        kept = clock.copy()  # the state was not saved: it is, and the row is forgotten
        run.records = with_room(records, saved)
        run.save_now()
        rows = copied(run.records.touch[int(kept["touched"][0]) : int(clock["touched"][0])])
        clock[:] = kept
    else:
        rows = copied(records.touch[end - count : end])
    rows["saved"] = 0
    return rows
