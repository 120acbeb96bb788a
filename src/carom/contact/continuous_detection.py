"""Verdicts on a trial step of a contact, and the bounds of a gap that decide them. No impact is missed.

The gap z of a point and its rate are known at both ends, and |d2z/dt2| <= a in between. Then

    z(t) >= z0 + z0' t - a t^2/2,      z(t) >= z1 - z1' s - a s^2/2,   s = h - t,

and the path is clear if the times for which these bounds are positive, (z0' + sqrt(z0'^2 + 2 a z0))/a and the
same from the end, add up to at least h. If not, the caller halves the step. For a body in persistent contact, z
is assumed to be the cubic with the gaps and rates at both ends. It is never below the least of its control
points (Bezier): z0, z0 + h z0'/3, z1 - h z1'/3, z1.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel

#: verdicts on a step: no touch; a point is inside at the end; undecided because the step is too long; a rim in
#: persistent contact on one side passes the flat position
CLEAR, BELOW, UNSURE, FLAT_RIM = range(4)

NEWTON_STEPS = 6  # steps to the root of a cubic from a near start


@inlined
def reach(z, rate, a):
    """Return the time during which z + rate t - a t^2/2 is positive."""
    z = max(z, 0.0)
    if a <= 0.0:
        return math.inf if rate >= 0.0 else -z / rate
    return (rate + math.sqrt(rate * rate + 2.0 * a * z)) / a


@inlined
def cubic_clears(z0, rate0, z1, rate1, h, tiny):
    """Return whether the cubic with these ends and rates stays above -tiny: its control points do.

    What is deeper at the start, and not deeper later, has touched before: it comes out.
    """
    return min(z0 + h * rate0 / 3.0, min(z1, z1 - h * rate1 / 3.0)) >= min(-tiny, z0)


@kernel
def safe_time(z0, rate0, z1, rate1, h, tiny):
    """Return a time at which the cubic has left the surface and has not yet come back; 0 if it has not."""
    s = 0.5
    for _ in range(40):
        a, b = 1.0 - s, s
        z = a * a * (1.0 + 2.0 * s) * z0 + b * b * (3.0 - 2.0 * s) * z1
        z += h * (s * a * a * rate0 - b * b * a * rate1)
        if z > tiny:
            return s * h
        s *= 0.5
    return 0.0


@kernel
def time_of_hop(z0, rate0, z1, rate1, h, tiny):
    """Return a time at which a point that touched is off the surface, if it is inside later; else 0.

    It has been thrown up, and falls back within the step: an impact, however little it is inside. If only what
    is deeper than a body may be pushed were one, it would come with the speed of a fall that deep, and throw
    the next point up by as much, without end.
    """
    return safe_time(z0, rate0, z1, rate1, h, tiny) if rate0 > 0.0 else 0.0


@inlined
def arrives(z0, rate0, z1, rate1, tiny, still):
    """Return whether a point that is off the surface, or leaves it, touches it at the end, and approaches.

    In the next step it would be one that touches and is pushed in, and a hop may be lower than `tiny`: it is
    struck before that step.
    """
    return abs(z1) <= tiny and rate1 < -still and (z0 > tiny or rate0 > still)


@kernel
def cubic_root(a, f, r, b, f_last, r_last):
    """Return a root of the cubic with values f and rates r at a and b, by Newton's method from b."""
    h = b - a
    if r == 0.0 or h == 0.0:  # no earlier value
        return math.inf
    slope = (f_last - f) / h
    c = (3.0 * slope - 2.0 * r - r_last) / h
    d = (r + r_last - 2.0 * slope) / (h * h)
    x = h
    for _ in range(NEWTON_STEPS):
        value, rate = f + x * (r + x * (c + x * d)), r + x * (2.0 * c + x * 3.0 * d)
        if not rate < 0.0:
            return math.inf
        x -= value / rate
    return a + x
