"""Replay: the motion between two saved states, stepped again from the first one by the method of the run.

States between two saved states are then as accurate as the saved ones, however fast a body rotates. A replay
starts from the saved position, attitude and velocities. Other data of the run (first guesses of forces, whole
turns of joints) are not saved, so each interval is checked first: its replay is used if it ends at the next
saved state.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.model.kept import Kept
from carom.status import Status
from carom.stepping.grid import Grid, ends_between

if TYPE_CHECKING:
    from carom.results.solution import Solution

FACTOR = 10.0  # a replay may miss the next saved state by so many times the tolerances of the run
RTOL = 1e-8  # tolerance where the run has given steps


class Replay:
    """A run of the scene of a solution that can start at any saved state."""

    def __init__(self, solution: Solution):
        from carom.run import Run
        from carom.stepping.settings import settings_of

        known = solution._run
        self.solution, self.states = solution, known.records.state
        self.run = Run(solution.scene, settings_of(solution.settings, known.options))
        self.grid = self.run.grid
        self.kept = Kept(self.run.parts)
        self.size = self.run.bodies["extent"]
        rtol, atol = self.run.tolerances or (RTOL, RTOL * float(np.min(self.size)))
        self.allowed = FACTOR * (atol + rtol * self.size)
        self.arrives = {}

    def improve(self, times: np.ndarray, cubic: np.ndarray, x, Q, v, w) -> None:
        """Replace the states (K, N) of a cubic at times (K,) by states of the replay."""
        t = self.solution.t
        for k in np.flatnonzero(cubic.any(axis=1)):
            i = min(int(np.searchsorted(t, times[k], side="right")) - 1, len(t) - 2)
            if self.is_good(i) and self.go(i, times[k]):
                now, own = self.run.now, cubic[k]
                x[k, own], Q[k, own], v[k, own], w[k, own] = (
                    now.x[own], now.Q[own], now.v[own], now.w[own],
                )  # fmt: skip

    def is_good(self, i: int) -> bool:
        """Return whether the replay from saved state i ends at the next one, within the tolerances."""
        if i not in self.arrives:
            self.arrives[i] = self.go(i, self.solution.t[i + 1]) and self.misses(i) <= 1.0
        return self.arrives[i]

    def go(self, i: int, until: float) -> bool:
        """Continue from saved state i to a time; return whether it was reached."""
        run, begin = self.run, self.solution.t[i]
        if self.kept.is_of(run.parts):
            self.kept.restore()
        else:  # contacts have come, or room for them
            run.renew()
            self.kept = Kept(run.parts)
        run.now[:] = self.states[i]
        run.clock["now"] = begin
        ends = np.concatenate([[begin], ends_between(self.grid, begin, until), [until]])
        longest = float(np.max(np.diff(ends)))
        run.grid = Grid(longest, len(ends) - 1, 0, ends, np.zeros(len(ends), dtype=np.int64))
        run.note_modes()
        return run.go_on(run.steps) is Status.SUCCESS

    def misses(self, i: int) -> float:
        """Return the distance of the run from saved state i + 1, relative to the allowed one."""
        now, there, size = self.run.now, self.states[i + 1], self.size[:, None]
        turn = now.Q - there["Q"] * np.sign(np.sum(now.Q * there["Q"], axis=1))[:, None]
        speed = np.abs(now.v - there["v"]) + size * np.abs(now.w - there["w"])
        step = self.solution.t[i + 1] - self.solution.t[i]
        miss = np.abs(now.x - there["x"]).max(axis=1) + 2.0 * self.size * np.abs(turn).max(axis=1)
        return float(np.max((miss + step * speed.max(axis=1)) / self.allowed))


def evaluate(solution: Solution, times: np.ndarray, cubic: np.ndarray, x, Q, v, w) -> None:
    """Replace the states (K, N) of a cubic at times (K,) by the motion, where it can be stepped again."""
    if len(solution.t) < 2 or getattr(
        solution._run, "missing", ()
    ):  # functions that a file could not hold
        return
    if not cubic.any() or len(solution.scene.bodies) != solution.position.shape[1]:
        return
    solution._replay.improve(times, cubic, x, Q, v, w)
