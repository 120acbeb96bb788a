"""The contact problem with W stored whole: `solve_cones`."""

from __future__ import annotations

import math

from carom.coulomb.layout import BAD_INPUT, NOT_SOLVED, SOLVED
from carom.coulomb.local import solve_local
from carom.coulomb.residual import measure
from carom.coulomb.search import search
from carom.jit import entry, kernel


@entry
def solve_cones(k, W, c, mu, kind, heading, p, scratch):
    """Solve w = W p + c, 0 <= p_n _|_ w_n >= 0 with Coulomb friction; return (status, residual, iterations).

    Rows (n, t1, t2) of k contacts; arrays for K >= k of them, the leading part is used. `W` (3K, 3K) is
    symmetric, `c` (3K,) the velocity without impulses, `mu` (K,) the friction, `p` (3K,) the warm start and then
    the solution, `scratch` from `layout.new_cone_work(K)`. `kind` (K,) int64: CONE, friction against
    w_t; SLIDING, p_t = -mu p_n heading, `heading` (K, 2); STICKING, w_t = 0 whatever force that takes, even
    where p_n = 0. Status: SOLVED; NOT_SOLVED, p is the best that was found; BAD_INPUT, p is 0. The
    residual is that of `residual.measure`.
    """
    if k == 0:
        return SOLVED, 0.0, 0
    gamma = _load(k, W, c, mu, heading, p, scratch)
    if not math.isfinite(gamma):
        for i in range(3 * k):
            p[i] = 0.0
        return BAD_INPUT, math.inf, 0
    iterations = 0
    if k == 1:
        w, b = scratch.W, scratch.c
        _, scratch.p[0], scratch.p[1], scratch.p[2] = solve_local(
            kind[0], mu[0], heading[0, 0], heading[0, 1],
            w[0, 0], w[0, 1], w[0, 2], w[1, 1], w[1, 2], w[2, 2], b[0], b[1], b[2],
        )  # fmt: skip
    else:
        iterations = search(k, mu, kind, heading, scratch)
    for i in range(3 * k):
        p[i] = gamma * scratch.scale[i // 3] * scratch.p[i]
    residual, tolerance, _, _, _ = measure(k, W, c, mu, kind, heading, p)
    return SOLVED if residual <= tolerance else NOT_SOLVED, residual, iterations


@kernel
def _load(k, W, c, mu, heading, p, work):
    """Write W, c and p in scaled variables; return gamma, or NaN if anything is not finite or mu < 0.

    p_i = gamma s_i q_i, w_i = gamma v_i / s_i with s_i^2 = 3 / trace W_ii, so that each diagonal block
    has trace 3, and gamma such that the greatest entry of the scaled c is 1. One number for the three
    rows of a contact: its cone stays what it is. The solver knows neither units nor ratios of masses.
    """
    total = 0.0
    for i in range(k):
        n = 3 * i
        trace = W[n, n] + W[n + 1, n + 1] + W[n + 2, n + 2]
        work.scale[i] = math.sqrt(3.0 / trace) if trace > 0.0 else 1.0
        total += mu[i] + heading[i, 0] + heading[i, 1]
        if not mu[i] >= 0.0:
            return math.nan
    for i in range(3 * k):
        s = work.scale[i // 3]
        row, out = W[i], work.W[i]
        for j in range(3 * k):
            out[j] = s * row[j] * work.scale[j // 3]
            total += out[j]
    if not math.isfinite(total):
        return math.nan
    return scale_vectors(k, c, p, work)


@kernel
def scale_vectors(k, c, p, work):
    """Write c and p in scaled variables; return gamma, or NaN if c is not finite."""
    gamma = 0.0
    for i in range(3 * k):
        work.c[i] = work.scale[i // 3] * c[i]
        if not math.isfinite(c[i]):
            return math.nan
        gamma = max(gamma, abs(work.c[i]))
    if gamma == 0.0:
        gamma = 1.0
    for i in range(3 * k):
        work.c[i] /= gamma
        q = p[i] / (work.scale[i // 3] * gamma)
        work.p[i] = q if math.isfinite(q) else 0.0
    return gamma
