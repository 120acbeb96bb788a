"""Changes of mode of the normal law within a step, on the polynomials of depth and normal velocity."""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom._compiled.simd import store
from carom.impact.multiple import law
from carom.impact.multiple.lanes import blocks, value_and_slope, values
from carom.impact.multiple.layout import AT_D, AT_U, LANES, NOW_P, S_AT, S_D, S_U, D

ROUND_OFF = 1e-13  # relative to the scales of velocity and depth
SAME_TIME = 1e-10  # changes closer than this in time are simultaneous
_EVENT_SAMPLES = 5


@kernel
def gauge(c, d, u_n):
    """Return a number that becomes positive where contact `c` changes its mode."""
    if c.mode == law.OPEN:
        return d - c.d0
    if c.mode == law.LOAD:
        return u_n
    return max(c.rest - d, d - c.d0 - c.most)


@inlined
def evaluate(k, series, degree, x):
    """Write depths and normal velocities at x."""
    at, line = series[S_AT], series.shape[2] * LANES
    for b in range(blocks(k)):
        p = LANES * b
        store(at, AT_D * line + p, values(line, series[S_D], p, degree, x))
        store(at, AT_U * line + p, values(line, series[S_U], p, degree, x))


@inlined
def any_change(k, work, degree, x):
    """Return whether a contact has changed its mode at x."""
    evaluate(k, work.series, degree, x)
    d, u = work.series[S_AT, AT_D], work.series[S_AT, AT_U]
    for i in range(k):
        b, l = i // LANES, i % LANES
        if gauge(work.contact[i], d[b, l], u[b, l]) > ROUND_OFF:
            return True
    return False


@inlined
def find_changes(k, work, degree, end, when):
    """Write the time of the first change of each contact in [0, end] to `when`, 2 end if there is none.

    Return the earliest; changes after the sample next to it are not sought.
    """
    first, a = 2.0 * end, 0.0
    d, u = work.series[S_AT, AT_D], work.series[S_AT, AT_U]
    for i in range(k):
        when[i] = first
    for s in range(_EVENT_SAMPLES):
        x = end if s == _EVENT_SAMPLES - 1 else end * ((s + 1) / _EVENT_SAMPLES)
        if any_change(k, work, degree, x):
            for i in range(k):
                c, b, l = work.contact[i], i // LANES, i % LANES
                if gauge(c, d[b, l], u[b, l]) > ROUND_OFF:
                    over = c.rest - d[b, l] > d[b, l] - c.d0 - c.most
                    when[i] = _root(c, i, over, work.series, degree, a, x)
                    first = min(first, when[i])
            break
        a = x
    return first


@kernel
def _gauge_and_slope(c, i, over, series, degree, x):
    """Return the gauge of contact `i` at x minus round-off, and its derivative.

    `over` says that a contact in unloading opens, and does not load again.
    """
    if c.mode == law.LOAD:
        s, slope = value_and_slope(series[S_U], i, degree, x)
        return s - ROUND_OFF, slope
    s, slope = value_and_slope(series[S_D], i, degree, x)
    if c.mode == law.OPEN:
        return s - c.d0 - ROUND_OFF, slope
    if over:
        return c.rest - s - ROUND_OFF, -slope
    return s - c.d0 - c.most - ROUND_OFF, slope


@kernel
def _root(c, i, over, series, degree, a, b):
    """Return where the gauge exceeds round-off between a and b: Newton's iteration with bisection."""
    g, _ = _gauge_and_slope(c, i, over, series, degree, a)
    if g >= 0.0:
        return a
    x, width = b, b - a
    for _ in range(90):
        g, slope = _gauge_and_slope(c, i, over, series, degree, x)
        if abs(g) <= 1e-3 * ROUND_OFF:
            return x
        if g > 0.0:
            b = x
        else:
            a = x
        if not b - a > 1e-15 * width:
            break
        new = x - g / slope
        if not a < new < b:
            new = 0.5 * (a + b)
            if not a < new < b:
                break
        elif abs(new - x) <= 1e-16 * width:
            return new
        x = new
    return b


@kernel
def change_modes(k, work, when, latest, p, one_only):
    """Change the mode of each contact with ``when <= latest``, or of one only; return their number."""
    count = 0
    for i in range(k):
        if not when[i] <= latest:
            continue
        c = work.contact[i]
        d, p_n = work.vector[D, i], work.vector[NOW_P, 3 * i]
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
