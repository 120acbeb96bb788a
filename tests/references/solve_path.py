"""The contact problem of a large island along the central path alone: `follow_island`."""

from __future__ import annotations

import math

from carom._compiled.decorators import entry
from carom.friction import layout as o
from carom.friction.interior import damped, enter_path, step_along
from carom.friction.newton import copy
from carom.friction.residual import residual
from carom.friction.thresholds import PATH_END, PATH_PROXIMAL
from references.solve_island import _load, measure_island


@entry
def follow_island(k, island, mu, kind, heading, p, workspace, most):
    """Follow the path for at most `most` steps; return the residual of the best impulses, and the steps.

    Arguments are those of `references.solve_island.solve_island`.
    """
    gamma = _load(workspace, k, island, mu, kind, heading, p)
    iterate, best = workspace.vector[o.ITERATE], workspace.vector[o.BEST]
    least, goal, _ = residual(workspace, k)
    copy(k, iterate, best)
    enter_path(workspace, k, min(1.0, least * least))
    eps, gap, steps = PATH_PROXIMAL, 1.0, 0
    while steps < most and gap > PATH_END:
        gap, t = step_along(workspace, k, eps)
        eps, steps = damped(eps, t), steps + 1
        r, goal, _ = residual(workspace, k)
        if r < least:
            least = r
            copy(k, iterate, best)
        if least <= goal or not r < math.inf:
            break
    for i in range(3 * k):
        p[i] = gamma * workspace.contact[i // 3].scale * best[i]
    worst, _, _, _, _ = measure_island(k, island, mu, kind, heading, p)
    return worst, steps
