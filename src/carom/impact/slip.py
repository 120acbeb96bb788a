"""Stepping the state of slip, and landing on the end of a phase.

State: ``(u_1, u_2, u_n, p, P_1, P_2, loss, work)``, the last five counted from the start of the
phase. Mass: ``(W_nn, W_n1, W_n2, W_11, W_12, W_22)``.
"""

from __future__ import annotations

import math

from carom.impact import laws
from carom.impact.slip_step import order_eight, order_four
from carom.jit import kernel


@kernel
def normal_rate(m, mu, s):
    """Return |u_t| and k = du_n/dp = W_nn - mu W_nt.u_t/|u_t| while slipping."""
    r = math.sqrt(s[0] * s[0] + s[1] * s[1])
    return r, m[0] - mu * (m[1] * s[0] + m[2] * s[1]) / r


@kernel
def _moved(m, mu, s, step):
    """Return the state after the quadratures of a step."""
    p1, p2, loss = -mu * step[1], -mu * step[2], mu * step[3]
    u_n = s[2] + m[0] * step[0] + m[1] * p1 + m[2] * p2
    x, y = step[4], step[5]
    # The work of the normal force from the exact change of energy, dE = P.(u + u')/2.
    energy = 0.5 * (step[0] * (s[2] + u_n) + p1 * (s[0] + x) + p2 * (s[1] + y))
    work = s[7] + (energy + loss)
    return (x, y, u_n, s[3] + step[0], s[4] + p1, s[5] + p2, s[6] + loss, work)


@kernel
def arc(m, mu, s, h):
    """Return the state after slip over `h` in tau, and the estimated error of u_t."""
    step = order_eight(m[1], m[2], mu * m[3], mu * m[4], mu * m[5], s[0], s[1], h)
    return _moved(m, mu, s, step), step[6]


@kernel
def short_arc(m, mu, s, h):
    """Return the state after slip over a tiny `h` in tau."""
    step = order_four(m[1], m[2], mu * m[3], mu * m[4], mu * m[5], s[0], s[1], h)
    return _moved(m, mu, s, step)


@kernel
def hermite_root(q0, q1, d0, d1):
    """Return where in (0, 1) the cubic with end values q0 > 0 >= q1 and end slopes d0, d1 is zero."""
    low, high, z = 0.0, 1.0, q0 / (q0 - q1)
    c2 = 3.0 * (q1 - q0) - 2.0 * d0 - d1
    c3 = 2.0 * (q0 - q1) + d0 + d1
    for _ in range(50):
        value = q0 + z * (d0 + z * (c2 + z * c3))
        if value > 0.0:
            low = z
        else:
            high = z
        slope = d0 + z * (2.0 * c2 + 3.0 * z * c3)
        new = z - value / slope if slope < 0.0 else 0.5 * (low + high)
        if not (low < new < high):
            new = 0.5 * (low + high)
        if abs(new - z) < 1e-7:
            return new
        z = new
    return z


@kernel
def land(m, mu, law, goal, start, end, h, speed):
    """Return the state where the goal is met, between `start` and `end`, a step of `h` apart.

    The cubic through both ends says where; one step of order 8 goes there; what is left, small, is
    covered by Newton's iteration on the length of a further tiny step. `speed` is the rate of slip
    per tau, by which the steps are small or not.
    """
    r0, k0 = normal_rate(m, mu, start)
    r1, k1 = normal_rate(m, mu, end)
    q0 = laws.remaining(law, goal, start[2], start[3], start[7])
    q1 = laws.remaining(law, goal, end[2], end[3], end[7])
    d0 = -h * r0 * laws.rate(law, start[2], k0)
    d1 = -h * r1 * laws.rate(law, end[2], k1)
    s, _ = arc(m, mu, start, h * hermite_root(q0, q1, d0, d1))
    for _ in range(20):
        r, k = normal_rate(m, mu, s)
        slope = r * laws.rate(law, s[2], k)
        left = laws.remaining(law, goal, s[2], s[3], s[7])
        if not abs(left) > 2e-16 * (q0 - q1) or not slope > 0.0:
            return s
        move = left / slope
        if abs(move) * speed < 2e-3:
            s = short_arc(m, mu, s, move)
            if abs(left) < 1e-8 * (q0 - q1):
                return s  # quadratic: the next correction is below round-off
        else:
            s, _ = arc(m, mu, s, move)
    return s
