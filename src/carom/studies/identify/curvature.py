"""Curvature of the sum of squares around the best point, and the parameters that the data do not determine.

Residuals r are poses, simulated less recorded, in units of their noise. With J = dr/dp the covariance of the
parameters is (J^T J)^-1, and eigenvalues of J^T J that are too small belong to changes that the data do not
show (Gauss and Newton; Seber and Wild 1989, Nonlinear Regression, section 2.1 and chapter 3).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.studies.identify.errors import offsets
from carom.studies.identify.evaluate import Evaluator

#: least noise: of positions relative to the largest displacement, of rotations [rad]; and least difference of a
#: parameter, relative to its step in the search
EXACT = 1e-6
STEP_HALVINGS = 12  # of an interval in which a value that is not excluded becomes one that is
EXCLUDED = 4.0  # change of the sum of squares by a value that is two standard errors off
CURVED = 16.0  # change that the curvature predicts where a change below `EXCLUDED` contradicts it
FAR = 10.0  # number of scales to which parameters without a bound are varied
PART = 0.1  # least component of a parameter in a combination


class Curvature(NamedTuple):
    """Standard errors of p parameters, and what the data say of those that they do not determine.

    The scale of a parameter is its value, or its step in the search if that is greater. A parameter is not
    determined if its standard error is greater than its scale, or if its greatest or least value is not
    excluded (the sum of squares changes by less than 4) although by the curvature it would be (by 16).
    """

    centre: np.ndarray  #: (p,) minimum of the sum of squares over determined directions
    error: np.ndarray  #: (p,) standard errors; infinite for a parameter that is not determined
    allowed: np.ndarray  #: (p, 2) intervals of the values that are not excluded (95 %)
    combinations: np.ndarray  #: (k, p) changes of several parameters that the data do not show


class Residuals:
    """The residuals (m,) as a function of the parameters."""

    def __init__(self, evaluate: Evaluator):
        self.evaluate, self.best = evaluate, evaluate.points[evaluate.best]
        here, p = self._poses(self.best), self.best.size
        # noise of positions and of rotations; p numbers of all were fitted
        own = p / np.count_nonzero([len(r) for r in here])
        freedom = np.sqrt(max(here[0].size - own, 1.0))
        moved = [np.max(np.ptp(r.position, axis=0)) for r in evaluate.recordings]
        least = EXACT * max(*moved, np.finfo(float).tiny), EXACT
        self.noise = [max(np.linalg.norm(r) / freedom, low) for r, low in zip(here, least)]
        self.here = self(self.best)

    def _poses(self, point: np.ndarray) -> list[np.ndarray]:
        runs, recordings = self.evaluate.runs(point), self.evaluate.recordings
        pairs = [offsets(*pair) for pair in zip(runs, recordings)]
        return [np.concatenate([part.ravel() for part in parts]) for parts in zip(*pairs)]

    def __call__(self, point: np.ndarray) -> np.ndarray:
        """Return the residuals at a point."""
        return np.concatenate([r / noise for r, noise in zip(self._poses(point), self.noise)])

    def moved(self, i: int, value: float) -> np.ndarray:
        """Return the residuals with another value of parameter i; infinite if it gives no scene."""
        point = self.best.copy()
        point[i] = value
        try:
            return self(point)
        except ValueError:
            return np.full_like(self.here, np.inf if value > self.best[i] else -np.inf)

    def slope(self, i: int, step: float, lower: float, upper: float) -> np.ndarray:
        """Return the derivative by parameter i, from a difference of at most four times the noise."""
        least = EXACT * step
        while True:
            low, high = np.clip([self.best[i] - step, self.best[i] + step], lower, upper)
            change = self.moved(i, high) - self.moved(i, low)
            size = float(np.linalg.norm(change))
            if size <= 4.0 or step <= least:
                return change / (high - low)
            step *= max(0.01, 2.0 / size)

    def exclude(self, i: int, value: float) -> bool:
        """Return whether a value of parameter i, with the others unchanged, is excluded or gives no scene."""
        there = self.moved(i, value)
        return bool(there @ there - self.here @ self.here >= EXCLUDED)

    def last_allowed(self, i: int, end: float) -> float:
        """Return the last value of parameter i from the best one to `end` that is not excluded."""
        near, far = self.best[i], end
        if not self.exclude(i, end):
            return end
        for _ in range(STEP_HALVINGS):
            middle = 0.5 * (near + far)
            near, far = (near, middle) if self.exclude(i, middle) else (middle, far)
        return near


def curvature(evaluate: Evaluator) -> Curvature:
    """Return the curvature at the best point, from evaluations that are not recorded."""
    space, residuals = evaluate.space, Residuals(evaluate)
    best, here = residuals.best, residuals.here
    p, scale = best.size, np.maximum(np.abs(best), space.step)
    bounds = np.stack([space.lower, space.upper], axis=1)
    ends = np.where(np.isfinite(bounds), bounds, best[:, None] + np.outer(FAR * scale, [-1.0, 1.0]))
    slopes = [residuals.slope(i, space.step[i], *bounds[i]) for i in range(p)]
    J = scale * np.stack(slopes, axis=1)
    F = J.T @ J
    # parameters that the data do not determine even if all others are known. Where an impact sticks, the sum is
    # flat for all greater friction, but by noise the best value may be just below, where it is curved
    alone = np.diag(F) < 1.0
    predicted = np.diag(F)[:, None] * ((ends - best[:, None]) / scale[:, None]) ** 2
    for i, k in np.argwhere((predicted >= CURVED) & ~alone[:, None]).tolist():
        alone[i] |= not residuals.exclude(i, float(ends[i, k]))
    rest = np.flatnonzero(~alone)
    w, V = np.linalg.eigh(F[np.ix_(rest, rest)])
    w = np.maximum(w, 1e-15 * np.max(w, initial=1.0))  # round-off
    errors = np.sqrt(np.sum(V**2 / w, axis=1))
    error, centre = np.full(p, np.inf), best.copy()
    error[rest] = np.where(errors <= 1.0, errors * scale[rest], np.inf)
    known = w >= 1.0
    change = V[:, known] @ (V.T @ J[:, rest].T @ here / w)[known]
    centre[rest] -= scale[rest] * change
    centre = space.clip(centre)
    allowed = np.clip(centre[:, None] + np.outer(1.96 * error, [-1.0, 1.0]), *bounds.T[:, :, None])
    for i in np.flatnonzero(alone).tolist():
        last = [residuals.last_allowed(i, end) for end in ends[i]]
        allowed[i] = np.where(last == ends[i], bounds[i], last)
    hidden = np.any(w < V**2, axis=0)
    combinations = np.zeros((np.count_nonzero(hidden), p))
    combinations[:, rest] = (np.where(np.abs(V) > PART, V, 0.0) * scale[rest, None]).T[hidden]
    return Curvature(centre, error, allowed, combinations)
