"""The problem in scaled variables, in which each contact has the same weight.

p_i = gamma s_i q_i, w_i = gamma v_i / s_i with s_i^2 = 3 / trace W_ii, so that each diagonal block has trace 3,
and gamma such that the greatest entry of the scaled c is 1. One number for the three rows of a contact:
the cone stays what it is. Nothing that follows knows of units or of the masses' ratios.
"""

from __future__ import annotations

import math

from carom.coulomb.cone import project
from carom.coulomb.residual import natural_residual
from carom.jit import kernel


@kernel
def load(k, W, c, p, work):
    """Write scaled W, c and p; return gamma, or NaN if anything is not finite."""
    total = 0.0
    for i in range(k):
        n = 3 * i
        trace = W[n, n] + W[n + 1, n + 1] + W[n + 2, n + 2]
        work.scale[i] = math.sqrt(3.0 / trace) if trace > 0.0 else 1.0
    gamma = 0.0
    for i in range(3 * k):
        s = work.scale[i // 3]
        work.c[i] = s * c[i]
        gamma = max(gamma, abs(work.c[i]))
        total += c[i]
        row, out = W[i], work.W[i]
        for j in range(3 * k):
            out[j] = s * row[j] * work.scale[j // 3]
            total += row[j]
    if not math.isfinite(total):
        return math.nan
    if gamma == 0.0:
        gamma = 1.0
    for i in range(3 * k):
        work.c[i] /= gamma
        q = p[i] / (work.scale[i // 3] * gamma)
        work.p[i] = q if math.isfinite(q) else 0.0
    return gamma


@kernel
def add_columns(k, W, p, out):
    """Add W p to `out`, column by column (they are the rows of a symmetric W)."""
    n = 3 * k
    for j in range(n):
        q, column = p[j], W[j]
        if q != 0.0:
            for i in range(n):
                out[i] += q * column[i]


@kernel
def velocity(k, work):
    """Write w = W p + c."""
    for i in range(3 * k):
        work.w[i] = work.c[i]
    add_columns(k, work.W, work.p, work.w)


@kernel
def residual(k, mu, kind, heading, work):
    """Return (residual, goal, tolerance) of work.p in velocity, in units of gamma; work.w becomes W p + c.

    The goal is what round-off allows; the tolerance is that of `carom.coulomb.residual`.
    """
    velocity(k, work)
    p, w = work.p, work.w
    worst, largest, size = 0.0, 0.0, 0.0
    for i in range(k):
        n = 3 * i
        r = natural_residual(
            kind[i], mu[i], heading[i, 0], heading[i, 1], 1.0,
            p[n], p[n + 1], p[n + 2], w[n], w[n + 1], w[n + 2],
        )  # fmt: skip
        s = work.scale[i]
        if not r / s <= worst and worst == worst:
            worst = r / s
        for a in range(n, n + 3):
            largest = max(largest, abs(work.c[a]) / s)
            row, total = work.W[a], 0.0
            for j in range(3 * k):
                total += abs(row[j] * p[j])
            size = max(size, total / s)
    size *= 2.220446049250313e-16
    return worst, 4.0 * size, 1e-10 * largest + 50.0 * size


@kernel
def onto_cone(k, mu, kind, heading, p):
    """Move each impulse into its cone: exactly zero where open, |p_t| <= mu p_n."""
    for i in range(k):
        n = 3 * i
        p[n], p[n + 1], p[n + 2] = project(
            kind[i], mu[i], heading[i, 0], heading[i, 1], p[n], p[n + 1], p[n + 2]
        )
