"""Steps through the layers of a group, until its impact ends: by series for linear forces, otherwise by stages.

So are those of contacts whose friction depends on the slip.

A step by series is cut at the first change of mode, at the end of stick, or where slip reverses.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.lanes import blocks, value_and_slope, values
from carom._compiled.simd import LANES, add, greatest, larger, load, multiply, same, store, subtract
from carom._compiled.units import unit
from carom.geometry.thresholds import LAST_DIGIT, ROUND_OFF
from carom.impact import thresholds as limits
from carom.impact.multiple import normal_law as law
from carom.impact.multiple import series as taylor
from carom.impact.multiple.friction import gather_stuck, halt
from carom.impact.multiple.layer import branch, drift, set_velocity, wedged
from carom.impact.multiple.stages import by_stages

ENDED, TRAPPED = 0, 1
_STIFF_STEPS = 2  # steps by stages before series are tried again
_FEWER = 2  # orders of the series that are left out if it reaches a change of mode without them
_SAMPLES = 5


@unit
def pass_layer(k, work, settings, rtol, later) -> int:
    """Continue to the end of the event; return ENDED, or TRAPPED after too many changes of mode or steps.

    The tolerance is `rtol`, and `later` once the state at the first unloading is saved.
    """
    clock, p = work.clock[0], settings.exponent
    set_velocity(k, work)
    first_events, first_steps, h = clock.events, clock.steps, 0.0
    while True:
        if drift(k, work, max(ROUND_OFF, limits.DRIFT_SHARE * rtol), p) == 1 or wedged(
            k, work, h, p
        ):
            set_velocity(k, work)
            return ENDED
        if (
            clock.events - first_events > settings.max_events * k
            or clock.steps - first_steps > settings.max_steps * k
            or clock.steps > clock.left
            or not clock.step > 0.0
        ):
            return TRAPPED
        h, changes = -1.0, False
        if p == 1.0 and clock.stiff == 0 and not settings.by_slip:
            h, changes = series_step(k, work, rtol)
        if h < 0.0:
            # as accurate as series
            fine = max(0.1 * rtol, min(rtol, limits.STAGE_ACCURACY)) if p == 1.0 else rtol
            h, changes = by_stages(k, work, fine, settings)
            clock.stiff = clock.stiff - 1 if clock.stiff > 0 else _STIFF_STEPS - 1
        if changes:
            latest = h + limits.INSTANT
            clock.idle = clock.idle + 1 if h <= limits.INSTANT else 0
            if clock.branched == 0 and law.would_unload(k, work, latest):
                branch(k, work, latest)
                rtol = later
            law.change_modes(k, work, latest, p, clock.idle > 2 * k)
            clock.events += 1


@inlined
def series_step(k, work, rtol):
    """Take a step by series, cut at the first change of mode; return its length and whether a mode changes.

    The length is -1 if the step has to be taken by stages.
    """
    clock, u = work.clock[0], work.now.velocity
    least = max(limits.SLIP_END, 0.1 * rtol)
    captured = False
    for i in range(k):
        c = work.contact[i]
        if taylor.slips(c) and math.sqrt(u[3 * i + 1] ** 2 + u[3 * i + 2] ** 2) <= least:
            c.sticks = 1
            captured = True
    if captured:
        for i in range(k):
            c = work.contact[i]
            if taylor.slips(c) and math.sqrt(u[3 * i + 1] ** 2 + u[3 * i + 2] ** 2) <= 10.0 * least:
                c.sticks = 1
    z = gather_stuck(k, work)
    if z > 0:
        halt(k, z, work)
    stretched = taylor.stretch_weights(k, work)
    closed = taylor.begin(k, work, stretched)
    clock.stretched = 1 if stretched else 0
    clock.steps += 1
    most = taylor.degree_for(rtol)
    known, degree, h = 0, most - _FEWER, 0.0
    while True:  # only as many orders as the next change of mode needs
        taylor.expand(k, z, closed, work, known, degree)
        if known == 0 and stretched and _stiff(k, work):
            return -1.0, False
        known = degree
        share = limits.SERIES_SHARE if degree < most else 0.1
        h = reach(k, work, degree, stretched, share * rtol)
        if degree == most or law.any_change(k, work, degree, h):
            break
        degree = most
    first = law.find_changes(k, work, degree, h)
    changes, end = first <= h, min(first, h)
    slip = first_slip(z, work, degree, end)
    if slip < end:
        # only one more series step shares the forces anew
        if slip <= limits.SHORTEST_PART or clock.cut == 1:
            clock.cut = 0
            return -1.0, False
        clock.cut, changes, end = 1, False, slip
    else:
        clock.cut = 0
        turn = first_turn(k, work, degree, end)
        if turn < end:
            changes, end = False, turn
    move(k, work, degree, end)
    return end, changes


@kernel
def _stiff(k, work):
    """Return whether a contact slips so slowly that its direction is stiff, without coming to rest.

    With r = |u_t| and c the rate at which friction changes u_t, the direction relaxes in a time r/c.
    """
    S = work.series
    for i in range(k):
        contact = work.contact[i]
        if not taylor.slips(contact):
            continue
        b, l = i // LANES, i % LANES
        x, y = S.u[1, 0, b, l], S.u[2, 0, b, l]
        r2 = x * x + y * y
        c = contact.braking
        if c * c > limits.STIFFNESS * limits.STIFFNESS * r2:
            growth = (x * S.u[1, 1, b, l] + y * S.u[2, 1, b, l]) / S.sigma[0, 0, 0]
            if growth > -0.1 * c * math.sqrt(r2):
                return True
    return False


@inlined
def reach(k, work, degree, stretched, tolerance):
    """Return the longest step for which the last two terms are within `tolerance`."""
    last, other = _greatest(k, work.series, degree), _greatest(k, work.series, degree - 1)
    h = math.log(limits.STRETCHED_STEP if stretched else limits.LONGEST_STEP)
    small = math.log(tolerance)
    if last > 0.0:
        h = min(h, (small - math.log(last)) / degree)
    if other > 0.0:
        h = min(h, (small - math.log(other)) / (degree - 1))
    return math.exp(h)


@kernel
def _greatest(k, S, n):
    """Return the greatest term of order `n`; those of slow slip have more weight, for its direction."""
    line, most = S.depth.shape[1] * LANES, same(0.0)
    for b in range(blocks(k)):
        i = n * line + LANES * b
        x, y = load(S.u[1], i), load(S.u[2], i)
        slip = multiply(load(S.slowness, LANES * b), larger(_size(x), _size(y)))
        most = larger(most, larger(slip, larger(_size(load(S.u[0], i)), _size(load(S.depth, i)))))
    return greatest(most)


@kernel
def _size(v):
    """Return the four |v|."""
    return larger(v, subtract(same(0.0), v))


@inlined
def move(k, work, degree, x):
    """Move to `x` on the series: set velocities, depths and impulses, and add the friction loss."""
    S, line = work.series, work.series.depth.shape[1] * LANES
    for b in range(blocks(k)):
        n = LANES * b
        for r in range(3):
            store(S.end, 0, values(line, S.P[r], n, degree, x))
            store(S.end, LANES, values(line, S.u[r], n, degree, x))
            for i in range(n, min(k, n + LANES)):
                work.now.impulse[3 * i + r] = S.end[0, i - n]
                work.now.velocity[3 * i + r] = S.end[1, i - n]
        store(work.now.depth, n, values(line, S.depth, n, degree, x))
        if S.slipping[b, 0] > 0.0:
            store(S.end, 0, values(line, S.loss, n, degree, x))
            for i in range(n, min(k, n + LANES)):
                work.contact[i].loss += S.end[0, i - n]


@inlined
def first_slip(z, work, degree, end):
    """Return the first x in [0, end] where one of `z` contacts can no longer stick, or 2 end."""
    first = 2.0 * end
    for b in range(z):
        x = _first_end(work, work.stuck[b], True, degree, min(end, first))
        first = min(first, x)
    return first


@inlined
def first_turn(k, work, degree, end):
    """Return the first x in [0, end] where slip has turned by a right angle, or 2 end.

    When slip along a line passes through u_t = 0, the series do not show it, and continue with friction of the
    wrong sign.
    """
    first, keeps_on = 2.0 * end, False
    for i in range(k):
        if i % LANES == 0:
            keeps_on = _keeps_on(work.series, i, degree, min(end, first))
        if not keeps_on and taylor.slips(work.contact[i]):
            first = min(first, _first_end(work, i, False, degree, min(end, first)))
    return first


@kernel
def _first_end(work, i, sticks, degree, end):
    """Return where in [0, end] contact `i` ceases to stick, or else its slip has turned, or infinity."""
    low = 0.0
    for s in range(_SAMPLES):
        high = end * ((s + 1) / _SAMPLES)
        if _has_ended(work, i, sticks, degree, high):
            for _ in range(60):
                x = 0.5 * (low + high)
                if _has_ended(work, i, sticks, degree, x):
                    high = x
                else:
                    low = x
                if high - low <= LAST_DIGIT * end:
                    break
            return low if sticks else high
        low = high
    return math.inf


@kernel
def _has_ended(work, i, sticks, degree, x):
    """Return whether contact `i` has ceased to stick at `x`, or else its slip has turned by a right angle."""
    if sticks:
        return _excess(work.contact[i], i, work.series, degree, x) > 0.0
    S, b, l = work.series, i // LANES, i % LANES
    u1, _ = value_and_slope(S.u[1], i, degree, x)
    u2, _ = value_and_slope(S.u[2], i, degree, x)
    return u1 * S.u[1, 0, b, l] + u2 * S.u[2, 0, b, l] <= 0.0


@kernel
def _excess(c, i, S, degree, x):
    """Return |T|^2 - (mu N)^2 of a sticking contact, from the derivative of its impulse at `x`."""
    n, t1, t2 = 0.0, 0.0, 0.0
    b, l = i // LANES, i % LANES
    for j in range(degree, 0, -1):
        n = n * x + j * S.P[0, j, b, l]
        t1 = t1 * x + j * S.P[1, j, b, l]
        t2 = t2 * x + j * S.P[2, j, b, l]
    room = c.mu * max(0.0, n)
    return t1 * t1 + t2 * t2 - room * room * (1.0 + limits.CONE_MARGIN) - limits.CONE_FLOOR


@kernel
def _keeps_on(S, p, degree, end):
    """Return whether all terms together are too small to turn the slip of the block at `p` by a right angle."""
    u1, u2, line, f = S.u[1], S.u[2], S.depth.shape[1] * LANES, same(end)
    x, y, s = load(u1, p), load(u2, p), same(0.0)
    for j in range(degree, 0, -1):
        turn = add(multiply(x, load(u1, j * line + p)), multiply(y, load(u2, j * line + p)))
        s = multiply(add(s, _size(turn)), f)
    left = subtract(s, add(multiply(x, x), multiply(y, y)))
    return greatest(multiply(left, load(S.over, p))) <= 0.0
