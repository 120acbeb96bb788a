"""Rows of numbers, and elimination for a few of them with other reactions, without dependent ones."""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def copy_row(row, out, n):
    """Copy n numbers."""
    for j in range(n):
        out[j] = row[j]


@kernel
def add_row(f, row, out, n):
    """Add f times n numbers to `out`."""
    for j in range(n):
        out[j] += f * row[j]


@kernel
def dot(a, b, n):
    """Return the sum of the products of n numbers."""
    total = 0.0
    for j in range(n):
        total += a[j] * b[j]
    return total


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
