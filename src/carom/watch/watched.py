"""A run that is watched for events and switches: after each step, and again within one in which they happened.

Where a value has changed its sign the run is put back to the start of the step, and steps from there to trial
times, which Brent's method chooses: so the state at the event is one of the motion itself. Then the step is
taken once more as a whole, with the same bits as without a watch.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from carom._compiled.user_functions import raised
from carom.model.kept import Snapshot
from carom.model.records import with_room
from carom.results.solution import Solution
from carom.results.state import SystemState
from carom.run import Run
from carom.status import Status
from carom.stepping.grid import cut_grid
from carom.watch.conditions import Condition, Observed
from carom.watch.limits import Within
from carom.watch.switching import changes, switch, switches_of

ROUND_OFF = 4.0 * float(np.finfo(float).eps)  # of a time: no interval is halved that is shorter
NO_STEP = 4e-12  # of a time: a step of this length is none, but not divided from the one before by its end
LEAST = 1e-300  # stands for a value of exactly 0, which counts as changed


class Happened(NamedTuple):
    """An event, and the state at its time."""

    condition: int
    t: float
    state: SystemState | None  # None of a switch


class _Failed(Exception):
    """A trial that did not reach its time."""

    def __init__(self, status: Status):
        super().__init__(status.message)
        self.status = status


class Watched:
    """A `Run` with conditions: what takes a run to its end takes this one."""

    def __init__(self, run: Run, events: list[Condition] | None = None):
        self.run, self.events = run, events
        self.conditions = conditions = [*(events or ()), *switches_of(run.scene)]
        # steps by which switches have divided those of the run, here of a run that goes on
        self.more = run.divide_as_before()
        self.before, self.grids = Snapshot(run), (run.grid, run.controls)
        self.happened: list[Happened] = []
        self.times = [self.has_acted(c) for c in conditions]  # how often each has happened
        self.stopped_by, self.joints = "", {}
        self.began, self.struck = 0.0, 0
        self.last: tuple[float, list[float]] | None = None  # time and values before the last step
        self.asked, self.at = "", 0.0  # the condition that was evaluated last, and its time
        self.timed = all(c.switch is not None and c.switch.time is not None for c in conditions)
        self.within = Within(self, conditions)
        self.values = self.evaluated()
        self.break_at_once()

    def __getattr__(self, name: str) -> Any:
        # what the watch does not change: `failure`, `go_back`, ...
        return getattr(self.run, name)

    @property
    def steps(self) -> int:
        """Number of steps to the end, as planned."""
        return self.run.steps - self.more

    @property
    def steps_done(self) -> int:
        """Number of finished steps of those that were planned."""
        return self.run.steps_done - self.more

    def go_on(self, until: int) -> Status:
        """Go on to step number `until`, to an event that ends the run, or to a failure."""
        run, status = self.run, Status.SUCCESS
        self.grids = run.grid, run.controls
        while status is Status.SUCCESS and self.steps_done < until:
            if self.timed and (quiet := self.steps_before_switch(until)) > run.steps_done:
                status = run.go_on(quiet)
                continue
            if self.within.able:
                quiet = self.within.go_on(self.steps_before_switch(until))
                if quiet is not None:
                    status = quiet
                    continue
            self.began, self.struck = run.reached, int(run.clock["struck"][0])
            self.before.take()
            status = self.within.take_step()
            if status is Status.SUCCESS:
                status = self.check()
        return status

    def steps_before_switch(self, until: int) -> int:
        """Return the number of the step before that in which the next switch with a time acts."""
        run = self.run
        times = [c.switch.time for c in self.conditions if c.switch.time is not None]
        left = [time for time in times if time > run.reached]
        last = until + self.more
        return min(last, run.step_at(min(left)) - 1) if left else last

    def has_acted(self, condition: Condition) -> int:
        """Return how often a switch has acted in a run that goes on."""
        if condition.switch is None:
            return 0
        own = self.run.switched["time"][self.run.switched["switch"] == condition.switch.index]
        return len(np.unique(own))

    def evaluated(self) -> list[float]:
        """Return the values of all conditions now; what is to rest is yet to."""
        look = self.look(at_end=False)
        self.asked, self.at = "", look.t
        return [
            1.0 if c.rest and c.switch is None else self.value(i, look)
            for i, c in enumerate(self.conditions)
        ]

    def divide(self, t: float) -> None:
        """Let a step end at time t."""
        self.more += self.run.divide(t)

    def solution(self, status: Status) -> Solution:
        """Return the solution, with the events that happened."""
        if status is Status.STOPPED:
            judged = self.run.judged(Status.SUCCESS)
            status = status if judged is Status.SUCCESS else judged
        if self.events is None:
            return self.run.solution(status)
        own = [
            [one.state for one in self.happened if one.condition == i and one.state is not None]
            for i in range(len(self.events))
        ]
        return self.run.solution(
            status, t_events=[np.array([state.t for state in states]) for states in own],
            state_events=own, _stopped_by=self.stopped_by,
        )  # fmt: skip

    def look(self, at_end: bool = True) -> Observed:
        """Return the run as conditions see it, at the end of a step or before any after a change."""
        look = Observed(self.run, self.joints, self.struck, at_end)
        if self.events:
            _ = (
                look.state
            )  # it is kept: the state of an event is that of before what the event changes
        return look

    def value(self, i: int, look: Observed) -> float:
        """Return the value of condition i; NaN of a switch that would change nothing, or has had its event."""
        condition, one = self.conditions[i], self.conditions[i].switch
        if one is not None:
            if not changes(self.run, one) or (one.event is not None and self.times[i] > 0):
                return math.nan
        self.asked, self.at = condition.name, look.t
        return condition.value(look)

    def check(self) -> Status:
        """Look at the step that was just taken; go back before it where that fails."""
        try:
            return self.find()
        except _Failed as error:
            self.put_back()
            return error.status
        except KeyboardInterrupt:
            self.put_back()
            raise
        except Exception as error:  # of a function of the user's
            self.put_back()
            self.run.compiled.functions.fail(
                error, f"{self.asked} {raised(error)} at t = {self.at:.9g} s"
            )
            return Status.FUNCTION_FAILED

    def find(self) -> Status:
        """Find the events of the last step, and stop at the first that ends the run."""
        look, step, known = self.look(), self.run.steps_done, self.within.known
        now = [known[i] if i in known else self.value(i, look) for i in range(len(self.conditions))]
        old, self.values = self.values, now
        ends = [look] * len(old)
        self.end_at_peaks(old, ends, step)
        changed = [i for i, c in enumerate(self.conditions) if crosses(c, old[i], self.values[i])]
        if not changed:
            return Status.SUCCESS
        near = [self.conditions[i].when(ends[i]) for i in changed]
        found = []
        for i, guess in zip(changed, near):
            if self.conditions[i].rest and not self.still_rests(step, look.t):
                self.values[i] = 1.0
                continue
            one = self.conditions[i].switch
            if one is not None and one.time is not None:
                found.append(Happened(i, one.time, None))
                continue
            there = self.locate(i, step, old[i], ends[i], guess)
            found.append(Happened(i, there.t, there.state if one is None else None))
        found.sort(key=lambda one: one.t)
        for one in found:
            condition = self.conditions[one.condition]
            if condition.switch is not None:
                return self.act(found, one.t, step)
            self.happened.append(one)
            self.times[one.condition] += 1
            if self.times[one.condition] == condition.terminal:
                return self.stop(condition, step, one.t)
        self.put_back()
        return self.run.go_on(step)

    def end_at_peaks(self, old: list[float], ends: list[Observed], step: int) -> None:
        """Let a load that has passed its limit within the step, and come back, end where it is greatest.

        The parabola through the values at the ends of the last two steps says where that is, and whether the
        load may exceed its limit there.
        """
        last, self.last = self.last, (self.began, old)
        moved = False
        for i, condition in enumerate(self.conditions if last is not None else ()):
            if not condition.breaks or not max(old[i], self.values[i]) < 0.0:
                continue
            assert last is not None
            t, most = peak((last[0], self.began, ends[i].t), (last[1][i], old[i], self.values[i]))
            if most > 0.0 and self.began < t < ends[i].t:
                self.put_back()
                self.go_to(step, t)
                moved, there = True, self.look()
                if (value := self.value(i, there)) > 0.0:
                    self.values[i], ends[i] = value, there
        if moved:
            self.put_back()
            status = self.run.go_on(step)
            if status is not Status.SUCCESS:
                raise _Failed(status)

    def act(self, found: list[Happened], t: float, step: int) -> Status:
        """Let the switches act that have been found at time t, within the last step; the run stands there."""
        self.put_back()
        status, within = Status.SUCCESS, t * (1.0 + ROUND_OFF)
        if self.run.step_at(t) == step:
            # an impact at the start of the step is to be behind
            t = max(t, self.began * (1.0 + NO_STEP))
            self.divide(t)
            self.grids = self.run.grid, self.run.controls
            status = self.run.go_on(step)
        for one in found:
            condition = self.conditions[one.condition]
            if one.t > within or status is not Status.SUCCESS:
                break
            if condition.switch is not None:
                self.times[one.condition] += 1
                self.apply(condition.switch)
        self.values, self.last = self.evaluated(), None
        self.break_at_once()
        return status

    def apply(self, one: Any) -> None:
        """Switch the parts of a switch."""
        self.asked, self.at = f"switch {one.name!r}", self.run.reached
        for part in changes(self.run, one):
            switch(self.run, part, not one.off, one.index)
        self.joints = {}

    def break_at_once(self) -> None:
        """Break what exceeds its limit in the present state, until nothing does."""
        while True:
            beyond = [
                c for c, value in zip(self.conditions, self.values) if c.breaks and value > 0.0
            ]
            if not beyond:
                return
            for condition in beyond:
                self.apply(condition.switch)
            self.values = self.evaluated()

    def locate(
        self, i: int, step: int, first: float, end: Observed, guess: float | None
    ) -> Observed:
        """Return the first time at which condition i has another sign than at the start of the step."""
        from scipy.optimize import brentq

        side, best = math.copysign(1.0, first), end
        known = {self.began: first, end.t: self.values[i] or -side * LEAST}

        def value(t: float) -> float:
            nonlocal best
            if t not in known:
                self.put_back()
                self.go_to(step, t)
                look = self.look()
                known[t] = self.value(i, look) or -side * LEAST
                if known[t] * side < 0.0 and t < best.t:
                    best = look
            return known[t]

        low, high, shortest = self.began, end.t, ROUND_OFF * end.t
        for t in () if guess is None else (guess + shortest, guess - shortest):
            if low < t < high:
                low, high = (t, high) if value(t) * side > 0.0 else (low, t)
        brentq(value, low, high, xtol=shortest, rtol=np.float64(ROUND_OFF), maxiter=500)
        return best

    def still_rests(self, step: int, end: float) -> bool:
        """Return whether nothing moves after one step more: a body may turn round at the end of a step."""
        run = self.run
        self.put_back()
        status = run.go_on(step)
        if status is Status.SUCCESS:
            run.records = with_room(run.records, int(run.clock["saved"][0]))
            self.go_to(step + 1, end + run.grid.interval)
            return self.run.clock["still"][0] <= end
        raise _Failed(status)

    def stop(self, condition: Condition, step: int, t: float) -> Status:
        """End the run at time t, within this step."""
        run, how = self.run, self.run.how
        self.put_back()
        self.go_to(step, t)
        run.how = how._replace(duration=t, earlier=(*how.earlier, how.duration))
        self.stopped_by = condition.name
        return Status.STOPPED

    def go_to(self, step: int, t: float) -> None:
        """Take the run to a step that ends at time t."""
        run, (grid, controls) = self.run, self.grids
        run.grid, run.controls = cut_grid(grid, step, t), controls._replace(duration=t)
        status = run.go_on(step)
        if status is not Status.SUCCESS:
            raise _Failed(status)

    def put_back(self) -> None:
        """Put the run back to the start of the step, with the steps that it was to take."""
        self.before.put_back()
        self.run.grid, self.run.controls = self.grids


def crosses(condition: Condition, old: float, new: float) -> bool:
    """Return whether a value has come to zero, or past it, in the direction that counts."""
    rises, falls = old < 0.0 <= new, old > 0.0 >= new
    return (rises and condition.direction >= 0.0) or (falls and condition.direction <= 0.0)


def peak(t: tuple[float, float, float], f: tuple[float, float, float]) -> tuple[float, float]:
    """Return where the parabola through three points is greatest, and its value there; NaN if it has none."""
    a, b = (f[1] - f[0]) / (t[1] - t[0]), (f[2] - f[1]) / (t[2] - t[1])
    bend = (b - a) / (t[2] - t[0])
    if not bend < 0.0:
        return math.nan, math.nan
    top = 0.5 * (t[0] + t[1] - a / bend)  # f' = a + bend (2 t - t0 - t1) = 0
    return top, f[0] + (top - t[0]) * (a + bend * (top - t[1]))


def watched(run, events: list[Condition] | None = None) -> Any:
    """Return a run that is watched for events and for what switches its scene has; itself if there are none."""
    acts = events is not None or any(one.at is not None for one in run.scene.switches)
    return Watched(run, events) if acts else run
