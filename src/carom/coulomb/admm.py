"""Alternating directions: slow, but it gets near a solution where sweeps and Newton do not.

With v = w + mu |w_t| e_n the problem reads: p in the cone, v in the dual cone, p.v = 0 (de Saxce). Splitting
p = x = z, with x on the equations and z in the cone:

    (W + sigma) x = v + sigma z - c - mu |v_t| e_n,    z' = P_K(r x + (1 - r) z - v/sigma)

and v moves by sigma times the mismatch. mu |v_t| follows along. All contacts are treated alike, so
that the order of the contacts does not matter.
"""

from __future__ import annotations

import math

from carom.coulomb.layout import CONE, SLIDING
from carom.coulomb.lu import factor, substitute
from carom.coulomb.residual import cone_projection
from carom.coulomb.scaled import velocity
from carom.jit import kernel

_RELAXATION = 1.6


@kernel
def alternate(k, mu, kind, heading, sigma, limit, work):
    """Iterate `limit` times from work.p."""
    n = 3 * k
    x, z, v = work.rhs, work.p, work.change
    for i in range(n):
        row, out = work.W[i], work.jacobian[i]
        for j in range(n):
            out[j] = row[j]
        out[i] += sigma
    factor(work.jacobian, n, work.pivot, 0.0)
    velocity(k, work)
    for i in range(n):
        v[i] = work.w[i]
    for i in range(k):
        v[3 * i] += _shift(kind[i], mu[i], heading[i, 0], heading[i, 1], v[3 * i + 1], v[3 * i + 2])
    for _ in range(limit):
        for i in range(n):
            x[i] = v[i] + sigma * z[i] - work.c[i]
        for i in range(k):
            a = 3 * i
            x[a] -= _shift(kind[i], mu[i], heading[i, 0], heading[i, 1], v[a + 1], v[a + 2])
        substitute(work.jacobian, n, work.pivot, x)
        for i in range(k):
            a = 3 * i
            for j in range(a, a + 3):
                x[j] = _RELAXATION * x[j] + (1.0 - _RELAXATION) * z[j]
            z[a], z[a + 1], z[a + 2] = _nearest(
                kind[i], mu[i], heading[i, 0], heading[i, 1],
                x[a] - v[a] / sigma, x[a + 1] - v[a + 1] / sigma, x[a + 2] - v[a + 2] / sigma,
            )  # fmt: skip
            for j in range(a, a + 3):
                v[j] += sigma * (z[j] - x[j])


@kernel
def _shift(kind, mu, h1, h2, v1, v2):
    """Return v_n - w_n."""
    if kind == CONE:
        return mu * math.sqrt(v1 * v1 + v2 * v2)
    if kind == SLIDING:  # normal to the ray (1, -mu h)
        return mu * (h1 * v1 + h2 * v2)
    return 0.0


@kernel
def _nearest(kind, mu, h1, h2, x0, x1, x2):
    if kind == CONE:
        return cone_projection(mu, x0, x1, x2)
    if kind == SLIDING:
        n = max(0.0, (x0 - mu * (h1 * x1 + h2 * x2)) / (1.0 + mu * mu * (h1 * h1 + h2 * h2)))
        return n, -mu * n * h1, -mu * n * h2
    return max(0.0, x0), x1, x2
