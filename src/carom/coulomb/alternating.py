"""Alternating directions: slow, but it gets near a solution where sweeps and Newton do not.

With v = w + mu |w_t| e_n the problem reads: p in the cone, v in the dual cone, p.v = 0 (de Saxce). Split into
x, on the equations, and z, in the cone, over-relaxed by r:

    (W + sigma) x = v + sigma z - c - mu |v_t| e_n,    z' = P_K(y - v/sigma),  y = r x + (1 - r) z
    v' = v + sigma (z' - y)

All contacts are treated alike, whatever their order.
"""

from __future__ import annotations

from carom.coulomb.cone import nearest, shift
from carom.coulomb.newton import velocity
from carom.coulomb.operators import factor_shifted, solve_shifted
from carom.jit import kernel

_RELAXATION = 1.6


@kernel
def alternate(k, mu, kind, heading, sigma, limit, work):
    """Iterate `limit` times from work.p."""
    x, z, v = work.rhs, work.p, work.change
    factor_shifted(work, k, sigma)
    velocity(k, work)
    for i in range(3 * k):
        v[i] = work.w[i]
    for i in range(k):
        v[3 * i] += shift(kind[i], mu[i], heading[i, 0], heading[i, 1], v[3 * i + 1], v[3 * i + 2])
    for _ in range(limit):
        for i in range(3 * k):
            x[i] = v[i] + sigma * z[i] - work.c[i]
        for i in range(k):
            a = 3 * i
            x[a] -= shift(kind[i], mu[i], heading[i, 0], heading[i, 1], v[a + 1], v[a + 2])
        solve_shifted(work, k)
        for i in range(k):
            a = 3 * i
            for j in range(a, a + 3):
                x[j] = _RELAXATION * x[j] + (1.0 - _RELAXATION) * z[j]
            z[a], z[a + 1], z[a + 2] = nearest(
                kind[i], mu[i], heading[i, 0], heading[i, 1],
                x[a] - v[a] / sigma, x[a + 1] - v[a + 1] / sigma, x[a + 2] - v[a + 2] / sigma,
            )  # fmt: skip
            for j in range(a, a + 3):
                v[j] += sigma * (z[j] - x[j])
