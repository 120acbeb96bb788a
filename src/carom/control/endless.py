"""A run without an end: its steps are made as they are asked for, and its records grow."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from carom import checks
from carom.dynamics.adapt import time_of_bounces
from carom.dynamics.thresholds import FIRST_STEP
from carom.geometry.thresholds import ROUND_OFF
from carom.io.files.checkpoint import Checkpoint, restore
from carom.model import records as r
from carom.model.kept import Snapshot
from carom.run import Run
from carom.status import Status
from carom.stepping.grid import Grid, count, longest_step, step_at, with_end
from carom.stepping.thresholds import MOST_STEPS

BLOCK = 1024  # steps for which there is room at first
PART = 65536  # rows for which room is made at a time
#: what the clock of a run keeps when its bodies are moved
GOES_ON = (
    "now", "loads", "impacts", "friction", "bounces", "step", "saved", "struck", "event", "snapped",
    "touched", "cuts", "trials", "rejected", "located", "holds", "contact_steps", "rounds", "whole",
    "parts", "fallen",
)  # fmt: skip
MOST = 1e7  # longest steps in a call, where tolerances choose them


class Endless(Run):
    """A run that goes on for as long as it is asked to."""

    def first_grid(self, duration: float) -> Grid:
        """Return the first steps: all alike where the step is given, else none yet."""
        how, none = self.how, (np.zeros(0), np.zeros(0, dtype=np.int64))
        self.asked, self.base, self.wait, self.times, self.before = 0, 0.0, 0.0, 0, 0
        if how.step is not None:
            last = min(BLOCK * how.save_every, 2**62)
            return Grid(how.step, last, how.save_every, *none)
        system, start = self.compiled.system, self.compiled.start
        later = self.compiled.later is not None
        self.longest = longest_step(system, start, math.inf, self.options.max_step, later)
        ends, saves = np.zeros(BLOCK + 1), np.ones(BLOCK + 1, dtype=np.int64)
        return Grid(min(self.longest, 1.0), BLOCK, 0, ends, saves)

    def stand(self, kept, checkpoint: Checkpoint) -> None:
        """Stand at the checkpoint of another run of the same scene; `kept` has its records."""
        if kept.found is not None:
            self.add_pairs(kept.found[: checkpoint.found["pairs"]])
        self.records = r.with_room(self.records, 1, len(kept.records.series))
        self.stand_at_end_of(kept.switched)
        restore(self, checkpoint, kept.records)
        self.asked, self.base, self.before = self.how.save_every, self.reached, self.steps_done
        if self.how.step is None:
            self.controls = self.controls._replace(interval=0.0)  # that of the next steps
        elif self.reached != self.before * self.how.step:  # an event has ended it, or it had times
            none = np.zeros(0), np.zeros(0, dtype=np.int64)
            self.grid = Grid(self.how.step, 0, self.how.save_every, *none)
        if self.how.step is None or not self.grid.last:
            self.make_ends(self.before)
            self.grid.ends[self.before] = self.base

    def move(self, old: Endless, place: Callable[[], None]) -> None:
        """Go on from the time of an old run with its records, in another state, which `place` writes.

        The change of energy is work of what has moved the bodies.
        """
        before, mine = old.clock[0], self.clock[0]
        if old.found is not None:
            self.add_pairs(old.found)
        self.grid, self.records, self.watch = old.grid, old.records, old.watch
        self.asked, self.base, self.before = old.asked, old.base, old.before
        self.wait, self.times, self.controls = old.wait, old.times, old.controls
        for name in GOES_ON:
            mine[name] = before[name]
        self.work.step["begin"] = mine.now
        if len(old.switched):
            self.switched = old.switched
            self.stand_as(old.stands)
        if self.tolerances is not None:
            self.work.body["ahead"] = FIRST_STEP * self.controls.interval
        place()
        if self.records.series["t"][mine.saved - 1] == mine.now:  # the new state takes its place
            mine.saved -= 1
            touch = self.records.touch["saved"][: mine.touched]
            mine.touched = np.searchsorted(touch, mine.saved)
        self.records = r.with_room(self.records, int(mine.saved))
        self.save_now()
        given = mine.kinetic + mine.potential - before.kinetic - before.potential
        mine.loads += given
        self.records.series["loads"][mine.saved - 1] += given

    def divide_as_before(self) -> int:
        """Return 0: the steps of this run begin where it stands."""
        return 0

    def step_at(self, t: float) -> int:
        """Return the number of the step in which the run reaches a time; one more than are known for later."""
        return step_at(self.known_grid(), t)

    def known_grid(self) -> Grid:
        """Return the steps that have been asked for."""
        grid = self.grid
        if not len(grid.ends):
            return grid
        last = int(np.argmax(grid.ends))
        return grid._replace(last=last, ends=grid.ends[: last + 1], saves=grid.saves[: last + 1])

    def divide(self, t: float) -> bool:
        """Let a step end at a time t to come; the steps after it have numbers greater by one."""
        grid, room = self.known_grid(), len(self.grid.ends)
        self.grid = with_end(grid, t, self.controls.duration)
        divided = self.grid.last > grid.last
        self.before += divided
        self.make_ends(max(room, self.grid.last))
        self.records = r.with_room(self.records, int(self.clock["saved"][0]))
        return divided

    def go_on(self, until: int) -> Status:
        """Go on to step number `until`, or to a failure: in parts, for which room is made."""
        status, part = Status.SUCCESS, PART * max(1, self.grid.save_every)
        while status is Status.SUCCESS and self.steps_done < until:
            goal = min(until, self.steps_done + part)
            rows = 2 + (goal - self.steps_done) // max(1, self.grid.save_every)
            self.records = r.with_room(self.records, int(self.clock["saved"][0]), rows)
            status = super().go_on(goal)
        return status

    def ask(self, duration: float | None) -> int:
        """Have steps ready for so much time [s], and return the number of the last of them."""
        step = self.how.step
        if step is None:
            if duration is None:
                raise ValueError("duration must be given [s] where no step is")
            most = MOST * self.longest if math.isfinite(self.longest) else None
            return self.ask_time(
                checks.number("duration", duration, above=0.0, most=most, unit="s")
            )
        steps = 1
        if duration is not None:
            most = MOST_STEPS * step
            duration = checks.number("duration", duration, above=0.0, most=most, unit="s")
            steps = round(duration / step)
            if steps < 1 or abs(steps * step - duration) > 1e3 * ROUND_OFF * duration:
                raise ValueError(
                    f"duration must be a whole multiple of the step of {step:g} s, got {duration!r}"
                )
        until = self.steps_done + steps
        if len(self.grid.ends):
            self.make_ends(until)
            later = np.arange(self.steps_done, until) - self.before + 1
            self.grid.ends[later + self.before] = self.base + later * step
            self.grid.saves[later + self.before] = later % self.how.save_every == 0
            self.controls = self.controls._replace(duration=self.grid.ends[until])
            return until
        while until >= self.grid.last:
            self.grid = self.grid._replace(last=2 * self.grid.last)
            self.controls = self.controls._replace(duration=self.grid.last * step)
        return until

    def ask_time(self, wait: float) -> int:
        """Have steps ready, none longer than the longest, that end so much later."""
        done = self.steps_done
        if wait == self.wait:
            self.times += 1
        else:
            self.base, self.wait, self.times = self.reached, wait, 1
        begin, end, n = self.reached, self.base + self.times * wait, count(wait, self.longest)
        if not end > begin:
            raise ValueError(f"duration must be more than round-off of the time, got {wait:g} s")
        piece, until = wait / n, done + n
        self.make_ends(until)
        ends, saves = self.grid.ends, self.grid.saves
        ends[done + 1 : until + 1] = begin + (end - begin) * np.arange(1, n + 1) / n
        ends[until] = end
        self.asked += 1
        saves[done + 1 : until + 1] = 0
        saves[until] = int(self.asked % self.how.save_every == 0)
        if self.asked == 1 or piece > self.controls.interval:
            self.aim(piece)
        self.controls = self.controls._replace(duration=end)
        return until

    def aim(self, piece: float) -> None:
        """Note how long a step of the run may be."""
        system, tolerances = self.compiled.system, self.tolerances
        assert tolerances is not None
        bounces = time_of_bounces(system, tolerances, piece)
        self.controls = self.controls._replace(step=bounces, interval=piece)
        self.grid = self.grid._replace(interval=piece)
        if self.asked == 1:
            flies = system.bodies["ballistic"] == 1
            self.work.body["ahead"] = np.where(flies, 1.0, FIRST_STEP) * piece

    def make_ends(self, until: int) -> None:
        """Make the list of the ends of steps longer where it is too short."""
        known = len(self.grid.ends)
        if until < known:
            return
        more = max(known, until + 1 - known, BLOCK)
        ends = np.concatenate([self.grid.ends, np.zeros(more)])
        saves = np.concatenate([self.grid.saves, np.zeros(more, dtype=np.int64)])
        self.grid = self.grid._replace(ends=ends, saves=saves, last=len(ends) - 1)


class Start:
    """A run before its first step, that begins again and again: that is faster than to make another."""

    def __init__(self, run: Endless):
        self.run, self.place, self.controls = run, Snapshot(run), run.controls

    def again(self) -> Endless:
        """Return the run, as it was."""
        run = self.run
        self.place.put_back()
        run.grid, run.controls = run.make_grid(), self.controls
        run.compiled.functions.forget()
        run.clock["saved"] = 0
        run.save_now()
        return run
