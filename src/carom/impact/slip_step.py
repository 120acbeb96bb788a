"""Steps of the slip velocity, and the last step to the end of a phase.

The state is ``(u_1, u_2, u_n, p, P_1, P_2, loss, work)``; the last five are counted from the start of the
phase. The mass is ``(W_nn, W_n1, W_n2, W_11, W_12, W_22)``.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.thresholds import LAST_UNITS
from carom.impact.taylor import integral, series, value
from carom.law import impact_laws


@kernel
def normal_rate(m, mu, s):
    """Return |u_t| and k = du_n/dp = W_nn - mu W_nt.u_t/|u_t| while slipping."""
    r = math.sqrt(s[0] * s[0] + s[1] * s[1])
    return r, m[0] - mu * (m[1] * s[0] + m[2] * s[1]) / r


@kernel
def expand(m, mu, s):
    """Return the Taylor series of slip from the state `s`."""
    return series((m[1], m[2], mu * m[3], mu * m[4], mu * m[5]), s[0], s[1])


@kernel
def moved(m, mu, s, t, h):
    """Return the state at `h` in tau after `s`, from the series `t`."""
    p, p1, p2 = integral(t[2], h), -mu * integral(t[0][:16], h), -mu * integral(t[1][:16], h)
    loss = mu * integral(t[3], h)
    x, y = value(t[0], h), value(t[1], h)
    u_n = s[2] + (m[0] * p + m[1] * p1 + m[2] * p2)
    # The work of the normal force follows from the exact change of energy, dE = P.(u + u')/2.
    energy = 0.5 * (p * (s[2] + u_n) + p1 * (s[0] + x) + p2 * (s[1] + y))
    work = s[7] + (energy + loss)
    return (x, y, u_n, s[3] + p, s[4] + p1, s[5] + p2, s[6] + loss, work)


@kernel
def write_end(contact, phase, start, end, t, h):
    """Return the state at the goal of the phase, from the series `t` between `start` and `end`, `h` later.

    Newton's iteration is kept between the last point before the goal and the first point after it.
    """
    m, mu, law, goal = contact.m, contact.mu, phase.law, phase.goal
    low, high = 0.0, h
    left = impact_laws.remaining(law, goal, start[2], start[3], start[7])
    first = left
    z = h * left / (left - impact_laws.remaining(law, goal, end[2], end[3], end[7]))
    s = end
    for _ in range(60):
        s = moved(m, mu, start, t, z)
        r, k = normal_rate(m, mu, s)
        left = impact_laws.remaining(law, goal, s[2], s[3], s[7])
        slope = r * impact_laws.rate(law, s[2], k)
        if left > 0.0:
            low = z
        else:
            high = z
        new = z + left / slope if slope > 0.0 else math.inf
        if not abs(left) > LAST_UNITS * first or new == z:
            return s
        if not (low < new < high):
            new = 0.5 * (low + high)
            if not (low < new < high):
                return s
        z = new
    return s
