"""The contact problem w = W p + c, 0 <= p_n _|_ w_n >= 0 with Coulomb friction, dense (mathematics page, VI.2)."""

from __future__ import annotations

import math

from carom.coulomb.layout import NOT_FINITE, NOT_SOLVED, SOLVED
from carom.coulomb.newton import newton
from carom.coulomb.residual import measure
from carom.coulomb.scaled import load, onto_cone, residual as scaled_residual
from carom.coulomb.admm import alternate
from carom.coulomb.sweep import solve_local, sweep
from carom.jit import entry, kernel

_EPS = 1e-8  # weight of the proximal term
_NEWTON = 30  # most iterations a try
_POLISH = 8  # most moves of the proximal centre
_TURNS = 20  # most starting points
_EXTRA = 2  # more of them where the tolerance is met, but not to round-off
_SWEEPS = 25, 200  # at first, at most
_ALTERNATIONS = 300


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
    """Newton from one starting point after the other; the best result is left in work.p."""
    n, p, best = 3 * k, work.p, work.best
    least, iterations, sweeps, last_turn = math.inf, 0, _SWEEPS[0], _TURNS
    turn = 0
    while turn < last_turn:
        if turn > 0 and turn % 2 == 0:
            sigma = 0.01 * 10.0 ** ((turn // 2) % 3)
            alternate(k, mu, kind, heading, sigma, _ALTERNATIONS, work)
            iterations += _ALTERNATIONS
        elif turn > 0:
            for i in range(sweeps):
                sweep(k, mu, kind, heading, i % 2 == 1, work)
            iterations += sweeps
            sweeps = min(2 * sweeps, _SWEEPS[1])
        count, r, goal, tolerance = _polished_newton(k, mu, kind, heading, turn == 0, work)
        iterations += count
        if r < least:
            least = r
            for i in range(n):
                best[i] = p[i]
        if least <= goal:
            break
        turn += 1
        if least <= 0.9 * tolerance:
            last_turn = min(last_turn, turn + _EXTRA)
    for i in range(n):
        p[i] = best[i]
    return iterations


@kernel
def _polished_newton(k, mu, kind, heading, least_norm, work):
    """Return (iterations, residual, goal, tolerance); work.p is the best of the rounds.

    The proximal term is centred at 0 at first, for the solution of least norm, or at p; then it is moved
    to the last solution until its bias is gone.
    """
    n, p, kept = 3 * k, work.p, work.kept
    for i in range(n):
        work.centre[i] = 0.0 if least_norm else p[i]
    total, m, least = 0, -1, math.inf
    goal, tolerance = 0.0, 0.0
    for _ in range(_POLISH):
        _, count, m = newton(k, mu, kind, heading, _EPS, _NEWTON, m, work)
        total += count
        onto_cone(k, mu, kind, heading, p)
        r, goal, tolerance = scaled_residual(k, mu, kind, heading, work)
        enough = r <= goal or not r < 0.5 * least
        if r < least:
            least = r
            for i in range(n):
                kept[i] = p[i]
        if enough:
            break
        for i in range(n):
            work.centre[i] = p[i]
    for i in range(n):
        p[i] = kept[i]
    return total, least, goal, tolerance
