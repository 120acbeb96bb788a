"""Rows of numbers."""

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
