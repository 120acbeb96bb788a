"""One impact whose friction depends on the slip: du/dp = W (1, -mu(|u_t|) u_t/|u_t|), without a closed form.

Slip is integrated in tau, dtau = dp/r, r = |u_t|, in which it is smooth down to its end (`taylor`):

    p' = r,    P_t' = -mu(r) u_t,    loss' = mu(r) r^2,    u = u_0 + W (p, P_t),

by the pair of order 5 of Dormand and Prince (1980). Stick is linear in p, bounded by the static coefficient.
What breaks away from it follows the outgoing ray of mu(0) as far as mu is constant to round-off. All else is as
in `resolve`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction.rays import outgoing, stick_ratio
from carom.geometry.thresholds import LAST_UNITS, ROUND_OFF
from carom.impact import layout as o
from carom.impact.final_slip import by_final_slip_of_law
from carom.impact.resolve import (
    AT_GOAL,
    AT_STOP,
    AT_WEDGE,
    BENT,
    COMPRESSION,
    CURVE,
    STICK,
    STRAIGHT,
    WITHIN,
    WITHOUT_END,
    Contact,
    Line,
    Phase,
    along_line,
    finish,
    scaled,
    without_slip,
)
from carom.impact.slip_step import normal_rate
from carom.impact.thresholds import (
    FIRST_SLIP_STEP,
    LONGEST_IMPULSE,
    RAY_LENGTH,
    SLIP_ERROR,
    STOPPED_SHARE,
)
from carom.impact.wedge import below_round_off
from carom.law import impact_laws
from carom.law.friction import in_slip
from carom.model.tableaus import DORMAND_PRINCE

MOST_SLIP_STEPS = 50_000
#: six stages and the end, as tuples; the error of the six, and -1/40 of the end
_A = tuple(map(tuple, DORMAND_PRINCE.A[:, :6].tolist()))
_E = tuple((0.0 - DORMAND_PRINCE.E[0, :6]).tolist())
_NONE = (0.0, 0.0, 0.0, 0.0)


class SlipFriction(NamedTuple):
    """A law of friction."""

    bound: float  # of stick
    law: int  # its number
    laws: object  # of `carom.model.laws`


class Slip(NamedTuple):
    """A contact in slip, in scaled units."""

    m: tuple  # W, as in `slip_step`
    size: float  # speed of impact |u|
    speed: float  # unit of speeds
    friction: object  # SlipFriction


@unit
def resolve_by_slip(W, u, friction, e, law, out) -> int:
    """Solve one impact by a law of friction; all else is as in `resolve`."""
    code, m, start, units, size = scaled(W, u, friction.bound + e)
    if code != o.OK:
        return code
    if law in impact_laws.WITHOUT_PATH:
        return by_final_slip_of_law(m, start, friction, e, units, out)
    slip = Slip(m, size, units[0], friction)
    still, steps, at_rest = out[o.STILL] / units[0], 0, ROUND_OFF * size
    s = (start[1], start[2], start[0], 0.0, 0.0, 0.0, 0.0, 0.0)
    before, phase, line = (0.0, 0.0, 0.0, 0.0, 0.0), COMPRESSION, CURVE
    phases, slip_end, h = 0, (-1.0, 0.0), FIRST_SLIP_STEP
    stopped, ends = not math.sqrt(s[0] * s[0] + s[1] * s[1]) > at_rest, False
    while not ends:
        steps += 1
        if steps > MOST_SLIP_STEPS:
            return o.TOO_MANY_STEPS
        if stopped:
            if phases & o.PHASE_SLIP:
                slip_end = (before[0] + s[3], s[2])
            s = without_slip(m, s, size)
            line = _from_rest(slip)
            if line.mode == STICK:
                phases |= o.PHASE_STICK
            elif phases & o.PHASE_SLIP:
                phases |= o.PHASE_RESTART
        if line.mode != STICK:
            phases |= o.PHASE_SLIP
        if line.mode == BENT:
            s, ended, marks, h = _along_curve(slip, phase, s, h)
        else:
            mu, ended = _mu(slip, 0.0), WITHIN
            new = _along_ray(m, mu, line, s, size)
            marks = 0
            if (
                line.mode == STRAIGHT
                and impact_laws.remaining(phase.law, phase.goal, new[2], new[3], new[7]) > 0.0
            ):
                s, line = new, CURVE
            else:
                s, ended, marks = along_line(Contact(m, mu, size, still), phase, line, s)
        phases |= marks
        if ended == WITHOUT_END:
            return o.NO_END
        stopped = ended == AT_STOP
        if phase.restitution and ended != AT_WEDGE and s[2] < -at_rest:
            phase = COMPRESSION  # jam: as in `resolve`
            s = (s[0], s[1], s[2], s[3] + before[0], s[4] + before[1], s[5] + before[2],
                 s[6] + before[3], s[7] + before[4])  # fmt: skip
            before = (0.0, 0.0, 0.0, 0.0, 0.0)
        elif ended in (AT_GOAL, AT_WEDGE):
            ends = phase.restitution
            if not ends:
                before = (s[3], s[4], s[5], s[6], s[7])
                s = (s[0], s[1], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
                ends = not e > 0.0
                goal = impact_laws.goal(law, e, -start[0], before[0], before[4])
                phase = Phase(law, goal, True, before[3] - before[4])
    return finish(out, units, start, (o.OK, steps, phases, s, before, slip_end))


@kernel
def _mu(slip, r):
    """Return mu at a slip r, in scaled units."""
    return in_slip(slip.friction.laws, slip.friction.law, r * slip.speed)


@kernel
def _from_rest(slip):
    """Return the line of stick, or that on which slip begins again, which is short."""
    m = slip.m
    t1, t2 = stick_ratio(m[1], m[2], m[3], m[4], m[5])
    if math.sqrt(t1 * t1 + t2 * t2) <= slip.friction.bound:
        return Line(STICK, t1, t2, 0.0)
    mu = _mu(slip, 0.0)
    c, n, growth = outgoing(m[1], m[2], m[3], m[4], m[5], mu)
    if growth > 0.0:
        return Line(STRAIGHT, -mu * c, -mu * n, growth)
    return Line(STICK, -mu * c, -mu * n, growth)


@kernel
def _along_ray(m, mu, line, s, size):
    """Return the state on the ray of slip that begins, where mu is still constant to round-off."""
    t1, t2 = line.t1, line.t2
    p = RAY_LENGTH * size / line.growth if line.growth > 0.0 else 0.0
    x, y = s[0] + p * (m[1] + m[3] * t1 + m[4] * t2), s[1] + p * (m[2] + m[4] * t1 + m[5] * t2)
    k, loss = m[0] + m[1] * t1 + m[2] * t2, 0.5 * mu * line.growth * p * p
    return (
        x, y, s[2] + k * p, s[3] + p, s[4] + p * t1, s[5] + p * t2, s[6] + loss,
        s[7] + p * (s[2] + 0.5 * k * p),
    )  # fmt: skip


@kernel
def _along_curve(slip, phase, s, h):
    """Try one step h in tau; return the state, the kind of end, marks of the phases, and the next h."""
    m, size, law, goal = slip.m, slip.size, phase.law, phase.goal
    r = math.sqrt(s[0] * s[0] + s[1] * s[1])
    mu = _mu(slip, r)
    r, k = normal_rate(m, mu, s)
    marks, unit_p = o.PHASE_JAM if k <= 0.0 else 0, size / m[0]
    left = impact_laws.remaining(law, goal, s[2], s[3], s[7])
    end = (
        min(impact_laws.straight(law, left, s[2], k), LONGEST_IMPULSE * unit_p) if k > 0.0 else 0.0
    )
    h = min(h, 4.0 * max(end, unit_p) / r)
    new, error = _step(slip, s, h)
    share = error / (SLIP_ERROR * math.sqrt(size * r))
    wider = min(4.0, max(0.2, 0.9 * share**-0.2)) if share > 0.0 else 4.0
    if not share <= 1.0:
        return s, WITHIN, marks, h * (wider if share < math.inf else 0.2)
    if impact_laws.remaining(law, goal, new[2], new[3], new[7]) <= 0.0:
        return _land(slip, phase, s, new, h), AT_GOAL, marks, h
    if phase.restitution and below_round_off(m, new[3], new[4], new[5], phase.taken):
        return new, AT_WEDGE, marks | o.WEDGED, h
    slips = math.sqrt(new[0] * new[0] + new[1] * new[1]) > STOPPED_SHARE * ROUND_OFF * size
    return new, WITHIN if slips else AT_STOP, marks, h * wider


@kernel
def _rates(slip, s, d):
    """Return the rates of p, P_t and the loss, `d` after the state `s`."""
    m = slip.m
    x = s[0] + (m[1] * d[0] + m[3] * d[1] + m[4] * d[2])
    y = s[1] + (m[2] * d[0] + m[4] * d[1] + m[5] * d[2])
    r = math.sqrt(x * x + y * y)
    mu = _mu(slip, r)
    return r, -mu * x, -mu * y, mu * r * r


@kernel
def _mixed(h, w, k):
    """Return h times the sum of the rates k of six stages with the weights w."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    for j in range(6):
        a, b, c, d = a + w[j] * k[j][0], b + w[j] * k[j][1], c + w[j] * k[j][2], d + w[j] * k[j][3]
    return h * a, h * b, h * c, h * d


