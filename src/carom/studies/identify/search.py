"""Search for the minimum of a rough objective: Nelder and Mead's simplex, started again."""

from __future__ import annotations

import numpy as np

from carom.studies.identify.evaluate import Evaluator


class BudgetSpent(Exception):
    """The allowed number of evaluations is used up."""


def search(
    evaluate: Evaluator, method: str, restarts: int, tolerance: float, most: int
) -> tuple[bool, str]:
    """Search from the best evaluation so far, or the start; return whether it converged, and a message.

    Unknowns are (parameter - start) / step. A restart uses a new simplex of half the size around the best point
    so far, mirrored, because a simplex may become flat away from a minimum.
    """
    from scipy.optimize import minimize

    space = evaluate.space
    bounds = np.stack([space.lower - space.start, space.upper - space.start], axis=1)
    bounds = bounds / space.step[:, None]

    def value(z: np.ndarray) -> float:
        if len(evaluate.points) >= most:
            raise BudgetSpent
        return evaluate(space.start + space.step * z)

    try:
        evaluate(space.start)
        best = evaluate.mean(evaluate.best)
        for k in range(restarts + 1):
            z = (evaluate.points[evaluate.best] - space.start) / space.step
            options: dict = {}
            if method == "Nelder-Mead":
                options = {"xatol": tolerance, "fatol": tolerance * best, "maxiter": most}
                options["initial_simplex"] = simplex(z, bounds, (-0.5) ** k)
            minimize(value, z, method=method, bounds=bounds, tol=tolerance, options=options)
            found = evaluate.mean(evaluate.best)
            if k > 0 and best - found <= tolerance * best:
                break
            best = found
    except BudgetSpent:
        return False, f"stopped after {most} evaluations (max_evaluations)"
    return True, "the search converged"


def simplex(z: np.ndarray, bounds: np.ndarray, size: float) -> np.ndarray:
    """Return a simplex (p + 1, p) at z with edges of `size`; an edge that leaves the bounds is reversed."""
    corners = np.repeat(z[None], z.size + 1, axis=0)
    for i in range(z.size):
        there = z[i] + size
        inside = bounds[i, 0] <= there <= bounds[i, 1]
        other = np.clip(z[i] - size, *bounds[i])
        corners[i + 1, i] = there if inside else other
    return corners
