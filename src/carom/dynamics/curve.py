"""Piecewise polynomials: prescribed motions over time, and springs with a characteristic curve."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.thresholds import KINK_ERROR
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


@kernel
def margin_before_kink(pieces, law, before, after, here):
    """Return how far a law is from its next kink at the speed `here`, relative to that of the kink; 1 if none.

    The kink is the next one on the way of the speed from `before` to `after`: below 0 it has been passed. One
    at `before` is none, since a step that ends at a kink is followed by one that starts there.
    """
    first, last, exponent = law
    x, end = max(before, SLOWEST) ** exponent, max(after, SLOWEST) ** exponent
    sign = 1 if end > x else -1
    i, kink = find_piece(pieces, first, last, x), sign * math.inf
    for _ in range(2):
        for side in range(2):
            k = pieces[i].kinks[side if sign > 0 else 1 - side]
            if sign * (k - x) > 2.0 * KINK_ERROR * x and sign * (kink - k) > 0.0:
                kink = k
        i = min(max(i + sign, first), last - 1)
    if not (0.0 < kink < math.inf):
        return 1.0
    return sign * (kink - max(here, SLOWEST) ** exponent) / kink
