"""Block Gauss-Seidel: each contact in turn solved exactly, the others held; forth and back."""

from __future__ import annotations

from carom.coulomb.layout import CONE, SLIDING
from carom.coulomb.one import solve_one
from carom.impact.rays import solve_tangential
from carom.jit import kernel


@kernel
def solve_local(kind, mu, h1, h2, w00, w01, w02, w11, w12, w22, c0, c1, c2):
    """Return (found, p_n, p_1, p_2) of one contact of any kind."""
    if kind == CONE:
        return solve_one(w00, w01, w02, w11, w12, w22, c0, c1, c2, mu)
    if kind == SLIDING:
        if c0 >= 0.0:
            return True, 0.0, 0.0, 0.0
        d = w00 - mu * (w01 * h1 + w02 * h2)
        if not d > 0.0:
            return False, 0.0, 0.0, 0.0
        n = -c0 / d
        return True, n, -mu * n * h1, -mu * n * h2
    # Sticking: tangents eliminated, then the normal.
    a1, a2 = solve_tangential(w11, w12, w22, w01, w02)
    b1, b2 = solve_tangential(w11, w12, w22, c1, c2)
    d = w00 - w01 * a1 - w02 * a2
    g = c0 - w01 * b1 - w02 * b2
    n = 0.0
    if g < 0.0 and d > 1e-13 * w00:
        n = -g / d
    return True, n, -b1 - a1 * n, -b2 - a2 * n


@kernel
def sweep(k, mu, kind, heading, backward, work):
    """Go once over all contacts; return the greatest change of an impulse (scaled)."""
    n3, p, most = 3 * k, work.p, 0.0
    for place in range(k):
        i = k - 1 - place if backward else place
        n = 3 * i
        r0, r1, r2 = work.W[n], work.W[n + 1], work.W[n + 2]
        c0, c1, c2 = work.c[n], work.c[n + 1], work.c[n + 2]
        for j in range(n3):
            q = p[j]
            c0 += r0[j] * q
            c1 += r1[j] * q
            c2 += r2[j] * q
        q0, q1, q2 = p[n], p[n + 1], p[n + 2]
        w00, w01, w02, w11, w12, w22 = r0[n], r0[n + 1], r0[n + 2], r1[n + 1], r1[n + 2], r2[n + 2]
        c0 -= w00 * q0 + w01 * q1 + w02 * q2
        c1 -= w01 * q0 + w11 * q1 + w12 * q2
        c2 -= w02 * q0 + w12 * q1 + w22 * q2
        found, x0, x1, x2 = solve_local(
            kind[i], mu[i], heading[i, 0], heading[i, 1], w00, w01, w02, w11, w12, w22, c0, c1, c2
        )
        if not found:
            continue
        p[n], p[n + 1], p[n + 2] = x0, x1, x2
        most = max(most, abs(x0 - q0), abs(x1 - q1), abs(x2 - q2))
    return most
