"""Dense solves of a few unknowns: the metric by Cholesky, rows by elimination without dependent pivots."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel


@kernel
def cholesky(M, L, n):
    """Write the lower factor of M; return whether M is positive definite."""
    for j in range(n):
        d = M[j, j]
        for s in range(j):
            d -= L[j, s] * L[j, s]
        if not (d > 1e-15 * M[j, j] and math.isfinite(d)):
            return False
        L[j, j] = math.sqrt(d)
        for i in range(j + 1, n):
            t = M[i, j]
            for s in range(j):
                t -= L[i, s] * L[j, s]
            L[i, j] = t / L[j, j]
    return True


@kernel
def solve_metric(L, b, n):
    """Replace b by M^-1 b."""
    for i in range(n):
        for s in range(i):
            b[i] -= L[i, s] * b[s]
        b[i] /= L[i, i]
    for i in range(n - 1, -1, -1):
        for s in range(i + 1, n):
            b[i] -= L[s, i] * b[s]
        b[i] /= L[i, i]


@kernel
def factor(K, inverse, m, drop):
    """Factor K = L U in place (unit L), in the order of the rows.

    A pivot below `drop` times its original diagonal belongs to a row that depends on earlier ones: row and
    column are left out (``inverse`` is 0 there).
    """
    for i in range(m):
        diagonal = abs(K[i, i])
        for j in range(m):
            t = K[i, j]
            for s in range(min(i, j)):
                if inverse[s] != 0.0:
                    t -= K[i, s] * K[s, j]
            K[i, j] = t * inverse[j] if j < i else t
        inverse[i] = 1.0 / K[i, i] if abs(K[i, i]) > drop * diagonal else 0.0


@kernel
def substitute(K, inverse, b, m):
    """Replace b by the solution; 0 in the rows that are left out."""
    for i in range(m):
        for s in range(i):
            b[i] -= K[i, s] * b[s]
        if inverse[i] == 0.0:
            b[i] = 0.0
    for i in range(m - 1, -1, -1):
        for s in range(i + 1, m):
            b[i] -= K[i, s] * b[s]
        b[i] *= inverse[i]
