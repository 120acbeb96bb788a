"""Piecewise polynomials: prescribed motions over time, and springs with a characteristic curve."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.kinematics.curve import find_piece
from carom.scene.speed_law import SLOWEST


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


@kernel
def value_at(pieces, law, speed):
    """Return c_0 + c_1 s + ..., s = x - start, x = speed^exponent; beyond the pieces, that at their end.

    `law` has the first piece, that after the last, and the exponent.
    """
    first, last, exponent = law
    x = max(speed, SLOWEST) ** exponent
    x = min(max(x, pieces[first].start), pieces[last - 1].end)
    piece, value = pieces[find_piece(pieces, first, last, x)], 0.0
    for k in range(5, -1, -1):
        value = value * (x - piece.start) + piece.c[k]
    return value
