"""Elimination for a few rows with different reactions, without those that depend on earlier ones."""

from __future__ import annotations

from carom._compiled.decorators import kernel


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
