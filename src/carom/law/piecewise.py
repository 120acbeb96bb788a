"""A coefficient that depends on a speed: a polynomial in pieces of a power of this speed."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.geometry.pieces import find_piece
from carom.law.thresholds import KINK_ERROR
from carom.scene.speed_law import SLOWEST


@inlined
def any_depends_on_speed(laws):
    """Return whether a coefficient of any law depends on a speed."""
    return laws.pieces.shape[0] > 0


@inlined
def depends_on_speed(laws, number, what):
    """Return whether a coefficient of a law depends on a speed: on that of SLIP, or of APPROACH."""
    return laws.table[number].last[what] > laws.table[number].first[what]


@kernel
def value_at(laws, number, what, speed):
    """Return c_0 + c_1 s + ..., s = x - start, x = speed^exponent; beyond the pieces, that at their end."""
    one, pieces = laws.table[number], laws.pieces
    first, last = one.first[what], one.last[what]
    x = max(speed, SLOWEST) ** one.exponent[what]
    x = min(max(x, pieces[first].start), pieces[last - 1].end)
    piece, value = pieces[find_piece(pieces, first, last, x)], 0.0
    for k in range(5, -1, -1):
        value = value * (x - piece.start) + piece.c[k]
    return value


@kernel
def margin_before_kink(laws, number, what, before, after, here):
    """Return how far a law is from its next kink at the speed `here`, relative to that of the kink; 1 if none.

    The kink is the next one on the way of the speed from `before` to `after`: below 0 it has been passed. One
    at `before` is none, since a step that ends at a kink is followed by one that starts there.
    """
    one, pieces = laws.table[number], laws.pieces
    first, last, exponent = one.first[what], one.last[what], one.exponent[what]
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
