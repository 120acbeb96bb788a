"""What a solution holds of a run that goes on: copies of its records."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from carom.control.applied import rows_of_forces
from carom.control.endless import Endless
from carom.io.files.kept import KeptRun
from carom.model import records as r
from carom.results.solution import Solution
from carom.status import Status


class Frozen(KeptRun):
    """The records of a run up to some time, and the forces that were set until then."""

    def __init__(self, run: Endless, settings: dict, history: list[tuple[int, Any, Any]]):
        records, past = r.trimmed(run.records, run.clock), {"status": Status.SUCCESS.name}
        super().__init__(run.scene, settings, run.options, records, None, [], past, run.found)
        self.history = history

    def rows_of_forces(self, system, saved: int):
        """Go through ranges of saved rows in which forces stay as they are; write them into the system."""
        return rows_of_forces(self.history, system, saved)


def solution_of(run: Endless, status: Status, history: list[tuple[int, Any, Any]]) -> Solution:
    """Return the solution of a run up to now; the run may go on, and knows nothing of it."""
    clock = run.clock.copy()
    if run.reached > run.records.series["t"][int(clock["saved"][0]) - 1] and status.ended:
        run.records = r.room_for_one(run.records, int(clock["saved"][0]))
        run.save_now()
    made = run.solution(status)
    longest = run.how.step or run.controls.interval
    settings = {**made.settings, "duration": max(run.reached, longest)}
    made = replace(made, settings=settings, _run=Frozen(run, settings, list(history)))
    run.clock[:] = clock
    return made
