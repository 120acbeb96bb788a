"""Kinetic restitution: the normal impulse of restitution is e times that of compression.

S. D. Poisson, Traite de mecanique (1833), and E. J. Routh, Dynamics of a System of Rigid Bodies
(1905), who carries it through slip and stick. The measure is the normal impulse of restitution
(the four functions: see `newton`).
"""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def goal(e, v0, p_c, work_c):
    """Return the value at which restitution ends: p_r = e p_c."""
    return e * p_c


@kernel
def remaining(goal, u_n, p, work):
    """Return how far restitution is from its end, after impulse `p` and work `work` of its own."""
    return goal - p


@kernel
def rate(u_n, k):
    """Return the derivative of the measure with the normal impulse."""
    return 1.0


@kernel
def straight(left, u_n, k):
    """Return the normal impulse that covers `left` while du_n/dp = k."""
    return left
