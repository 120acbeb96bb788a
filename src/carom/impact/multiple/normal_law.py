"""The normal law of a contact in the layer: continuous, hysteretic, energetic (mathematics page, §2.2).

N depends on the depth d = -s in the logarithmic coordinate and on a memory (d0, dm), which opening resets:

    open    N = 0                       until d > d0, the depth at the last opening
    load    N = kappa (d - d0)^p        until u_n > 0; then dm = d - d0
    unload  N = kappa dm^p ((d - d0 - (1 - e^2) dm) / (e^2 dm))^p      until N = 0, or d - d0 > dm

The work returned is e^2 times the work of loading for every p and any friction, which is Stronge's law. N is
continuous everywhere. The constant forces of a single contact (law A) are not, and do not exist for a contact
that touches at rest.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.lanes import blocks, value_and_slope, values
from carom._compiled.simd import LANES, store
from carom.geometry.thresholds import LAST_DIGIT, NO_CHANGE
from carom.impact.multiple import layout as o
from carom.impact.thresholds import GAUGE_SHARE, IMPACT_ERROR, VELOCITY_LEFT

OPEN, LOAD, UNLOAD = 0, 1, 2
_EVENT_SAMPLES = 5


@kernel
def force(c, d, p):
    """Return N of the contact `c` at depth `d`."""
    if c.mode == OPEN:
        return 0.0
    x = c.slope * (d - c.rest)
    if not x > 0.0:
        return 0.0
    return x if p == 1.0 else x**p


@kernel
def close(c):
    """Begin to load, from the depth at the last opening."""
    c.mode = LOAD
    c.slope, c.rest = c.root, c.d0


@kernel
def unload(c, d, p_n):
    """Begin to unload at depth `d`; `p_n` is the normal impulse so far."""
    c.mode = UNLOAD
    c.most = d - c.d0
    c.rest = c.d0 + (1.0 - c.e * c.e) * c.most
    c.slope = c.root / (c.e * c.e)
    c.loading += p_n - c.mark
    c.mark = p_n


@kernel
def load_again(c, p_n):
    """Load again, on the same curve as before."""
    close(c)
    c.unloading += p_n - c.mark
    c.mark = p_n


@kernel
def release(c, d, p_n, p):
    """Open at depth `d`: the impact of this contact ends, and its works are added."""
    if c.mode == UNLOAD:
        c.unloading += p_n - c.mark
        work = (c.root * c.most) ** p * c.most / (p + 1.0)
        c.absorbed += work
        c.returned += c.e * c.e * work
    else:
        c.loading += p_n - c.mark
    c.mark = p_n
    c.mode = OPEN
    c.d0 = d
    c.slope = 0.0


@kernel
def note_stick(i, work):
    """Mark a contact that has opened without slip: what its tangential restitution needs."""
    u, c = work.now.velocity, work.contact[i]
    if c.mode == OPEN and math.hypot(u[3 * i + 1], u[3 * i + 2]) <= VELOCITY_LEFT:
        c.sticks |= o.HAS_STUCK


@kernel
def abandon(c, d, p):
    """Open a contact before the end of its impact, at depth `d`: add its works; stored energy is lost."""
    if c.mode == OPEN:
        return
    depth = d - c.d0 if c.mode == LOAD else c.most
    if depth > 0.0:
        work = (c.root * depth) ** p * depth / (p + 1.0)
        c.absorbed += work
        if c.mode == UNLOAD:
            left = max(0.0, d - c.rest)
            c.returned += max(0.0, c.e * c.e * work - (c.slope * left) ** p * left / (p + 1.0))
    c.mode = OPEN
    c.d0 = d
    c.slope = 0.0


@kernel
def gauge(c, d, u_n):
    """Return a number that becomes positive where contact `c` changes its mode."""
    if c.mode == OPEN:
        return d - c.d0
    if c.mode == LOAD:
        return u_n
    return max(c.rest - d, d - c.d0 - c.most)


@inlined
def evaluate(k, series, degree, x):
    """Write depths and normal velocities at x."""
    line = series.depth.shape[1] * LANES
    for b in range(blocks(k)):
        p = LANES * b
        store(series.at_depth, p, values(line, series.depth, p, degree, x))
        store(series.at_u, p, values(line, series.u[0], p, degree, x))


@inlined
def any_change(k, work, degree, x):
    """Return whether a contact has changed its mode at x."""
    evaluate(k, work.series, degree, x)
    d, u = work.series.at_depth, work.series.at_u
    for i in range(k):
        b, l = i // LANES, i % LANES
        if gauge(work.contact[i], d[b, l], u[b, l]) > IMPACT_ERROR:
            return True
    return False


@inlined
def find_changes(k, work, degree, end):
    """Write the time of the first change of each contact in [0, end], 2 end if there is none.

    Return the earliest; changes after the sample next to it are not sought.
    """
    first, a = 2.0 * end, 0.0
    d, u = work.series.at_depth, work.series.at_u
    for i in range(k):
        work.contact[i].when = first
    for s in range(_EVENT_SAMPLES):
        x = end if s == _EVENT_SAMPLES - 1 else end * ((s + 1) / _EVENT_SAMPLES)
        if any_change(k, work, degree, x):
            for i in range(k):
                c, b, l = work.contact[i], i // LANES, i % LANES
                if gauge(c, d[b, l], u[b, l]) > IMPACT_ERROR:
                    c.when = _root(work, i, degree, a, x)
                    first = min(first, c.when)
            break
        a = x
    return first


@kernel
def _gauge_and_slope(c, i, over, series, degree, x):
    """Return the gauge of contact `i` at x minus round-off, and its derivative.

    With `over` a contact in unloading opens, and does not load again.
    """
    if c.mode == LOAD:
        s, slope = value_and_slope(series.u[0], i, degree, x)
        return s - IMPACT_ERROR, slope
    s, slope = value_and_slope(series.depth, i, degree, x)
    if c.mode == OPEN:
        return s - c.d0 - IMPACT_ERROR, slope
    if over:
        return c.rest - s - IMPACT_ERROR, -slope
    return s - c.d0 - c.most - IMPACT_ERROR, slope


@kernel
def _root(work, i, degree, a, b):
    """Return where the gauge of contact `i` exceeds round-off between a and b, at which `evaluate` was.

    By Newton's iteration with bisection.
    """
    c, series = work.contact[i], work.series
    d = series.at_depth[i // LANES, i % LANES]
    over = c.rest - d > d - c.d0 - c.most
    g, _ = _gauge_and_slope(c, i, over, series, degree, a)
    if g >= 0.0:
        return a
    x, width = b, b - a
    for _ in range(90):
        g, slope = _gauge_and_slope(c, i, over, series, degree, x)
        if abs(g) <= GAUGE_SHARE * IMPACT_ERROR:
            return x
        if g > 0.0:
            b = x
        else:
            a = x
        if not b - a > LAST_DIGIT * width:
            break
        new = x - g / slope
        if not a < new < b:
            new = 0.5 * (a + b)
            if not a < new < b:
                break
        elif abs(new - x) <= NO_CHANGE * width:
            return new
        x = new
    return b


@kernel
def change_modes(k, work, latest, p, one_only):
    """Change the mode of each contact whose time is at most `latest`, or of one only; return their number."""
    count = 0
    for i in range(k):
        c = work.contact[i]
        if not c.when <= latest:
            continue
        d, p_n = work.now.depth[i], work.now.impulse[3 * i]
        count += 1
        if c.mode == OPEN:
            close(c)
            c.sticks &= ~o.HAS_STUCK
        elif c.mode == LOAD:
            if d - c.d0 > IMPACT_ERROR:
                unload(c, d, p_n)
            else:
                release(c, d, p_n, p)
        elif c.rest - d > d - c.d0 - c.most:
            release(c, d, p_n, p)
        else:
            load_again(c, p_n)
        note_stick(i, work)
        if one_only:
            break
    return count


@kernel
def would_unload(k, work, latest):
    """Return whether one of the contacts whose time is at most `latest` ends its loading."""
    for i in range(k):
        c = work.contact[i]
        if c.when <= latest and c.mode == LOAD and work.now.depth[i] - c.d0 > IMPACT_ERROR:
            return True
    return False
