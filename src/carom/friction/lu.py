"""Dense LU with partial pivoting, in place, for the leading part of larger arrays."""

from __future__ import annotations

from carom._compiled.decorators import kernel

#: columns with numbers in the rows that are subtracted are listed where they are fewer than one in so many
FEW_COLUMNS = 4


@kernel
def factor(A, n, pivot, least):
    """Factor A[:n, :n] in place; replace pivots smaller than `least` by it.

    Return how many were replaced, and about how many products were made: n^3/3 of a full matrix.
    Four columns are eliminated at a time, so that columns to their right are read and written once for four.
    Zeros are left out (bodies in a row have few neighbours), which changes no digit.
    """
    replaced, products = 0, 0
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
                if b[k] == 0.0:
                    continue
                b[k] *= inverse
                for j in range(k + 1, last):
                    b[j] -= b[k] * a[j]
        for k in range(first, last):
            for i in range(k + 1, last):
                a, b, m = A[k], A[i], A[i, k]
                for j in range(last, n if m != 0.0 else last):
                    b[j] -= m * a[j]
        if last == first + 4:
            products += eliminate(A, first, n, pivot)
    return replaced, products


@kernel
def eliminate(A, first, n, pivot):
    """Subtract multiples of four rows from all rows below; return the number of products.

    `pivot` has room for the columns beyond the four.
    """
    a0, a1, a2, a3 = A[first], A[first + 1], A[first + 2], A[first + 3]
    last, count, rows = first + 4, 0, 0
    columns = pivot[last:n]
    for j in range(last, n):
        if a0[j] != 0.0 or a1[j] != 0.0 or a2[j] != 0.0 or a3[j] != 0.0:
            columns[count], count = j, count + 1
    for i in range(last, n):
        m0, m1, m2, m3 = A[i, first], A[i, first + 1], A[i, first + 2], A[i, first + 3]
        if m0 != 0.0 or m1 != 0.0 or m2 != 0.0 or m3 != 0.0:
            rows += 1
            if FEW_COLUMNS * count < n - last:
                subtract_at(A, first, columns[:count], A[i])
            else:
                subtract_four(A, first, n, A[i])
    return 4 * (rows + 2) * (count + 2)  # those of the four columns, too


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
    for j in range(k + 4, n):
        b[j] = (((b[j] - m0 * a0[j]) - m1 * a1[j]) - m2 * a2[j]) - m3 * a3[j]


@kernel
def subtract_at(A, k, columns, b):
    """Do as `subtract_four` does in the columns in which the four rows have numbers."""
    a0, a1, a2, a3 = A[k], A[k + 1], A[k + 2], A[k + 3]
    m0, m1, m2, m3 = b[k], b[k + 1], b[k + 2], b[k + 3]
    for j in columns:
        b[j] = (((b[j] - m0 * a0[j]) - m1 * a1[j]) - m2 * a2[j]) - m3 * a3[j]


@kernel
def substitute(A, n, pivot, x):
    """Solve with the factors: replace x[:n] by the solution.

    Rows are solved four at a time: a sum waits for its last term, but four do not wait for
    each other.
    """
    for k in range(n):
        row = pivot[k]
        x[k], x[row] = x[row], x[k]
    whole = n - n % 4
    for first in range(0, whole, 4):
        subtract_products(A, first, (0, first), x)
        for i in range(first + 1, first + 4):
            for j in range(first, i):
                x[i] -= A[i, j] * x[j]
    for i in range(whole, n):
        a, s = A[i], x[i]
        for j in range(i):
            s -= a[j] * x[j]
        x[i] = s
    for i in range(n - 1, whole - 1, -1):
        a, s = A[i], x[i]
        for j in range(i + 1, n):
            s -= a[j] * x[j]
        x[i] = s / a[i]
    for first in range(whole - 4, -1, -4):
        subtract_products(A, first, (first + 4, n), x)
        for i in range(first + 3, first - 1, -1):
            for j in range(i + 1, first + 4):
                x[i] -= A[i, j] * x[j]
            x[i] /= A[i, i]


@kernel
def subtract_products(A, i, columns, x):
    """Subtract from four entries of x, i to i + 3, the products of their rows with x in a range of columns."""
    a0, a1, a2, a3 = A[i], A[i + 1], A[i + 2], A[i + 3]
    s0, s1, s2, s3 = x[i], x[i + 1], x[i + 2], x[i + 3]
    for j in range(columns[0], columns[1]):
        s0, s1 = s0 - a0[j] * x[j], s1 - a1[j] * x[j]
        s2, s3 = s2 - a2[j] * x[j], s3 - a3[j] * x[j]
    x[i], x[i + 1], x[i + 2], x[i + 3] = s0, s1, s2, s3


@kernel
def substitute_all(A, n, pivot, X):
    """Replace the columns X[:n, :n] by the solutions, row by row."""
    for k in range(n):
        a, b = X[k], X[pivot[k]]
        for j in range(n if pivot[k] != k else 0):
            a[j], b[j] = b[j], a[j]
    for i in range(n):
        for k in range(i):
            subtract_row(A[i, k], X[k], n, X[i])
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            subtract_row(A[i, k], X[k], n, X[i])
        for j in range(n):
            X[i, j] /= A[i, i]


@kernel
def subtract_row(m, a, n, b):
    """Subtract a multiple m of row a from row b."""
    for j in range(n if m != 0.0 else 0):
        b[j] -= m * a[j]
