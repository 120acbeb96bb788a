"""Block LU on the graph of bodies; rows are exchanged only inside the diagonal blocks, which are 6x6."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.friction.six import factor, substitute
from carom.friction.thresholds import LEAST_PIVOT


@kernel
def begin_blocks(work):
    """Write the unit matrix."""
    for b in range(work.block.shape[0]):
        one = 1.0 if b < work.body.shape[0] else 0.0
        A = work.block[b]
        for i in range(6):
            for j in range(6):
                A[i, j] = one if i == j else 0.0


@kernel
def factor_blocks(work):
    """Factor in place: U right of the diagonal, below it L with unit diagonal blocks."""
    block, target = work.block, work.target
    right = work.body.shape[0]
    below = right + work.later.shape[0]
    for n in range(work.place.shape[0]):
        place = work.place[n]
        diagonal, pivot = block[place.body], work.body[place.body].pivot
        factor(diagonal, pivot, LEAST_PIVOT)
        for s in range(place.pair, place.pairs_end):
            _divide(block[below + s], diagonal, pivot)
        for t in range(place.update, place.updates_end):
            _subtract_product(
                block[target[t, 2]], block[below + target[t, 0]], block[right + target[t, 1]]
            )


@kernel
def substitute_blocks(work):
    """Solve with the factors: replace the motion of the bodies by the solution."""
    block, later = work.block, work.later
    right = work.body.shape[0]
    below = right + later.shape[0]
    for n in range(work.place.shape[0]):
        place = work.place[n]
        y = work.body[place.body].motion
        for s in range(place.pair, place.pairs_end):
            _subtract_image(work.body[later[s]].motion, block[below + s], y)
    for n in range(work.place.shape[0] - 1, -1, -1):
        place = work.place[n]
        body = work.body[place.body]
        for s in range(place.pair, place.pairs_end):
            _subtract_image(body.motion, block[right + s], work.body[later[s]].motion)
        substitute(block[place.body], body.pivot, body.motion)


@kernel
def _divide(X, A, pivot):
    """Replace X by X A^-1, row by row."""
    for r in range(6):
        x = X[r]
        for k in range(6):  # multiply by U^-1
            x[k] /= A[k, k]
            for j in range(k + 1, 6):
                x[j] -= x[k] * A[k, j]
        for k in range(5, -1, -1):  # multiply by L^-1, then exchange
            for j in range(k):
                x[j] -= x[k] * A[k, j]
        for k in range(5, -1, -1):
            row = pivot[k]
            x[k], x[row] = x[row], x[k]


@kernel
def _subtract_product(S, X, Y):
    """Subtract X Y from S."""
    for i in range(6):
        for k in range(6):
            t = X[i, k]
            for j in range(6):
                S[i, j] -= t * Y[k, j]


@kernel
def _subtract_image(y, A, x):
    """Subtract A x from y."""
    for i in range(6):
        s = 0.0
        for j in range(6):
            s += A[i, j] * x[j]
        y[i] -= s
