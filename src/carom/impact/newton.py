"""Kinematic restitution: the bodies part with e times the speed of approach.

I. Newton, Philosophiae Naturalis Principia Mathematica (1687), scholium to the laws of motion. The
law of the paper. With friction it can raise the energy (mathematics page, II.10): that is the law.

Every law is four functions. `goal`: the value at which restitution ends. `remaining`: how far it
is. `rate`: how fast it comes, per unit of normal impulse. `straight`: the normal impulse still to
come where du_n/dp = k is constant (infinite if never). Here the measure is the normal velocity.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel


@kernel
def goal(e, v0, p_c, work_c):
    """Return the value at which restitution ends: u_n = e v0."""
    return e * v0


@kernel
def remaining(goal, u_n, p, work):
    """Return how far restitution is from its end, after impulse `p` and work `work` of its own."""
    return goal - u_n


@kernel
def rate(u_n, k):
    """Return the derivative of the measure with the normal impulse."""
    return k


@kernel
def straight(left, u_n, k):
    """Return the normal impulse that covers `left` while du_n/dp = k."""
    return left / k if k > 0.0 else math.inf
