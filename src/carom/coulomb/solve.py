"""The contact problem w = W p + c, 0 <= p_n _|_ w_n >= 0 with Coulomb friction, dense (mathematics page, VI.2)."""

from __future__ import annotations

import math

from carom.coulomb.layout import NOT_FINITE, NOT_SOLVED, SOLVED
from carom.coulomb.newton import newton
from carom.coulomb.residual import measure
from carom.coulomb.scaled import load, natural, onto_cone, velocity
from carom.coulomb.sweep import solve_local, sweep
from carom.jit import entry, kernel

_EPS = 1e-9  # weight of the proximal term
_NEWTON = 30  # iterations a round
_ROUNDS = 12


@entry
def solve_cones(k, W, c, mu, kind, heading, p, scratch):
    """Solve for the impulses of `k` contacts; return (status, residual, iterations).

    `W` (3K, 3K) symmetric inverse mass, `c` (3K,) velocity without impulses, rows (n, t1, t2) of each contact,
    K >= k, only the leading part is used. `mu` (K,), `kind` (K,) int64 and `heading` (K, 2): CONE,
    Coulomb's cone with the velocity w_t; SLIDING, p_t = -mu p_n heading; STICKING, w_t = 0 whatever the
    force, also where the normal is open. `p` (3K,) is the warm start and becomes the solution; `scratch` is from
    `new_cone_work(K)`. Status: SOLVED, or NOT_SOLVED (p is then the best found), or NOT_FINITE (p is 0).
    """
    if k == 0:
        return SOLVED, 0.0, 0
    gamma = load(k, W, c, p, scratch)
    for i in range(k):
        if not (mu[i] >= 0.0 and math.isfinite(mu[i] + heading[i, 0] + heading[i, 1])):
            gamma = math.nan
    if not math.isfinite(gamma):
        for i in range(3 * k):
            p[i] = 0.0
        return NOT_FINITE, math.inf, 0
    iterations = 0
    if k == 1:
        w, b = scratch.W, scratch.c
        _, p0, p1, p2 = solve_local(
            kind[0], mu[0], heading[0, 0], heading[0, 1],
            w[0, 0], w[0, 1], w[0, 2], w[1, 1], w[1, 2], w[2, 2], b[0], b[1], b[2],
        )  # fmt: skip
        scratch.p[0], scratch.p[1], scratch.p[2] = p0, p1, p2
    else:
        iterations = _search(k, mu, kind, heading, scratch)
    for i in range(3 * k):
        p[i] = gamma * scratch.scale[i // 3] * scratch.p[i]
    residual, tolerance, _, _, _ = measure(k, W, c, mu, kind, heading, p)
    return SOLVED if residual <= tolerance else NOT_SOLVED, residual, iterations


@kernel
def _search(k, mu, kind, heading, work):
    """Alternate Newton and sweeps until the residual is small; leave the best in work.p."""
    n, p, best = 3 * k, work.p, work.best
    least, iterations, sweeps = math.inf, 0, 25
    target = 1e-12 / max_scale(k, work)
    for turn in range(_ROUNDS):
        if turn > 0:
            for i in range(sweeps):
                sweep(k, mu, kind, heading, i % 2 == 1, work)
            sweeps = min(2 * sweeps, 200)
            iterations += sweeps
        for _ in range(3):  # proximal rounds: first about 0, for the least norm
            for i in range(n):
                work.centre[i] = p[i] if _ > 0 else 0.0
            _f, count = newton(k, mu, kind, heading, _EPS, _NEWTON, work)
            iterations += count
            onto_cone(k, mu, kind, heading, p)
            velocity(k, work)
            r = natural(k, mu, kind, heading, work)
            better = r < least
            if better:
                least = r
                for i in range(n):
                    best[i] = p[i]
            if not better or _f > 1e-8:
                break
        if least <= target:
            break
        if turn == 0:  # sweeps start from what was given
            pass
    for i in range(n):
        p[i] = best[i]
    return iterations


@kernel
def max_scale(k, work):
    most = 0.0
    for i in range(k):
        most = max(most, work.scale[i])
    return most
