"""Energetic restitution: the work of restitution is e^2 times that lost in compression.

W. J. Stronge, Rigid body collisions with friction, Proc. R. Soc. A 431 (1990) 169-181. Never raises
the energy. The measure is the work of the normal force in restitution (the four functions: see
`newton`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel


@kernel
def goal(e, v0, p_c, work_c):
    """Return the value at which restitution ends: A_r = -e^2 A_c."""
    return max(0.0, -e * e * work_c)


@kernel
def remaining(goal, u_n, p, work):
    """Return how far restitution is from its end, after impulse `p` and work `work` of its own."""
    return goal - work


@kernel
def rate(u_n, k):
    """Return the derivative of the measure with the normal impulse."""
    return u_n


@kernel
def straight(left, u_n, k):
    """Return the normal impulse that covers `left` while du_n/dp = k: u_n d + k d^2/2 = left."""
    root = u_n * u_n + 2.0 * k * left
    if not root > 0.0:
        return math.inf
    below = u_n + math.sqrt(root)
    return 2.0 * left / below if below > 0.0 else math.inf
