"""Replay in coordinates: steps again between two saved states (as `carom.results.replay` for bodies)."""

from __future__ import annotations

import numpy as np

from carom.generalized.run import GeneralizedRun
from carom.results.dense_output import NEAR
from carom.results.replay import BETTER, FACTOR, RTOL
from carom.status import Status
from carom.stepping.grid import part_of_grid


class Replay:
    """Runs of the system of a solution that start at its saved states."""

    def __init__(self, solution):
        self.solution, self.how = solution, solution._run.how
        self.grid, plan = solution._run.plan.grid, solution._run.plan
        self.allowed = FACTOR * (plan.atol + plan.rtol if plan.order > 0 else 2.0 * RTOL)
        self.arrives: dict[int, bool] = {}

    def improve(self, times: np.ndarray, q: np.ndarray, v: np.ndarray) -> None:
        """Replace the states of a cubic at times (K,) where a replay is better."""
        nodes = self.solution._nodes[0]
        n, last = q.shape[1], len(self.solution.t) - 2
        for k, time in enumerate(times):
            j = int(np.searchsorted(nodes, time))
            around = nodes[max(j - 1, 0)], nodes[min(j, len(nodes) - 1)]
            margin = NEAR * (around[1] - around[0])
            if min(time - around[0], around[1] - time) <= margin:
                continue
            i = min(int(np.searchsorted(self.solution.t, time, side="right")) - 1, last)
            state = self.go(i, float(time)) if self.is_good(i) else None
            if state is not None:
                q[k], v[k] = state[:n], state[n:]

    def is_good(self, i: int) -> bool:
        """Return whether the replay from saved state i ends at the next one, or is better than the cubic."""
        if i not in self.arrives:
            self.arrives[i] = self.arrives_from(i)
        return self.arrives[i]

    def arrives_from(self, i: int) -> bool:
        """Compute the result of `is_good`."""
        s = self.solution
        miss = self.distance(i, self.go(i, float(s.t[i + 1])), (s.q[i + 1], s.v[i + 1]))
        if miss <= self.allowed:
            return True
        middle = 0.5 * float(s.t[i] + s.t[i + 1])
        q, v = s._cubic(np.array([middle]), "right")
        return miss <= BETTER * self.distance(i, self.go(i, middle), (q[0], v[0])) < np.inf

    def distance(self, i: int, state: np.ndarray | None, there: tuple) -> float:
        """Return the distance of two states in interval i, with velocities times its length."""
        if state is None:
            return np.inf
        n, step = len(there[0]), self.solution.t[i + 1] - self.solution.t[i]
        return float(np.max(np.abs(state[:n] - there[0]) + step * np.abs(state[n:] - there[1])))

    def go(self, i: int, until: float) -> np.ndarray | None:
        """Return the state at a time after saved state i; None if it is not reached."""
        s = self.solution
        begin = float(s.t[i])
        run = GeneralizedRun(s.system, self.how, (begin, np.concatenate([s.q[i], s.v[i]])))
        grid = part_of_grid(self.grid, begin, until)
        run.plan = run.plan._replace(grid=grid)
        return run.x if run.go_on(run.steps) is Status.SUCCESS else None
