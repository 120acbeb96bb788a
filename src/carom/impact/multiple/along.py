"""A step along the series: its length, the state at its end, and the reversal of slip."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.simd import add, greatest, larger, load, multiply, same, store, subtract
from carom.impact.multiple.lanes import blocks, values
from carom.impact.multiple.layout import (
    LANES,
    NOW_P,
    NOW_U,
    ONE_OVER,
    S_AT,
    S_D,
    S_LANE,
    S_LOSS,
    S_P,
    S_U,
    S_U1,
    S_U2,
    SLIPPING,
    SLOWNESS,
    D,
)
from carom.impact.multiple.series import slips

_FARTHEST = 4.0  # longest step, in units of the time of the fastest contact
_FARTHEST_STRETCHED = 40.0
_SAMPLES = 4


@inlined
def reach(k, work, degree, stretched, tolerance):
    """Return the longest step for which the last two terms are within `tolerance`."""
    last, other = _greatest(k, work.series, degree), _greatest(k, work.series, degree - 1)
    h = math.log(_FARTHEST_STRETCHED if stretched else _FARTHEST)
    small = math.log(tolerance)
    if last > 0.0:
        h = min(h, (small - math.log(last)) / degree)
    if other > 0.0:
        h = min(h, (small - math.log(other)) / (degree - 1))
    return math.exp(h)


@kernel
def _greatest(k, S, n):
    """Return the greatest term of order `n`; those of slow slip have more weight, for its direction."""
    line, most = S.shape[2] * LANES, same(0.0)
    for b in range(blocks(k)):
        i = n * line + LANES * b
        x, y = load(S[S_U1], i), load(S[S_U2], i)
        slip = multiply(load(S[S_LANE], SLOWNESS * line + LANES * b), larger(_size(x), _size(y)))
        most = larger(most, larger(slip, larger(_size(load(S[S_U], i)), _size(load(S[S_D], i)))))
    return greatest(most)


@kernel
def _size(v):
    """Return the four |v|."""
    return larger(v, subtract(same(0.0), v))


@inlined
def move(k, work, degree, x):
    """Move to `x` on the series: set velocities, depths and impulses, and add the friction loss."""
    S, vector = work.series, work.vector
    line = S.shape[2] * LANES
    for b in range(blocks(k)):
        n = LANES * b
        for r in range(3):
            store(S[S_AT], 0, values(line, S[S_P + r], n, degree, x))
            store(S[S_AT], line, values(line, S[S_U + r], n, degree, x))
            for i in range(n, min(k, n + LANES)):
                vector[NOW_P, 3 * i + r] = S[S_AT, 0, 0, i - n]
                vector[NOW_U, 3 * i + r] = S[S_AT, 1, 0, i - n]
        store(vector[D], n, values(line, S[S_D], n, degree, x))
        if S[S_LANE, SLIPPING, b, 0] > 0.0:
            store(S[S_AT], 0, values(line, S[S_LOSS], n, degree, x))
            for i in range(n, min(k, n + LANES)):
                work.contact[i].loss += S[S_AT, 0, 0, i - n]


@inlined
def first_turn(k, work, degree, end):
    """Return the first x in [0, end] where slip has turned by a right angle, or 2 end.

    When slip along a line passes through u_t = 0, the series do not show it, and continue with friction of the
    wrong sign.
    """
    S, first, keeps_on = work.series, 2.0 * end, False
    for i in range(k):
        if i % LANES == 0:
            keeps_on = _keeps_on(S, i, degree, end)
        if keeps_on or not slips(work.contact[i]):
            continue
        low = 0.0
        for s in range(_SAMPLES):
            high = end * ((s + 1) / _SAMPLES)
            if _along(S, i, degree, high) <= 0.0:
                high = _turn_between(S, i, degree, low, high, 1e-15 * end)
                first = min(first, high)
                end = min(end, high)
                break
            low = high
    return first


@kernel
def _turn_between(S, i, degree, low, high, tolerance):
    """Return the x between `low` and `high` where slip has turned by a right angle, by bisection."""
    for _ in range(60):
        x = 0.5 * (low + high)
        if _along(S, i, degree, x) > 0.0:
            low = x
        else:
            high = x
        if high - low <= tolerance:
            break
    return high


@kernel
def _keeps_on(S, p, degree, end):
    """Return whether all terms together are too small to turn the slip of the block at `p` by a right angle."""
    u1, u2, line, f = S[S_U1], S[S_U2], S.shape[2] * LANES, same(end)
    x, y, s = load(u1, p), load(u2, p), same(0.0)
    for j in range(degree, 0, -1):
        turn = add(multiply(x, load(u1, j * line + p)), multiply(y, load(u2, j * line + p)))
        s = multiply(add(s, _size(turn)), f)
    left = subtract(s, add(multiply(x, x), multiply(y, y)))
    return greatest(multiply(left, load(S[S_LANE], ONE_OVER * line + p))) <= 0.0


@kernel
def _along(S, i, degree, x):
    """Return the component of the slip of contact `i` at `x` along its slip at the start."""
    b, l = i // LANES, i % LANES
    p, q = S[S_U1, degree, b, l], S[S_U2, degree, b, l]
    for j in range(degree - 1, -1, -1):
        p = p * x + S[S_U1, j, b, l]
        q = q * x + S[S_U2, j, b, l]
    return p * S[S_U1, 0, b, l] + q * S[S_U2, 0, b, l]
