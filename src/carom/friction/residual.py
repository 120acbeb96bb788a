"""How well impulses solve the contact problem, whoever found them (mathematics page, VI.2).

Residual of a contact, in units of velocity: |p - P_K(p - rho (w + s e_n))| / rho, rho = 3 / trace W_ii, with
s = mu |w_t| (the natural map of de Saxce's form). It is to be at most ``RELATIVE`` of the
greatest velocity without impulses, plus ``ROUND_OFF`` times the greatest (|W| |p|)_i.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.friction.cone import nearest, shift
from carom.friction.layout import CONE, SLIDING

RELATIVE, ROUND_OFF = 1e-10, 50.0 * 2.220446049250313e-16


@entry
def measure(k, W, c, mu, kind, heading, p):
    """Return (residual, tolerance, penetration, cone violation, complementarity), greatest of k contacts.

    Penetration: -w_n [m/s]. Cone violation: |p_t| - mu p_n, or how far p_t is from -mu p_n heading, or -p_n
    [N s]. Complementarity: |p_n w_n| [J].
    """
    sums = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for i in range(k):
        n = 3 * i
        w0, s0 = _row(k, W, c, p, n)
        w1, s1 = _row(k, W, c, p, n + 1)
        w2, s2 = _row(k, W, c, p, n + 2)
        sums = _with(
            sums, kind[i], mu[i], heading[i, 0], heading[i, 1],
            W[n, n] + W[n + 1, n + 1] + W[n + 2, n + 2], p[n], p[n + 1], p[n + 2], w0, w1, w2,
            max(abs(c[n]), abs(c[n + 1]), abs(c[n + 2])), max(s0, s1, s2),
        )  # fmt: skip
    return _result(sums)


@entry
def measure_island(k, island, mu, kind, heading, p, motion):
    """Return the same for an island; `motion` (2, N, 6) is scratch.

    (|W| |p|)_i is replaced by its bound (|G| |M^-1| |G|^T |p|)_i.
    """
    for b in range(motion.shape[1]):
        for j in range(6):
            motion[0, b, j] = motion[1, b, j] = 0.0
    for i in range(k):
        for side in range(2):
            b = island.body[i, side]
            if b < 0:
                continue
            G, M = island.rows[i, side], island.inverse_mass[b]
            for j in range(6):
                g = G[0, j] * p[3 * i] + G[1, j] * p[3 * i + 1] + G[2, j] * p[3 * i + 2]
                a = abs(G[0, j] * p[3 * i]) + abs(G[1, j] * p[3 * i + 1])
                a += abs(G[2, j] * p[3 * i + 2])
                for r in range(6):
                    motion[0, b, r] += M[r, j] * g
                    motion[1, b, r] += abs(M[r, j]) * a
    sums = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for i in range(k):
        n, trace = 3 * i, 0.0
        w0, w1, w2 = island.c[n], island.c[n + 1], island.c[n + 2]
        size = 0.0
        for side in range(2):
            b = island.body[i, side]
            if b < 0:
                continue
            G, M = island.rows[i, side], island.inverse_mass[b]
            for j in range(6):
                w0 += G[0, j] * motion[0, b, j]
                w1 += G[1, j] * motion[0, b, j]
                w2 += G[2, j] * motion[0, b, j]
            for r in range(3):
                s = 0.0
                for j in range(6):
                    s += abs(G[r, j]) * motion[1, b, j]
                    for m in range(6):
                        trace += G[r, j] * M[j, m] * G[r, m]
                size = max(size, s)
        sums = _with(
            sums, kind[i], mu[i], heading[i, 0], heading[i, 1], trace,
            p[n], p[n + 1], p[n + 2], w0, w1, w2,
            max(abs(island.c[n]), abs(island.c[n + 1]), abs(island.c[n + 2])), size,
        )  # fmt: skip
    return _result(sums)


@kernel
def _row(k, W, c, p, i):
    """Return (W p + c)_i and (|W| |p|)_i."""
    row, s, size = W[i], c[i], 0.0
    for j in range(3 * k):
        s += row[j] * p[j]
        size += abs(row[j] * p[j])
    return s, size


@kernel
def _with(sums, kind, mu, h1, h2, trace, p0, p1, p2, w0, w1, w2, c, size):
    """Return the greatest values with one contact more."""
    worst, largest, greatest, penetration, violation, complementarity = sums
    rho = 3.0 / trace if trace > 0.0 else 1.0
    y0, y1, y2 = nearest(
        kind,
        mu,
        h1,
        h2,
        p0 - rho * (w0 + shift(kind, mu, h1, h2, w1, w2)),
        p1 - rho * w1,
        p2 - rho * w2,
    )
    d0, d1, d2 = p0 - y0, p1 - y1, p2 - y2
    r = math.sqrt(d0 * d0 + d1 * d1 + d2 * d2) / rho
    if not r <= worst and worst == worst:  # NaN enters, and stays
        worst = r
    outside = -p0
    if kind == CONE:
        outside = max(outside, math.sqrt(p1 * p1 + p2 * p2) - mu * p0)
    elif kind == SLIDING:
        x, y = p1 + mu * p0 * h1, p2 + mu * p0 * h2
        outside = max(outside, math.sqrt(x * x + y * y))
    return (
        worst, max(largest, c), max(greatest, size), max(penetration, -w0),
        max(violation, outside), max(complementarity, abs(p0 * w0)),
    )  # fmt: skip


@kernel
def _result(sums):
    worst, largest, greatest, penetration, violation, complementarity = sums
    tolerance = RELATIVE * largest + ROUND_OFF * greatest
    return worst, tolerance, penetration, violation, complementarity
