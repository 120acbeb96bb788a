"""Anderson mixing of sweeps: the next start is the combination of the last results with the least change.

Two sweeps map impulses p to g(p); a solution has f(p) = g(p) - p = 0. With the differences of the last f and g
as columns of F and H, the next start is g - H theta, where theta minimizes |f - F theta| (Anderson 1965; Walker
and Ni 2011). While the set of contacts does not change, this is GMRES for the sweeps: 200 sweeps of a wall
reach a residual of 1e-12 of its speeds, and 1e-4 without mixing. Joints and kinds of contacts have no effect.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom._compiled.decorators import kernel
from carom.friction.cone import project
from carom.friction.layout import ITERATE
from carom.friction.ldl import factor, substitute
from carom.stepping.thresholds import MIXING_GROWTH, MIXING_RIDGE

WINDOW = 8  # number of stored differences


class Mixing(NamedTuple):
    """Results of the last sweeps of 3K impulses."""

    start: np.ndarray  # (3K,) impulses before the last two sweeps
    change: np.ndarray  # (3K,) f
    reached: np.ndarray  # (3K,) g
    F: np.ndarray  # (WINDOW, 3K) differences of f, and of g
    H: np.ndarray  # (WINDOW, 3K)
    gram: np.ndarray  # (WINDOW, WINDOW) F F^T
    factor: np.ndarray  # (WINDOW, WINDOW)
    theta: np.ndarray  # (WINDOW,)
    count: np.ndarray  # (2,) number of stored differences, and place of the next one
    size: np.ndarray  # (1,) |f|, infinite before the first


def new_mixing(points: int) -> Mixing:
    """Return the workspace of mixing for up to `points` contacts."""
    n = 3 * points
    return Mixing(
        start=np.zeros(n), change=np.zeros(n), reached=np.zeros(n),
        F=np.zeros((WINDOW, n)), H=np.zeros((WINDOW, n)),
        gram=np.zeros((WINDOW, WINDOW)), factor=np.zeros((WINDOW, WINDOW)), theta=np.zeros(WINDOW),
        count=np.zeros(2, dtype=np.int64), size=np.zeros(1),
    )  # fmt: skip


@kernel
def forget(mixing):
    """Drop the results of all sweeps."""
    mixing.count[0], mixing.count[1], mixing.size[0] = 0, 0, np.inf


@kernel
def note_start(work, k, mixing):
    """Store the impulses before two sweeps."""
    p, start = work.vector[ITERATE], mixing.start
    for i in range(3 * k):
        start[i] = p[i]


@kernel
def note_end(work, k, mixing):
    """Store the result of two sweeps from the stored impulses, and its differences from the last result."""
    p, start, change, reached = work.vector[ITERATE], mixing.start, mixing.change, mixing.reached
    n, size, known = 3 * k, 0.0, mixing.size[0] < np.inf
    at = mixing.count[1]
    F, H = mixing.F[at], mixing.H[at]
    for i in range(n):
        f = p[i] - start[i]
        size += f * f
        F[i], H[i] = f - change[i], p[i] - reached[i]
        change[i], reached[i] = f, p[i]
    size = np.sqrt(size)
    if known and size <= MIXING_GROWTH * mixing.size[0]:
        mixing.count[0] = min(mixing.count[0] + 1, WINDOW)
        mixing.count[1] = (at + 1) % WINDOW
        for j in range(mixing.count[0]):
            mixing.gram[at, j] = mixing.gram[j, at] = product(n, F, mixing.F[j])
    else:
        mixing.count[0], mixing.count[1] = 0, 0
    mixing.size[0] = size


@kernel
def extrapolate(work, k, mixing):
    """Replace the impulses by the combination of least change, projected onto the cones."""
    p, theta, n = work.vector[ITERATE], mixing.theta, 3 * k
    if mixing.count[0] == 0:
        return
    solve_least(n, mixing)
    for j in range(mixing.count[0]):
        t, H = theta[j], mixing.H[j]
        for i in range(n):
            p[i] -= t * H[i]
    for i in range(k):
        m = 3 * i
        p[m], p[m + 1], p[m + 2] = project(work.contact[i], p[m], p[m + 1], p[m + 2])


@kernel
def solve_least(n, mixing):
    """Write the theta that minimizes |f - F theta|, by F F^T."""
    L, theta, m = mixing.factor, mixing.theta, mixing.count[0]
    for j in range(m):
        theta[j] = product(n, mixing.F[j], mixing.change)
        for i in range(j, m):
            L[i, j] = mixing.gram[i, j] * (1.0 + MIXING_RIDGE if i == j else 1.0)
    factor(m, 0.0, L)
    substitute(m, L, theta)


@kernel
def product(n, a, b):
    """Return the scalar product, computed as four sums, which is faster."""
    s0, s1, s2, s3 = 0.0, 0.0, 0.0, 0.0
    whole = n - n % 4
    for i in range(0, whole, 4):
        s0 += a[i] * b[i]
        s1 += a[i + 1] * b[i + 1]
        s2 += a[i + 2] * b[i + 2]
        s3 += a[i + 3] * b[i + 3]
    for i in range(whole, n):
        s0 += a[i] * b[i]
    return (s0 + s1) + (s2 + s3)
