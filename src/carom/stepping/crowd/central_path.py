"""The contact problem of a crowd along the central path (`carom.friction.interior`)."""

from __future__ import annotations

from carom._compiled.decorators import by_reference, kernel
from carom.friction import layout as o
from carom.friction.interior import damped, enter_path, step_along
from carom.friction.newton import copy
from carom.friction.residual import residual
from carom.friction.thresholds import PATH_END, PATH_PROXIMAL
from carom.stepping.crowd.graph import find_order
from carom.stepping.crowd.present import of_present_size
from carom.stepping.crowd.sweeps import bound_torques

# products with blocks for each contact: in all, and in steps that together do not halve the residual
MOST_WORK, IDLE_WORK = 800, 160


@kernel
def follow_path(system, crowd, k, n, enough):
    """Follow the path while it leads on; return the residual of the best impulses, and the products with blocks.

    It begins near the present impulses, with products that belong to their residual. A step takes the products of
    its factor, and about six for each contact.
    """
    work, p, best = crowd.problem, crowd.problem.vector[o.ITERATE], crowd.problem.vector[o.BEST]
    least, goal, _ = residual(work, k)
    copy(k, p, best)
    if not find_order(n, k, crowd):
        return least, 0
    ordered = by_reference(of_present_size(crowd, n))
    bound_torques(system, crowd, k)
    enter_path(ordered, k, min(1.0, least * least))
    price = 6 + crowd.graph.count[2] // k
    eps, reached, idle, spent, gap = PATH_PROXIMAL, least, 0, 0, 1.0
    while not least <= max(enough, goal) and spent < MOST_WORK and idle < IDLE_WORK and gap > PATH_END:
        bound_torques(system, crowd, k)
        gap, t = step_along(ordered, k, eps)
        eps, spent = damped(eps, t), spent + price
        r, goal, _ = residual(work, k)
        if r < least:
            least = r
            copy(k, p, best)
        idle = 0 if r < 0.5 * reached or spent == price else idle + price
        reached = r if idle == 0 else reached
        if not r < 1e300:
            break
    copy(k, best, p)
    return least, spent * k
