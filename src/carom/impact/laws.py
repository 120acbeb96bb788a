"""The restitution laws by number. Compression is Newton's law with the goal u_n = 0."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.impact import newton, poisson, stronge

NEWTON = 0
POISSON = 1
STRONGE = 2

NUMBERS = {"newton": NEWTON, "poisson": POISSON, "stronge": STRONGE}


@kernel
def goal(law, e, v0, p_c, work_c):
    """Return the value of the law's measure at which restitution ends."""
    if law == NEWTON:
        return newton.goal(e, v0, p_c, work_c)
    if law == POISSON:
        return poisson.goal(e, v0, p_c, work_c)
    return stronge.goal(e, v0, p_c, work_c)


@kernel
def remaining(law, goal, u_n, p, work):
    """Return how far the phase is from its goal, `p` and `work` counted from its start."""
    if law == NEWTON:
        return newton.remaining(goal, u_n, p, work)
    if law == POISSON:
        return poisson.remaining(goal, u_n, p, work)
    return stronge.remaining(goal, u_n, p, work)


@kernel
def rate(law, u_n, k):
    """Return the derivative of the law's measure with the normal impulse, du_n/dp = k."""
    if law == NEWTON:
        return newton.rate(u_n, k)
    if law == POISSON:
        return poisson.rate(u_n, k)
    return stronge.rate(u_n, k)


@kernel
def straight(law, left, u_n, k):
    """Return the normal impulse that covers `left` while du_n/dp = k; infinite if never."""
    if law == NEWTON:
        return newton.straight(left, u_n, k)
    if law == POISSON:
        return poisson.straight(left, u_n, k)
    return stronge.straight(left, u_n, k)
