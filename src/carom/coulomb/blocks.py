"""Block LU on the graph of bodies: blocks 6x6, rows exchanged inside the diagonal blocks only."""

from __future__ import annotations

from carom.jit import kernel

_LEAST = 1e-14  # pivots smaller than this are replaced by it


@kernel
def factor_blocks(graph, block, pivot):
    """Factor in place: right of the diagonal U, below it L with unit diagonal blocks."""
    bodies, pairs = graph.order.shape[0], graph.later.shape[0]
    for place in range(bodies):
        b = graph.order[place]
        _factor_diagonal(block[b], pivot[b])
        for s in range(graph.start[place], graph.start[place + 1]):
            _divide(block[bodies + pairs + s], block[b], pivot[b])
        for t in range(graph.update[place], graph.update[place + 1]):
            _subtract_product(
                block[graph.target[t, 2]],
                block[bodies + pairs + graph.target[t, 0]],
                block[bodies + graph.target[t, 1]],
            )


@kernel
def substitute_blocks(graph, block, pivot, x):
    """Solve with the factors: x (N, 6) becomes the solution."""
    bodies, pairs = graph.order.shape[0], graph.later.shape[0]
    for place in range(bodies):
        y = x[graph.order[place]]
        for s in range(graph.start[place], graph.start[place + 1]):
            _subtract_image(x[graph.later[s]], block[bodies + pairs + s], y)
    for place in range(bodies - 1, -1, -1):
        b = graph.order[place]
        y = x[b]
        for s in range(graph.start[place], graph.start[place + 1]):
            _subtract_image(y, block[bodies + s], x[graph.later[s]])
        _solve_diagonal(block[b], pivot[b], y)


@kernel
def _factor_diagonal(A, pivot):
    for k in range(6):
        top, row = abs(A[k, k]), k
        for i in range(k + 1, 6):
            if abs(A[i, k]) > top:
                top, row = abs(A[i, k]), i
        pivot[k] = row
        if row != k:
            for j in range(6):
                t = A[k, j]
                A[k, j] = A[row, j]
                A[row, j] = t
        if not top > _LEAST:
            A[k, k] = _LEAST if A[k, k] >= 0.0 else -_LEAST
        inverse = 1.0 / A[k, k]
        for i in range(k + 1, 6):
            m = A[i, k] * inverse
            A[i, k] = m
            for j in range(k + 1, 6):
                A[i, j] -= m * A[k, j]


@kernel
def _solve_diagonal(A, pivot, x):
    """X <- A^-1 x."""
    for k in range(6):
        row = pivot[k]
        if row != k:
            t = x[k]
            x[k] = x[row]
            x[row] = t
    for k in range(6):
        for i in range(k + 1, 6):
            x[i] -= A[i, k] * x[k]
    for k in range(5, -1, -1):
        x[k] /= A[k, k]
        for i in range(k):
            x[i] -= A[i, k] * x[k]


@kernel
def _divide(X, A, pivot):
    """X <- X A^-1, row by row."""
    for r in range(6):
        x = X[r]
        for k in range(6):  # times U^-1
            x[k] /= A[k, k]
            for j in range(k + 1, 6):
                x[j] -= x[k] * A[k, j]
        for k in range(5, -1, -1):  # times L^-1, then the exchanges
            for j in range(k):
                x[j] -= x[k] * A[k, j]
        for k in range(5, -1, -1):
            row = pivot[k]
            if row != k:
                t = x[k]
                x[k] = x[row]
                x[row] = t


@kernel
def _subtract_product(S, X, Y):
    """S <- S - X Y."""
    for i in range(6):
        for k in range(6):
            t = X[i, k]
            for j in range(6):
                S[i, j] -= t * Y[k, j]


@kernel
def _subtract_image(y, A, x):
    """Y <- y - A x."""
    for i in range(6):
        s = 0.0
        for j in range(6):
            s += A[i, j] * x[j]
        y[i] -= s
