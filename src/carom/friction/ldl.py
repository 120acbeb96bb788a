"""Dense symmetric L D L^T, in place, for the leading part of larger arrays; rows that depend on others drop."""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def factor(n, drop, L):
    """Turn a matrix (n, n) into its factor L D L^T, L unit below the diagonal and D on it.

    Pivots below `drop` times their diagonal are left out: such a row depends on those before it, and gets no
    impulse of its own.
    """
    for j in range(n):
        eliminate(n, j, drop * L[j, j], L)


@kernel
def eliminate(n, j, least, L):
    """Turn column j into that of the factor, after those before it; a pivot that is not above `least` is 0."""
    d = L[j, j]
    for s in range(j):
        d -= L[j, s] * L[j, s] * L[s, s]
    kept = d > least
    L[j, j] = d if kept else 0.0
    for i in range(j + 1, n):
        t = L[i, j]
        for s in range(j):
            t -= L[i, s] * L[j, s] * L[s, s]
        L[i, j] = t / d if kept else 0.0


@kernel
def factor_by_pivots(n, least, rows, L):
    """Factor as `factor` does, by pivots above `least`: exchange the numbers `rows`; return the rank.

    The row that those before it determine least comes next: in another order the pivot of a row that nearly
    depends on them is small, and those after it are its round-off. Rows that are alike to 1e-4 keep their
    order: of four corners round-off must not say which is left out. The leading part of L (n, n), of this
    rank, is the factor; rows below it are those of L for the rows that are left out.
    """
    for j in range(n):
        best = j
        for i in range(j + 1, n):
            if L[i, i] > 1.0001 * L[best, best]:
                best = i
        if not L[best, best] > least:
            return j
        exchange(n, j, best, rows, L)
        for i in range(j + 1, n):
            ratio = L[i, j] / L[j, j]
            for s in range(j + 1, i + 1):
                L[i, s] -= ratio * L[s, j]
        for i in range(j + 1, n):
            L[i, j] /= L[j, j]
    return n


@kernel
def exchange(n, i, j, rows, L):
    """Exchange rows i < j of a symmetric matrix of which the part below its diagonal is kept."""
    rows[i], rows[j] = rows[j], rows[i]
    if i == j:
        return
    L[i, i], L[j, j] = L[j, j], L[i, i]
    for s in range(i):
        L[i, s], L[j, s] = L[j, s], L[i, s]
    for s in range(i + 1, j):
        L[s, i], L[j, s] = L[j, s], L[s, i]
    for s in range(j + 1, n):
        L[s, i], L[s, j] = L[s, j], L[s, i]


@kernel
def substitute(n, L, x):
    """Solve L D L^T x = x in place; rows that were left out get 0."""
    for i in range(n):
        for s in range(i):
            x[i] -= L[i, s] * x[s]
    for i in range(n):
        x[i] = x[i] / L[i, i] if L[i, i] > 0.0 else 0.0
    for i in range(n - 1, -1, -1):
        for s in range(i + 1, n):
            x[i] -= L[s, i] * x[s]
        if not L[i, i] > 0.0:
            x[i] = 0.0
