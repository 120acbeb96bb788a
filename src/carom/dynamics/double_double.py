"""Double-double arithmetic: a number as an unevaluated sum high + low, of some 31 digits.

Sums and products of two doubles, together with their round-off, are exact (Knuth 1969; Dekker 1971). The
operations built from them have errors of a few 1e-32 of the larger operand.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel

SPLITTER = 134217729.0  # 2^27 + 1


@kernel
def add(ah, al, bh, bl):
    """Return a + b."""
    s = ah + bh
    t = s - ah
    e = ((ah - (s - t)) + (bh - t)) + (al + bl)
    h = s + e
    return h, e - (h - s)


@kernel
def add_product(sh, sl, a, b):
    """Return s + a b for doubles a and b."""
    p = a * b
    t = SPLITTER * a
    u = t - (t - a)
    v = a - u
    t = SPLITTER * b
    x = t - (t - b)
    y = b - x
    return add(sh, sl, p, ((u * x - p) + u * y + v * x) + v * y)


@kernel
def multiply(ah, al, bh, bl):
    """Return a b."""
    h, low = add_product(0.0, 0.0, ah, bh)
    low += ah * bl + al * bh
    s = h + low
    return s, low - (s - h)


@kernel
def subtract_product(sh, sl, ah, al, bh, bl):
    """Return s - a b."""
    h, low = multiply(ah, al, bh, bl)
    return add(sh, sl, -h, -low)


@kernel
def inverse_root(ah, al):
    """Return 1/sqrt(a), by one step of Newton's method from the result for a double."""
    x = 1.0 / math.sqrt(ah)
    sh, sl = multiply(ah, al, x, 0.0)
    rh, rl = subtract_product(1.0, 0.0, sh, sl, x, 0.0)
    return add(x, 0.0, 0.5 * x * rh, 0.5 * x * rl)
