"""Steps of a run whose loads stay below the limits at which joints break, taken without a return to Python.

The compiled loop looks at the loads (`carom.stepping.load_limits`) and ends after a step in which a limit may
have been passed. The run is then put back to where these steps began and goes on to the start of that step,
with the same bits; the step itself is one of `carom.watch.watched`. Beside conditions that are looked at from
Python after each step, such as functions of the user, the loop looks at the loads of this one step.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from carom.scene.joints import Joint
from carom.status import Status
from carom.stepping.load_limits import LoadLimits
from carom.watch.conditions import Condition
from carom.watch.loads import arrays_of_loads, set_forces
from carom.watch.switching import changes

#: steps that are taken at once, at most, and are taken again where one of them is to be looked at
STEPS_AT_ONCE = 64


class Within:
    """The conditions of a run by which joints break, if nothing else but times is to be looked at."""

    def __init__(self, watched: Any, conditions: list[Condition]):
        self.watched, self.at_once = watched, STEPS_AT_ONCE
        self.breaks = [i for i, c in enumerate(conditions) if c.breaks]
        timed = [c.switch is not None and c.switch.time is not None for c in conditions]
        self.able = bool(self.breaks) and all(c.breaks or t for c, t in zip(conditions, timed))
        self.limits: LoadLimits | None = None
        self.own: list[int] = []  # conditions of the limits
        self.known: dict[int, float] = {}  # loads at the end of the last step, below their limits
        self.compiled, self.view, self.reading = None, None, None

    def go_on(self, until: int) -> Status | None:
        """Go on towards step number `until`; return None if the next step is to be looked at from Python."""
        watched, run = self.watched, self.watched.run
        until = min(until, run.steps_done + self.at_once)
        if not self.able or self.at_once == 1 or until <= run.steps_done + 1 or not self.set():
            self.at_once = min(2 * self.at_once, STEPS_AT_ONCE)
            return None
        limits = self.limits
        assert limits is not None
        watched.before.take()
        run.limits = limits
        try:
            status = run.go_on(until)
        finally:
            run.limits = None
        if status is not Status.SUCCESS:
            return status
        if limits.place["beyond"][0] == 0:
            self.note(limits, 2)
            self.at_once = min(2 * self.at_once, STEPS_AT_ONCE)
            return status
        step = run.steps_done
        watched.put_back()
        if step - 1 > run.steps_done:
            self.note(limits, 1)
            status = run.go_on(step - 1)
        self.at_once = max(1, self.at_once // 4)
        return None if status is Status.SUCCESS else status

    def take_step(self) -> Status:
        """Take one step; know the loads at its end if none may have passed its limit within it."""
        run = self.watched.run
        self.known = {}
        # where nothing else is watched, the loop has asked for this step to be looked at from Python
        if self.able or not self.breaks or not (self.set() and self.own):
            return run.go_on(run.steps_done + 1)
        limits = self.limits
        assert limits is not None
        run.limits = limits
        try:
            status = run.go_on(run.steps_done + 1)
        finally:
            run.limits = None
        if status is Status.SUCCESS and limits.place["beyond"][0] == 0:
            self.known = {i: float(row.value[2]) for row, i in zip(limits.rows, self.own)}
        return status

    def set(self) -> bool:
        """Write the limits, and what is known of the loads; return whether the loop can look at them."""
        watched, run = self.watched, self.watched.run
        if self.compiled is not run.compiled or self.view is not run.stands:
            self.make(run)
        if self.limits is None:
            return False
        rows, place = self.limits.rows, self.limits.place
        set_forces(self.limits, run)
        last = watched.last
        place["known"], place["beyond"] = 1 if last is None else 2, 0
        place["struck"], place["whole"] = run.clock["struck"], run.clock["whole"]
        place["time"][0] = math.nan, math.nan if last is None else last[0], run.reached
        for row, i in zip(rows, self.own):
            row.value = math.nan, math.nan if last is None else last[1][i], watched.values[i]
        return True

    def make(self, run) -> None:
        """Make the rows of what may break, and the arrays with which its loads are found."""
        self.compiled, self.view, self.limits = run.compiled, run.stands, None
        conditions = self.watched.conditions
        self.own = [i for i in self.breaks if changes(run, conditions[i].switch)]
        parts = [conditions[i].switch.parts[0] for i in self.own]
        self.reading, limits = arrays_of_loads(run, len(parts))
        for row, part, i in zip(limits.rows, parts, self.own):
            given = conditions[i].switch.limits
            row.force, row.torque, row.impulse = (
                given.get(name, math.inf) for name in ("force", "torque", "impulse")
            )
            joint = isinstance(part, Joint)
            row.element = part.index if joint else -1
            row.contact = -1 if joint else len(run.pairs.body) + part.index
            row.flipped = int(joint and part.index in np.flatnonzero(self.reading.flipped))
        self.limits = limits

    def note(self, limits: LoadLimits, k: int) -> None:
        """Note the loads at the end of step `k` of the last three, and at the one before."""
        watched, time = self.watched, limits.place["time"][0]
        old = list(watched.values)
        watched.values = [
            v if math.isnan(v) or c.breaks else watched.run.reached - c.switch.time
            for v, c in zip(old, watched.conditions)
        ]
        for row, i in zip(limits.rows, self.own):
            old[i], watched.values[i] = float(row.value[k - 1]), float(row.value[k])
        watched.last = float(time[k - 1]), old
