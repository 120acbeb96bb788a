"""The piece of a function in pieces, in order of their starts."""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def find_piece(pieces, first, last, t):
    """Return the piece that contains t; outside all pieces, the first or the last."""
    low, high = first, last - 1
    while low < high:
        middle = (low + high + 1) // 2
        if pieces[middle].start <= t:
            low = middle
        else:
            high = middle - 1
    return low
