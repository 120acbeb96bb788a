"""Dense LU with partial pivoting, in place, for the leading part of larger arrays."""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def factor(A, n, pivot, least):
    """Factor A[:n, :n] in place; a pivot smaller than `least` is replaced by it. Return how many were."""
    replaced = 0
    for k in range(n):
        top, row = abs(A[k, k]), k
        for i in range(k + 1, n):
            if abs(A[i, k]) > top:
                top, row = abs(A[i, k]), i
        pivot[k] = row
        a, b = A[k], A[row]
        if row != k:
            for j in range(n):
                t = a[j]
                a[j] = b[j]
                b[j] = t
        if not top > least:
            a[k] = least if a[k] >= 0.0 else -least
            replaced += 1
        inverse = 1.0 / a[k]
        for i in range(k + 1, n):
            b = A[i]
            m = b[k] * inverse
            b[k] = m
            if m != 0.0:
                for j in range(k + 1, n):
                    b[j] -= m * a[j]
    return replaced


@kernel
def substitute(A, n, pivot, x):
    """Solve with the factors: x[:n] becomes the solution."""
    for k in range(n):
        row = pivot[k]
        if row != k:
            t = x[k]
            x[k] = x[row]
            x[row] = t
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
