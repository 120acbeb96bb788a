"""How well a set of impulses solves the contact problem, whoever found it."""

from __future__ import annotations

import math

from carom.coulomb.layout import CONE, SLIDING
from carom.jit import entry, kernel

RELATIVE, ROUND_OFF = 1e-10, 50.0 * 2.220446049250313e-16


@kernel
def velocity_row(k, W, c, p, i):
    """Return (W p + c)_i and (|W| |p|)_i."""
    row, s, size = W[i], c[i], 0.0
    for j in range(3 * k):
        s += row[j] * p[j]
        size += abs(row[j] * p[j])
    return s, size


@kernel
def cone_projection(mu, x0, x1, x2):
    """Return the nearest point of the cone |x_t| <= mu x_n."""
    size = math.sqrt(x1 * x1 + x2 * x2)
    if size <= mu * x0:
        return x0, x1, x2
    if mu * size <= -x0:
        return 0.0, 0.0, 0.0
    n = (x0 + mu * size) / (1.0 + mu * mu)
    r = mu * n / size
    return n, r * x1, r * x2


@kernel
def natural_residual(kind, mu, h1, h2, rho, p0, p1, p2, w0, w1, w2):
    """Return |p - P_K(p - rho (w + mu |w_t| e_n))| / rho of one contact [m/s]."""
    if kind == SLIDING:
        n = max(0.0, p0 - rho * w0)
        d0, d1, d2 = p0 - n, p1 + mu * p0 * h1, p2 + mu * p0 * h2
    elif kind == CONE:
        t = math.sqrt(w1 * w1 + w2 * w2)
        n, q1, q2 = cone_projection(mu, p0 - rho * (w0 + mu * t), p1 - rho * w1, p2 - rho * w2)
        d0, d1, d2 = p0 - n, p1 - q1, p2 - q2
    else:
        n = max(0.0, p0 - rho * w0)
        d0, d1, d2 = p0 - n, rho * w1, rho * w2
    return math.sqrt(d0 * d0 + d1 * d1 + d2 * d2) / rho


@entry
def measure(k, W, c, mu, kind, heading, p):
    """Return (residual, tolerance, penetration, cone violation, complementarity), greatest of k contacts.

    Residual: the natural map in units of velocity, rho_i = 3 / trace W_ii (mathematics page, VI.2).
    Tolerance: what it must not exceed. Penetration: greatest -w_n [m/s]. Cone violation: greatest
    |p_t| - mu p_n or -p_n [N s]. Complementarity: greatest |p_n w_n| [J].
    """
    worst, largest, size = 0.0, 0.0, 0.0
    penetration, violation, complementarity = 0.0, 0.0, 0.0
    for i in range(k):
        n = 3 * i
        w0, s0 = velocity_row(k, W, c, p, n)
        w1, s1 = velocity_row(k, W, c, p, n + 1)
        w2, s2 = velocity_row(k, W, c, p, n + 2)
        p0, p1, p2 = p[n], p[n + 1], p[n + 2]
        trace = W[n, n] + W[n + 1, n + 1] + W[n + 2, n + 2]
        rho = 3.0 / trace if trace > 0.0 else 1.0
        r = natural_residual(
            kind[i], mu[i], heading[i, 0], heading[i, 1], rho, p0, p1, p2, w0, w1, w2
        )
        if not r <= worst and worst == worst:  # NaN enters, and stays
            worst = r
        largest = max(largest, abs(c[n]), abs(c[n + 1]), abs(c[n + 2]))
        size = max(size, s0, s1, s2)
        penetration = max(penetration, -w0)
        violation = max(violation, -p0)
        if kind[i] == CONE:
            violation = max(violation, math.sqrt(p1 * p1 + p2 * p2) - mu[i] * p0)
        complementarity = max(complementarity, abs(p0 * w0))
    tolerance = RELATIVE * largest + ROUND_OFF * size
    return worst, tolerance, penetration, violation, complementarity
