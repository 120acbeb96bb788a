"""Piecewise polynomials: prescribed motions over time, and springs with a characteristic curve."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.geometry.pieces import find_piece


@kernel
def curve(pieces, first, last, t):
    """Return value, first and second derivative at t."""
    piece = pieces[find_piece(pieces, first, last, t)]
    s, c = t - piece.start, piece.c
    f, d, e = c[5], 0.0, 0.0
    for k in range(4, -1, -1):
        e = e * s + 2.0 * d
        d = d * s + f
        f = f * s + c[k]
    return f, d, e
