"""Changes of mode of the normal law within a step, on the polynomials of depth and normal velocity."""

from __future__ import annotations

from carom.impact.corner import law
from carom.impact.corner.layout import D, P
from carom.jit import kernel

ROUND_OFF = 1e-13  # of the scales of velocity and depth
TOGETHER = 1e-10  # changes closer than this in time are one
_SAMPLES = 5


@kernel
def value(series, column, degree, x):
    """Return the polynomial of a column of `series` at x."""
    v = series[degree, column]
    for j in range(degree - 1, -1, -1):
        v = v * x + series[j, column]
    return v


@kernel
def gauge(c, i, depth, velocity, degree, x):
    """Return what turns positive where contact `c`, number `i`, changes its mode."""
    if c.mode == law.OPEN:
        return value(depth, i, degree, x) - c.d0
    if c.mode == law.LOAD:
        return value(velocity, 3 * i, degree - 1, x)
    d = value(depth, i, degree, x)
    return max(c.rest - d, d - c.d0 - c.most)


@kernel
def first_change(c, i, depth, velocity, degree, end):
    """Return the first x in [0, end] where contact `c` changes its mode, or a number beyond `end`."""
    a = 0.0
    for s in range(_SAMPLES):
        b = end if s == _SAMPLES - 1 else end * ((s + 1) / _SAMPLES)
        gb = gauge(c, i, depth, velocity, degree, b)
        if gb > ROUND_OFF:
            return _root(c, i, depth, velocity, degree, a, b, gb)
        a = b
    return 2.0 * end


@kernel
def _root(c, i, depth, velocity, degree, a, b, gb):
    """Return where the gauge passes round-off between a and b: Illinois, each third time a bisection."""
    ga = gauge(c, i, depth, velocity, degree, a) - ROUND_OFF
    if ga >= 0.0:
        return a
    gb -= ROUND_OFF
    side, width = 0, b - a
    for turn in range(90):
        if b - a <= 1e-15 * width:
            break
        x = (a * gb - b * ga) / (gb - ga)
        if turn % 3 == 2 or not a < x < b:
            x = 0.5 * (a + b)
            if not a < x < b:
                break
        g = gauge(c, i, depth, velocity, degree, x) - ROUND_OFF
        if g > 0.0:
            b, gb = x, g
            if side == 1:
                ga *= 0.5
            side = 1
        else:
            a, ga = x, g
            if side == -1:
                gb *= 0.5
            side = -1
        if abs(g) <= 1e-3 * ROUND_OFF:
            return x
    return b


@kernel
def find_changes(k, contact, depth, velocity, degree, end, when):
    """Write the first change of each contact to `when`; return the first of all."""
    first = 2.0 * end
    for i in range(k):
        when[i] = first_change(contact[i], i, depth, velocity, degree, end)
        first = min(first, when[i])
        if first < end:
            end = first + TOGETHER
    return first


@kernel
def change_modes(k, work, when, latest, p, one_only):
    """Change the mode of each contact with ``when <= latest``; return their number."""
    count = 0
    for i in range(k):
        if not when[i] <= latest:
            continue
        c = work.contact[i]
        d, p_n = work.vector[D, i], work.vector[P, 3 * i]
        count += 1
        if c.mode == law.OPEN:
            law.close(c)
        elif c.mode == law.LOAD:
            if d - c.d0 > ROUND_OFF:
                law.unload(c, d, p_n)
            else:
                law.release(c, d, p_n, p)
        elif c.rest - d > d - c.d0 - c.most:
            law.release(c, d, p_n, p)
        else:
            law.load_again(c, p_n)
        if one_only:
            break
    return count


@kernel
def would_unload(k, work, when, latest):
    """Return whether one of the contacts with ``when <= latest`` ends its loading."""
    for i in range(k):
        c = work.contact[i]
        if when[i] <= latest and c.mode == law.LOAD and work.vector[D, i] - c.d0 > ROUND_OFF:
            return True
    return False
