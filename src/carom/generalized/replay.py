"""Replay in coordinates: steps again between two saved states (as `carom.results.replay` for bodies)."""

from __future__ import annotations

import numpy as np

from carom.generalized.run import GeneralizedRun
from carom.results.replay import FACTOR, RTOL, Replays
from carom.status import Status
from carom.stepping.grid import part_of_grid


class Replay(Replays):
    """Runs of the system of a solution that start at its saved states."""

    def __init__(self, solution):
        self.solution, self.how = solution, solution._run.how
        self.grid, plan = solution._run.plan.grid, solution._run.plan
        self.allowed = FACTOR * (plan.atol + plan.rtol if plan.order > 0 else 2.0 * RTOL)
        self.arrives: dict[int, bool] = {}

    def go(self, i: int, until: float) -> bool:
        """Continue from saved state i to a time; return whether it was reached."""
        begin = float(self.solution.t[i])
        run = GeneralizedRun(self.solution.system, self.how, (begin, self.saved(i)))
        run.plan = run.plan._replace(grid=part_of_grid(self.grid, begin, float(until)))
        self.state = run.x
        return run.go_on(run.steps) is Status.SUCCESS

    def misses(self, i: int, there: np.ndarray) -> float:
        """Return the distance of two states in interval i, velocities times its length, by the allowed one."""
        n, step = len(there) // 2, self.solution.t[i + 1] - self.solution.t[i]
        off = np.abs(self.state - there)
        return float(np.max(off[:n] + step * off[n:])) / self.allowed

    def saved(self, i: int) -> np.ndarray:
        """Return saved state i."""
        return np.concatenate([self.solution.q[i], self.solution.v[i]])

    def cubic(self, i: int, t: float) -> np.ndarray:
        """Return the state of the cubic at a time."""
        return np.concatenate(self.solution._cubic(np.array([t]), "right")[:2], axis=1)[0]
