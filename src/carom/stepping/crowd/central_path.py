"""The contact problem of a crowd along the central path (`carom.friction.interior`)."""

from __future__ import annotations

import math

from carom._compiled.decorators import by_reference, kernel
from carom.friction import layout as o
from carom.friction.graph import find_order, of_present_size
from carom.friction.interior import damped, enter_path, step_along
from carom.friction.newton import copy
from carom.friction.residual import residual
from carom.friction.thresholds import PATH_END, PATH_PROXIMAL
from carom.stepping.crowd.sweeps import bound_torques

OWN_WORK = 6  # products with blocks of a step for each contact, besides those of its factor
# products for each contact: in all; and of steps that together do not halve the residual
MOST_WORK, IDLE_WORK = 800, 160


@kernel
def follow_path(system, crowd, k, n, enough):
    """Follow the path while it leads on; write the best impulses, return their residual, and the products.

    It begins near the present impulses, with products of velocities and impulses that belong to their residual.
    """
    work, p, best = crowd.problem, crowd.problem.vector[o.ITERATE], crowd.problem.vector[o.BEST]
    least, goal, _ = residual(work, k)
    copy(k, p, best)
    if not find_order(n, k, crowd.graph, crowd.problem):
        return least, 0
    ordered, price = (
        by_reference(of_present_size(n, crowd.graph, crowd.problem)),
        OWN_WORK + crowd.graph.count[2] // k,
    )
    eps, reached, idle, spent, gap = PATH_PROXIMAL, math.inf, 0, 0, 1.0
    bound_torques(system, crowd, k)
    enter_path(ordered, k, min(1.0, least * least))
    while spent < MOST_WORK and idle < IDLE_WORK and gap > PATH_END:
        bound_torques(system, crowd, k)
        gap, t = step_along(ordered, k, eps)
        eps, spent = damped(eps, t), spent + price
        r, goal, _ = residual(work, k)
        if r < least:
            least = r
            copy(k, p, best)
        if least <= max(enough, goal) or not r < math.inf:
            break
        idle = 0 if r < 0.5 * reached else idle + price
        reached = r if idle == 0 else reached
    copy(k, best, p)
    return least, spent * k
