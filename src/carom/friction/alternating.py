"""Alternating directions: slow, but the method comes near a solution where sweeps and Newton do not.

With v = w + mu |w_t| e_n the problem is: p in the cone, v in the dual cone, p.v = 0 (de Saxce). It is split
into x, which satisfies the equations, and z, which lies in the cone; r is the over-relaxation:

    (W + sigma) x = v + sigma z - c - mu |v_t| e_n,    z' = P_K(y - v/sigma),  y = r x + (1 - r) z
    v' = v + sigma (z' - y)

The order of the contacts has no effect.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.friction import layout as o
from carom.friction.cone import nearest, shift
from carom.friction.newton import velocity
from carom.friction.operators import factor_shifted, solve_shifted
from carom.friction.thresholds import RELAXATION


@kernel
def alternate(work, k, sigma, limit):
    """Iterate `limit` times from p."""
    x, z = work.vector[o.RHS], work.vector[o.ITERATE]
    v, c = work.vector[o.CHANGE], work.vector[o.BIAS]
    factor_shifted(work, k, sigma)
    velocity(work, k)
    for i in range(3 * k):
        v[i] = work.vector[o.RESULTING, i]
    for i in range(k):
        t = work.contact[i]
        v[3 * i] += shift(t.kind, t.mu, t.h1, t.h2, v[3 * i + 1], v[3 * i + 2])
    for _ in range(limit):
        for i in range(3 * k):
            x[i] = v[i] + sigma * z[i] - c[i]
        for i in range(k):
            t, n = work.contact[i], 3 * i
            x[n] -= shift(t.kind, t.mu, t.h1, t.h2, v[n + 1], v[n + 2])
        solve_shifted(work, k)
        for i in range(k):
            t, n = work.contact[i], 3 * i
            for j in range(n, n + 3):
                x[j] = RELAXATION * x[j] + (1.0 - RELAXATION) * z[j]
            z[n], z[n + 1], z[n + 2] = nearest(
                t.kind, t.mu, t.h1, t.h2,
                x[n] - v[n] / sigma, x[n + 1] - v[n + 1] / sigma, x[n + 2] - v[n + 2] / sigma,
            )  # fmt: skip
            for j in range(n, n + 3):
                v[j] += sigma * (z[j] - x[j])
