"""One phase of the layer, compression or restitution, as a sequence of spline steps.

If the normal acceleration is given (`accel` > 0, law A), steps are in the time of the layer. Otherwise
(`accel` = 0) they are in the normal impulse, and the restitution law gives the end.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from carom._compiled.decorators import kernel
from carom.friction.rays import solve_tangential
from carom.geometry.thresholds import LAST_UNITS, ROUND_OFF
from carom.impact.spline import Step, force, quadratures, slip_ratio, solve_slip
from carom.impact.thresholds import SHORTEST_PART
from carom.law import impact_laws

# Columns of `history`, one row for each knot: time, s, velocity, tangential displacement, force after the knot.
COLUMNS = 10

NO_LAW = -1  #: in place of a law: the length of the phase is known

_MAX_STEPS = 10000  # in a phase, beyond the requested number


class Span(NamedTuple):
    """A phase to integrate, which its length ends or, in the normal impulse, a law."""

    start: tuple  # (u_1, u_2, u_n)
    steps: int  # of equal length
    length: float  # a first guess if a law ends the phase
    split: float  # where slip ends, -1 if nowhere
    law: int  # or NO_LAW
    goal: float  # value of the law's measure at the end


class Friction(NamedTuple):
    """The friction ratio: that of slip, or a constant after slip has ended."""

    fixed: bool  # whether it is constant
    t1: float
    t2: float


@kernel
def ratio(contact, friction, state):
    """Return the friction ratio of a state (u_1, u_2, u_n)."""
    if friction.fixed:
        return friction.t1, friction.t2
    return slip_ratio(contact.mu, state[0], state[1])


@kernel
def write(history, row, time, state, place, load):
    """Write a knot, if there is room; return the number of the next one.

    `place` is s and the tangential displacement, `load` the normal force and the friction ratio.
    """
    if row < history.shape[0]:
        n, t1, t2 = load
        history[row, 0], history[row, 1] = time, place[0]
        history[row, 2], history[row, 3], history[row, 4] = state[2], state[0], state[1]
        history[row, 5], history[row, 6] = place[1], place[2]
        history[row, 7], history[row, 8], history[row, 9] = n, n * t1, n * t2
    return row + 1


@kernel
def run(contact, span, friction, history, row):
    """Integrate a phase; the friction ratio becomes constant where slip ends.

    Return 1 if it was solved, the state at the end, whether the friction ratio is now constant,
    the integrals (displacement n, t1, t2; impulse n, t1, t2; friction loss), and the next row.
    """
    state, total, q = span.start, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), 0.0
    shortest = SHORTEST_PART * span.length
    n, length, split = span.steps, span.length, span.split
    limit = row + n + _MAX_STEPS
    for i in range(n):
        end = length if i == n - 1 else length * ((i + 1) / n)
        while q < end:
            to_rest = (not friction.fixed) and 0.0 <= split <= end
            stop = max(split, q) if to_rest else end
            whole = stop - q
            if whole > 0.0:
                t1, t2 = ratio(contact, friction, state)
                normal, k = force(contact, t1, t2)
                if (contact.accel > 0.0 and not k > 0.0) or row > limit:
                    return 0, state, friction.fixed, total, row
                place = (total[0], total[1], total[2])
                row = write(history, row, q, state, place, (normal, t1, t2))
                ok, d, to_rest, new, gained = _advance(
                    contact, friction, state, whole, to_rest, shortest
                )
                if ok == 0:
                    return 0, state, friction.fixed, total, row
                state, total = new, _plus(total, gained)
                q = q + d if d < whole else stop
            if to_rest:
                state, total = _stopped(contact, state, total)
                friction = Friction(True, friction.t1, friction.t2)
    return 1, state, friction.fixed, total, row


@kernel
def _advance(contact, friction, state, d, to_rest, shortest):
    """Take a step of at most `d`; with `to_rest` slip is known to end with it.

    Return 1 if it was solved, its length, whether slip has ended with it, the new state and the integrals.
    """
    m, (x, y, u_n) = contact.m, state
    t1, t2 = ratio(contact, friction, state)
    normal, _ = force(contact, t1, t2)
    ax = normal * (m[1] + m[3] * t1 + m[4] * t2)
    ay = normal * (m[2] + m[4] * t1 + m[5] * t2)
    step, straight = Step((x, y), (x, y), (x, y), d), friction.fixed
    if not straight:
        ok, step = _slip_step(contact, (x, y), d, shortest, to_rest)
        if ok == 0:
            # Slip ends here, earlier than in the impact solver, because of the error of the spline.
            if not abs(x) + abs(y) <= 1e3 * step.length * (abs(ax) + abs(ay)):
                return 0, d, to_rest, state, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
            straight = to_rest = True
        elif step.length < d:
            to_rest = False
        d = step.length
    if straight:
        ux, uy = x + d * ax, y + d * ay
        step = Step((x, y), (ux, uy), (0.5 * (x + ux), 0.5 * (y + uy)), d)
    ip, i1, i2, il, gain, moment = quadratures(contact, step, straight, (t1, t2))
    # The velocity at the end of the step, equal to W P to round-off.
    x += m[1] * ip + m[3] * i1 + m[4] * i2
    y += m[2] * ip + m[4] * i1 + m[5] * i2
    gained = d * u_n + moment, d * step.mean[0], d * step.mean[1], ip, i1, i2, il
    return 1, d, to_rest, (x, y, u_n + gain), gained


@kernel
def _plus(total, gained):
    """Return the sum of the integrals of two parts."""
    a0, a1, a2, a3, a4, a5, a6 = total
    b0, b1, b2, b3, b4, b5, b6 = gained
    return a0 + b0, a1 + b1, a2 + b2, a3 + b3, a4 + b4, a5 + b5, a6 + b6


@kernel
def _slip_step(contact, start, d, shortest, to_rest):
    """Solve a step of length `d`, halved until it is accepted; return 1 if it was solved, and the step.

    A step is rejected if Newton's iteration fails (slip passes near u_t = 0), or if slip turns by more
    than 60 degrees. `to_rest` holds only for the whole step.
    """
    while True:
        ok, step = solve_slip(contact, start, d, to_rest)
        if ok == 1 and not to_rest:
            (x, y), (ux, uy) = start, step.end
            size = (x * x + y * y) * (ux * ux + uy * uy)
            ok = 1 if d <= shortest or x * ux + y * uy >= 0.5 * math.sqrt(size) else 0
        if ok == 1 or d <= shortest:
            return ok, step
        d, to_rest = 0.5 * d, False


@kernel
def _stopped(contact, state, total):
    """Return state and integrals after an impulse that removes the remaining u_t, an error of the spline.

    If the normal velocity is prescribed (law A), W (dp, dP_t) = (0, -u_t); otherwise dp = 0.
    """
    m, (x, y, u_n) = contact.m, state
    r1, r2 = solve_tangential(m[3], m[4], m[5], x, y)
    dp, d1, d2 = 0.0, -r1, -r2
    if contact.accel > 0.0:
        k1, k2 = solve_tangential(m[3], m[4], m[5], m[1], m[2])
        dp = (m[1] * r1 + m[2] * r2) / (m[0] - m[1] * k1 - m[2] * k2)
        d1, d2 = -r1 - dp * k1, -r2 - dp * k2
    u_n += m[0] * dp + m[1] * d1 + m[2] * d2
    return (0.0, 0.0, u_n), _plus(total, (0.0, 0.0, 0.0, dp, d1, d2, 0.0))


@kernel
def shoot(contact, span, friction, history, row):
    """Integrate a phase as `run` does; if a law ends it, with the length at which the law reaches its goal."""
    last, length, law = math.inf, span.length, span.law
    result = run(contact, span, friction, history, row)
    if law == NO_LAW:
        return result
    for _ in range(40):
        _, state, at_rest, total, _ = result
        t1, t2 = ratio(contact, Friction(at_rest, friction.t1, friction.t2), state)
        _, k = force(contact, t1, t2)
        left = impact_laws.remaining(law, span.goal, state[2], total[3], total[0])
        change = left / impact_laws.rate(law, state[2], k)
        if abs(change) <= LAST_UNITS * length or (
            abs(change) <= ROUND_OFF * length and abs(change) >= last
        ):
            return result
        if not abs(change) < 0.5 * length:
            break
        length, last = length + change, abs(change)
        longer = Span(span.start, span.steps, length, span.split, law, span.goal)
        result = run(contact, longer, friction, history, row)
    return 0, result[1], result[2], result[3], result[4]


@kernel
def replay(history, first, last, origin, factor):
    """Convert the rows of a phase from the normal impulse (N = 1) to time, with N = `factor`.

    `origin` is time, s and the tangential displacement at the start of the phase, where the rows count from 0.
    """
    for i in range(first, min(last, history.shape[0])):
        history[i, 0] = origin[0] + history[i, 0] / factor
        history[i, 1] = origin[1] + history[i, 1] / factor
        history[i, 5] = origin[2] + history[i, 5] / factor
        history[i, 6] = origin[3] + history[i, 6] / factor
        for column in range(7, COLUMNS):
            history[i, column] *= factor