@kernel
def _step(slip, s, h):
    """Return the state h later in tau, and the error of its velocity."""
    m = slip.m
    k1 = _rates(slip, s, _NONE)
    k2 = _rates(slip, s, _mixed(h, _A[1], (k1, _NONE, _NONE, _NONE, _NONE, _NONE)))
    k3 = _rates(slip, s, _mixed(h, _A[2], (k1, k2, _NONE, _NONE, _NONE, _NONE)))
    k4 = _rates(slip, s, _mixed(h, _A[3], (k1, k2, k3, _NONE, _NONE, _NONE)))
    k5 = _rates(slip, s, _mixed(h, _A[4], (k1, k2, k3, k4, _NONE, _NONE)))
    k6 = _rates(slip, s, _mixed(h, _A[5], (k1, k2, k3, k4, k5, _NONE)))
    stages = (k1, k2, k3, k4, k5, k6)
    p, p1, p2, loss = _mixed(h, _A[6], stages)
    a, b, c, _ = _mixed(h, _E, stages)
    last = _rates(slip, s, (p, p1, p2, loss))
    a, b, c = a - h * last[0] / 40.0, b - h * last[1] / 40.0, c - h * last[2] / 40.0
    error = abs(m[0] * a + m[1] * b + m[2] * c)
    error += abs(m[1] * a + m[3] * b + m[4] * c) + abs(m[2] * a + m[4] * b + m[5] * c)
    x = s[0] + (m[1] * p + m[3] * p1 + m[4] * p2)
    y = s[1] + (m[2] * p + m[4] * p1 + m[5] * p2)
    u_n = s[2] + (m[0] * p + m[1] * p1 + m[2] * p2)
    energy = 0.5 * (p * (s[2] + u_n) + p1 * (s[0] + x) + p2 * (s[1] + y))
    return (
        x, y, u_n, s[3] + p, s[4] + p1, s[5] + p2, s[6] + loss, s[7] + (energy + loss),
    ), error  # fmt: skip


@kernel
def _land(slip, phase, start, end, h):
    """Return the state at the goal of the phase, between `start` and `end`, h later (Illinois method)."""
    law, goal = phase.law, phase.goal
    low, high, s = 0.0, h, end
    above = impact_laws.remaining(law, goal, start[2], start[3], start[7])
    below = impact_laws.remaining(law, goal, end[2], end[3], end[7])
    first, side = above, 0
    for _ in range(100):
        z = high - below * (high - low) / (below - above)
        s, _ = _step(slip, start, z)
        left = impact_laws.remaining(law, goal, s[2], s[3], s[7])
        if not abs(left) > LAST_UNITS * first or not low < z < high:
            break
        if left > 0.0:
            low, above = z, left
            below, side = 0.5 * below if side == 1 else below, 1
        else:
            high, below = z, left
            above, side = 0.5 * above if side == -1 else above, -1
    return s
