"""The residual of the contact problem for given impulses (mathematics page, §3.2).

The residual of a contact, in units of velocity, is |p - P_K(p - rho (w + s e_n))| / rho, rho = 3 / trace W_ii,
with s = mu |w_t| (the natural map of de Saxce's form). The tolerance is ``RESIDUAL`` times the greatest
velocity without impulses, plus ``SUM_ERROR`` times the greatest (|W| |p|)_i.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.friction import layout as o
from carom.friction.cone import nearest, shift
from carom.friction.layout import CONE, SLIDING
from carom.friction.newton import velocity
from carom.friction.operators import magnitude
from carom.friction.thresholds import GOAL_RESIDUAL, RESIDUAL
from carom.geometry.thresholds import SUM_ERROR

#: greatest values at the start: residual, |c_i|, (|W| |p|)_i, penetration, violation, complementarity
NOTHING = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@entry
def measure(k, problem, p):
    """Return (residual, tolerance, penetration, cone violation, complementarity), the greatest of k contacts.

    Penetration is -w_n [m/s]. Cone violation is |p_t| - mu p_n, or |p_t + mu p_n heading|, or -p_n [N s].
    Complementarity is |p_n w_n| [J].
    """
    W, c, greatest = problem.W, problem.c, NOTHING
    for i in range(k):
        n = 3 * i
        w0, s0 = _row(k, W, c, p, n)
        w1, s1 = _row(k, W, c, p, n + 1)
        w2, s2 = _row(k, W, c, p, n + 2)
        trace = W[n, n] + W[n + 1, n + 1] + W[n + 2, n + 2]
        scale = trace, max(abs(c[n]), abs(c[n + 1]), abs(c[n + 2])), max(s0, s1, s2)
        cone = problem.kind[i], problem.mu[i], problem.heading[i, 0], problem.heading[i, 1]
        greatest = with_contact(greatest, cone, scale, (p[n], p[n + 1], p[n + 2]), (w0, w1, w2))
    return summary(greatest)


@kernel
def _row(k, W, c, p, i):
    """Return (W p + c)_i and (|W| |p|)_i."""
    row, s, size = W[i], c[i], 0.0
    for j in range(3 * k):
        s += row[j] * p[j]
        size += abs(row[j] * p[j])
    return s, size


@kernel
def with_contact(greatest, cone, scale, p, w):
    """Return the greatest values with one more contact, which has the impulse p and the velocity w.

    `cone` is its kind, mu and heading; `scale` the trace of W_ii, and the greatest |c_i| and (|W| |p|)_i.
    """
    worst, velocity, size, penetration, violation, complementarity = greatest
    kind, mu, h1, h2 = cone
    (p0, p1, p2), (w0, w1, w2) = p, w
    rho = 3.0 / scale[0] if scale[0] > 0.0 else 1.0
    x0 = p0 - rho * (w0 + shift(cone, w1, w2))
    y0, y1, y2 = nearest(cone, x0, p1 - rho * w1, p2 - rho * w2)
    d0, d1, d2 = p0 - y0, p1 - y1, p2 - y2
    r = math.sqrt(d0 * d0 + d1 * d1 + d2 * d2) / rho
    if not r <= worst and worst == worst:  # NaN replaces any number, and stays
        worst = r
    outside = -p0
    if kind == CONE:
        outside = max(outside, math.sqrt(p1 * p1 + p2 * p2) - mu * p0)
    elif kind == SLIDING:
        x, y = p1 + mu * p0 * h1, p2 + mu * p0 * h2
        outside = max(outside, math.sqrt(x * x + y * y))
    return (
        worst, max(velocity, scale[1]), max(size, scale[2]), max(penetration, -w0),
        max(violation, outside), max(complementarity, abs(p0 * w0)),
    )  # fmt: skip


@kernel
def summary(greatest):
    """Return the result of `measure` for the greatest values of all contacts."""
    worst, velocity, size, penetration, violation, complementarity = greatest
    return worst, RESIDUAL * velocity + SUM_ERROR * size, penetration, violation, complementarity


@kernel
def residual(work, k):
    """Return (residual, goal, tolerance) of p in velocity; the goal is what round-off allows."""
    velocity(work, k)
    p, w, c = work.vector[o.ITERATE], work.vector[o.RESULTING], work.vector[o.BIAS]
    worst, largest = 0.0, 0.0
    for i in range(k):
        t, n = work.contact[i], 3 * i
        cone = t.kind, t.mu, t.h1, t.h2
        x0 = p[n] - w[n] - shift(cone, w[n + 1], w[n + 2])
        y0, y1, y2 = nearest(cone, x0, p[n + 1] - w[n + 1], p[n + 2] - w[n + 2])
        d0, d1, d2 = p[n] - y0, p[n + 1] - y1, p[n + 2] - y2
        r = math.sqrt(d0 * d0 + d1 * d1 + d2 * d2) / t.scale
        if not r <= worst and worst == worst:  # NaN replaces any number, and stays
            worst = r
        largest = max(largest, max(abs(c[n]), abs(c[n + 1]), abs(c[n + 2])) / t.scale)
    size = magnitude(work, k)
    goal = max(GOAL_RESIDUAL * largest + 0.08 * SUM_ERROR * size, work.mismatch[o.ENOUGH] * largest)
    return worst, goal, RESIDUAL * largest + SUM_ERROR * size
