"""Replay: the motion between two saved states, computed again from the first one by the method of the run.

States between two saved states are then as accurate as the saved ones, however fast a body rotates. A replay
starts from the saved position, attitude and velocities. Other data of the run, such as first guesses of forces,
are not saved, so each interval is checked first: its replay is used if it ends at the next saved state, or
misses it by far less than the replay and a cubic through both states differ.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from carom.dynamics.reactions import saved_turns
from carom.model import records as r
from carom.model.kept import Snapshot
from carom.results.dense_output import curves
from carom.status import Status
from carom.stepping.grid import part_of_grid

if TYPE_CHECKING:
    from carom.results.solution import Solution

FACTOR = 10.0  # allowed miss of the next saved state, relative to the tolerances of the run
RTOL = 1e-8  # tolerance for a run with a given step
BETTER = 0.1  # allowed greater miss, relative to the difference from the cubic at the middle


class Replay:
    """A run of the scene of a solution that can start at any saved state, and which intervals it fits."""

    def __init__(self, solution: Solution):
        from carom.run import Run
        from carom.stepping.settings import settings_of

        known = solution._run
        written = r.trimmed(known.records, known.clock)
        self.solution, self.states = solution, written.state
        self.run = Run(solution.scene, settings_of(solution.settings, known.options))
        self.grid = self.run.grid
        relations = self.run.compiled.system.relations
        self.turns = np.zeros((len(written.state), len(relations.coordinates)))
        if self.turns.size:
            saved_turns(self.run.compiled.system, written, self.turns)
        self.first = Snapshot(self.run)
        self.size = self.run.bodies["extent"]
        rtol, atol = self.run.tolerances or (RTOL, RTOL * float(np.min(self.size)))
        self.allowed = FACTOR * (atol + rtol * self.size)
        self.arrives: dict[int, bool] = {}  # by interval: whether its replay is used

    def improve(self, times: np.ndarray, cubic: np.ndarray, x, Q, v, w) -> None:
        """Replace the states (K, N) of a cubic at times (K,) by states of the replay."""
        for k in self.better(times, np.any(cubic, axis=1)):
            now, own = self.run.now, cubic[k]
            x[k, own], Q[k, own], v[k, own], w[k, own] = (
                now.x[own],
                now.Q[own],
                now.v[own],
                now.w[own],
            )

    def better(self, times: np.ndarray, among: np.ndarray) -> Iterator[int]:
        """Yield those of some of the times, at which `among` is true, to which a good replay has gone."""
        t = self.solution.t
        for k in np.flatnonzero(among):
            i = min(int(np.searchsorted(t, times[k], side="right")) - 1, len(t) - 2)
            if self.is_good(i) and self.go(i, float(times[k])):
                yield int(k)

    def is_good(self, i: int) -> bool:
        """Return whether the replay from saved state i ends at the next one, or is better than the cubic."""
        if i not in self.arrives:
            self.arrives[i] = self.arrives_from(i)
        return self.arrives[i]

    def arrives_from(self, i: int) -> bool:
        """Compute `is_good`."""
        if not self.go(i, self.solution.t[i + 1]):
            return False
        miss = self.misses(i, self.saved(i + 1))
        if miss <= 1.0:
            return True
        middle = 0.5 * float(sum(self.solution.t[i : i + 2]))
        return self.go(i, middle) and miss <= BETTER * self.misses(i, self.cubic(i, middle))

    def saved(self, i: int) -> np.recarray:
        """Return saved state i."""
        return self.states[i]

    def cubic(self, i: int, t: float) -> np.recarray:
        """Return the state of the cubic at a time in interval i."""
        cubic = self.states[i].copy()
        cubic["x"], cubic["Q"], cubic["v"], cubic["w"], _ = (
            part[0] for part in curves(self.solution, np.array([t]), "right")
        )
        return cubic

    def go(self, i: int, until: float) -> bool:
        """Continue from saved state i to a time; return whether it was reached."""
        run, begin = self.run, self.solution.t[i]
        self.first.put_back()
        run.now[:] = self.states[i]
        run.clock["now"] = begin
        if self.turns.size:
            run.compiled.system.relations.memory.coordinates["reference"] = self.turns[i]
        run.grid = part_of_grid(self.grid, begin, until)
        return run.go_on(run.steps) is Status.SUCCESS

    def misses(self, i: int, there: np.ndarray) -> float:
        """Return the distance of the run from a state within interval i, relative to the allowed one."""
        now, size = self.run.now, self.size[:, None]
        turn = now.Q - there["Q"] * np.sign(np.sum(now.Q * there["Q"], axis=1))[:, None]
        speed = np.abs(now.v - there["v"]) + size * np.abs(now.w - there["w"])
        step = self.solution.t[i + 1] - self.solution.t[i]
        miss = np.abs(now.x - there["x"]).max(axis=1) + 2.0 * self.size * np.abs(turn).max(axis=1)
        return float(np.max((miss + step * speed.max(axis=1)) / self.allowed))


def evaluate(solution: Solution, times: np.ndarray, cubic: np.ndarray, x, Q, v, w) -> None:
    """Replace the states (K, N) of a cubic at times (K,) by those of a replay, where this is possible."""
    missing = getattr(solution._run, "missing", ())  # functions that a file cannot contain
    if len(solution.t) < 2 or missing:
        return
    if not cubic.any() or len(solution.scene.bodies) != solution.position.shape[1]:
        return
    solution._replay.improve(times, cubic, x, Q, v, w)
