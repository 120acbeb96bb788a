"""Impacts of a cube on one corner, with friction and random data; only the impact is computed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

NAME, TITLE = "corner_impact", "Impact of a cube on a corner, mu = 0.2"
IMPACTS_TIMED = 2000
LAW = 0  # of `carom.law.impact_laws`: Newton


def impacts(count: int = IMPACTS_TIMED, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Return W (count, 3, 3) [1/kg] and u (count, 3) [m/s] of a cube that strikes with one corner."""
    random = np.random.default_rng(seed)
    m, a = 0.016, 0.02
    J = m * a * a / 6.0
    W, u = np.empty((count, 3, 3)), np.empty((count, 3))
    for i in range(count):
        r = random.normal(size=3)
        r *= 0.5 * a * np.sqrt(3.0) / np.linalg.norm(r)
        hat = np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
        W[i] = np.eye(3) / m - hat @ hat / J
        u[i] = random.normal(size=3)
        u[i, 0] = -abs(u[i, 0]) - 0.1
    return np.ascontiguousarray(W), u


def ours(mu: float = 0.2, e: float = 0.5, law: int = LAW) -> Callable[[], None]:
    """Return a function that resolves all impacts once."""
    from carom.impact.layout import OK, SIZE
    from carom.impact.many import resolve_each
    from carom.model.laws import LawTable

    W, u = impacts()
    n = len(u)
    same = np.tile([mu, e, 0.0], (n, 1)), np.tile([law, -1], (n, 1)), LawTable().arrays()
    out = np.zeros((n, SIZE))

    def run() -> None:
        assert resolve_each(W, u, *same, out) == (-1, OK)

    return run


def error(mu: float = 0.2, e: float = 0.5, count: int = 200) -> float:
    """Return the greatest error of velocities after, from Newton's law, -e u_n, and from u + W P [m/s]."""
    import carom

    W, u = impacts(count)
    worst = 0.0
    for i in range(count):
        found = carom.resolve_impact(W[i], u[i], mu, e)
        balance = np.abs(found.velocity_after - u[i] - W[i] @ found.impulse).max()
        worst = max(worst, balance, abs(found.velocity_after[0] + e * u[i, 0]))
    return float(worst)
