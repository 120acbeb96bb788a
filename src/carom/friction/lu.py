"""Dense LU with partial pivoting, in place, for the leading part of larger arrays."""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def factor(A, n, pivot, least):
    """Factor A[:n, :n] in place; replace pivots smaller than `least` by it; return how many were replaced.

    Four columns are eliminated at a time, so that columns to their right are read and written once for four.
    """
    replaced = 0
    for first in range(0, n, 4):
        last = min(first + 4, n)
        for k in range(first, last):
            exchange(A, n, pivot, k)
            a = A[k]
            if not abs(a[k]) > least:
                a[k] = least if a[k] >= 0.0 else -least
                replaced += 1
            inverse = 1.0 / a[k]
            for i in range(k + 1, n):
                b = A[i]
                b[k] *= inverse
                for j in range(k + 1, last):
                    b[j] -= b[k] * a[j]
        for k in range(first, last):
            for i in range(k + 1, last):
                a, b, m = A[k], A[i], A[i, k]
                for j in range(last, n):
                    b[j] -= m * a[j]
        if last == first + 4:
            for i in range(last, n):
                subtract_four(A, first, n, A[i])
    return replaced


@kernel
def exchange(A, n, pivot, k):
    """Exchange row k with the row that has the largest number in column k, from row k down."""
    top, row = abs(A[k, k]), k
    for i in range(k + 1, n):
        if abs(A[i, k]) > top:
            top, row = abs(A[i, k]), i
    pivot[k] = row
    if row != k:
        a, b = A[k], A[row]
        for j in range(n):
            a[j], b[j] = b[j], a[j]


@kernel
def subtract_four(A, k, n, b):
    """Subtract multiples of four rows, k to k + 3, from row b; columns k to k + 3 of b have the factors."""
    a0, a1, a2, a3 = A[k], A[k + 1], A[k + 2], A[k + 3]
    m0, m1, m2, m3 = b[k], b[k + 1], b[k + 2], b[k + 3]
    if m0 != 0.0 or m1 != 0.0 or m2 != 0.0 or m3 != 0.0:
        for j in range(k + 4, n):
            b[j] = (((b[j] - m0 * a0[j]) - m1 * a1[j]) - m2 * a2[j]) - m3 * a3[j]


@kernel
def substitute(A, n, pivot, x):
    """Solve with the factors: replace x[:n] by the solution."""
    for k in range(n):
        row = pivot[k]
        x[k], x[row] = x[row], x[k]
    for i in range(n):
        a, s = A[i], x[i]
        for j in range(i):
            s -= a[j] * x[j]
        x[i] = s
    for i in range(n - 1, -1, -1):
        a, s = A[i], x[i]
        for j in range(i + 1, n):
            s -= a[j] * x[j]
        x[i] = s / a[i]
