"""One frictional impact by the Darboux-Keller equation, solved to round-off.

The normal impulse p is the independent variable (mathematics page, §1.9): du/dp = W (1, tau), with tau = -mu
u_t/|u_t| in slip and tau = -W_tt^-1 W_tn in stick. While the direction of slip is constant, u is linear in p,
in closed form; otherwise slip is integrated (`taylor`). A jam needs no special treatment, because p
always grows. If no impulse changes the velocity (`wedge`), the velocity reached so far is the result.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from carom._compiled.decorators import entry, inlined, kernel
from carom.friction.rays import outgoing, solve_tangential, stick_ratio
from carom.geometry.thresholds import REMAINDER, ROUND_OFF, SUM_ERROR
from carom.impact import layout as o
from carom.impact.final_slip import by_final_slip
from carom.impact.slip_step import expand, moved, normal_rate, write_end
from carom.impact.taylor import reach
from carom.impact.thresholds import (
    IMPACT_ERROR,
    LONGEST_IMPULSE,
    RAY_ANGLE,
    RAY_TURN,
    SERIES_ACCURACY,
    STOPPED_SHARE,
)
from carom.impact.wedge import below_round_off, moves_nothing, power_of_two, pushed
from carom.law import impact_laws

_SLIP_STEPS = 2000

# The contact slips along a curve or along a line (in the plane of u_t), or it sticks.
BENT, STRAIGHT, STICK = range(3)

# The end of a piece of the path: within the phase, where slip stops, at the goal of the phase, where the pair
# is wedged (no impulse changes the velocity), or nowhere.
WITHIN, AT_STOP, AT_GOAL, AT_WEDGE, WITHOUT_END = range(5)


class Contact(NamedTuple):
    """The contact of an impact, in scaled units of W and u."""

    m: tuple  # W, as in `slip_step`
    mu: float
    size: float  # speed of impact |u|
    still: float  # speed that counts as zero


class Phase(NamedTuple):
    """A phase: compression, which ends at u_n = 0, or restitution, which ends by its law."""

    law: int
    goal: float  # value of the law's measure at the end
    restitution: bool
    taken: float  # energy lost in compression


class Line(NamedTuple):
    """A piece of the path along which u is linear in p."""

    mode: int  # STRAIGHT or STICK; BENT if there is no line
    t1: float  # friction impulse per normal impulse
    t2: float
    growth: float  # d|u_t|/dp


COMPRESSION = Phase(impact_laws.NEWTON, 0.0, False, 0.0)
CURVE = Line(BENT, 0.0, 0.0, 0.0)


@entry
def resolve(W, u, mu, e, law, out):
    """Solve one impact with inverse mass `W` (3, 3), approach velocity `u` (3,), friction `mu`.

    The normal is first, ``u[0] < 0``; `e` and `law` (as in `laws`) give the restitution. Results are written to
    `out` in the order of `layout`; its entry STILL is an input. Return 0, or the code of a failure (`out` then
    has no result).
    """
    code, m, before, units, size = scaled(W, u, mu + e)
    if code != o.OK:
        return code
    if law in impact_laws.WITHOUT_PATH:
        return by_final_slip(m, before, mu, e, units, out)
    contact = Contact(m, mu, size, out[o.STILL] / units[0])
    return finish(out, units, before, _follow(contact, before, e, law))


@inlined
def scaled(W, u, numbers):
    """Return a code, W and u by units, these units of u and W, and |u|; all must be finite, and `numbers`.

    The units are of W and u themselves, so that powers in the series of slip neither overflow nor vanish.
    """
    total = W[0, 0] + W[0, 1] + W[0, 2] + W[1, 1] + W[1, 2] + W[2, 2]
    code = o.OK if u[0] < 0.0 else o.NOT_APPROACHING
    if not (math.isfinite(total + u[0] + u[1] + u[2] + numbers) and W[0, 0] > 0.0):
        code = o.BAD_INPUT
    w = power_of_two(max(W[0, 0], W[1, 1], W[2, 2]))
    v = power_of_two(max(abs(u[0]), abs(u[1]), abs(u[2])))
    m = (W[0, 0] / w, W[0, 1] / w, W[0, 2] / w, W[1, 1] / w, W[1, 2] / w, W[2, 2] / w)
    u0, u1, u2 = u[0] / v, u[1] / v, u[2] / v
    return code, m, (u0, u1, u2), (v, w), math.sqrt(u0 * u0 + u1 * u1 + u2 * u2)


@inlined
def finish(out, units, u, path):
    """Write the results of a path, as `_follow` returns it; return its code."""
    code, steps, phases, s, before, slip_end = path
    v, w = units
    if code != o.OK:
        return code
    s = (s[0], s[1], max(0.0, s[2]), s[3], s[4], s[5], s[6], s[7])
    if not 0.0 < before[0] + s[3] < math.inf:
        return o.NO_END
    write(out, v, w, u, s, before)
    out[o.PHASES] = phases
    out[o.STEPS] = steps
    out[o.SLIP_END_P] = slip_end[0] * (v / w) if slip_end[0] >= 0.0 else -1.0
    out[o.SLIP_END_UN] = slip_end[1] * v
    out[o.DURATION], out[o.X_MIN], out[o.KNOTS] = 0.0, 0.0, 0.0
    return o.OK


@inlined
def _follow(contact, u, e, law):
    """Follow the velocity from `u` to the end of restitution, piece by piece.

    Return a code, the number of pieces, the mask of the phases passed, the state at the end, the results of
    compression (p, P_1, P_2, loss, work; the state is relative to them), and p and u_n where slip first
    stopped.
    """
    mu, at_rest = contact.mu, ROUND_OFF * contact.size
    s, before = (u[1], u[2], u[0], 0.0, 0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0, 0.0)
    phase, line, slip_end = COMPRESSION, CURVE, (-1.0, 0.0)
    phases, steps, stopped = 0, 0, not math.sqrt(u[1] * u[1] + u[2] * u[2]) > at_rest
    if mu == 0.0:
        line = Line(STRAIGHT, 0.0, 0.0, 0.0)
        phases, stopped = 0 if stopped else o.PHASE_SLIP, False

    while steps < _SLIP_STEPS:
        steps += 1
        # Does the contact slip or stick from here?
        if stopped:
            if phases & o.PHASE_SLIP:
                slip_end = (before[0] + s[3], s[2])
            s = without_slip(contact.m, s, contact.size)
            line = from_rest(contact)
            if line.mode == STICK:
                phases |= o.PHASE_STICK
            elif phases & o.PHASE_SLIP:
                phases |= o.PHASE_RESTART
        elif line.mode == BENT:
            line = straightened(contact, s)
        if line.mode != STICK and mu > 0.0:
            phases |= o.PHASE_SLIP

        # One piece, until the phase ends or slip ends, or one step.
        if line.mode == BENT:
            s, ended, marks = along_curve(contact, phase, s)
        else:
            s, ended, marks = along_line(contact, phase, line, s)
        phases |= marks
        if ended == WITHOUT_END:
            return o.NO_END, steps, phases, s, before, slip_end
        stopped = ended == AT_STOP

        # The next phase.
        if phase.restitution and ended != AT_WEDGE and s[2] < -at_rest:
            # Jam: the bodies approach again before restitution ends. Compression continues and includes
            # the restitution so far, so p_c and A_c belong to the last zero of u_n.
            phase = COMPRESSION
            s = (s[0], s[1], s[2], s[3] + before[0], s[4] + before[1], s[5] + before[2],
                 s[6] + before[3], s[7] + before[4])  # fmt: skip
            before = (0.0, 0.0, 0.0, 0.0, 0.0)
        elif ended in (AT_GOAL, AT_WEDGE):
            if phase.restitution:
                return o.OK, steps, phases, s, before, slip_end
            before = (s[3], s[4], s[5], s[6], s[7])
            s = (s[0], s[1], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
            if not e > 0.0:
                return o.OK, steps, phases, s, before, slip_end
            goal = impact_laws.goal(law, e, -u[0], before[0], before[4])
            phase = Phase(law, goal, True, before[3] - before[4])
    return o.TOO_MANY_STEPS, steps, phases, s, before, slip_end


@inlined
def from_rest(contact):
    """Return the line along which the contact continues from u_t = 0 (§1.9, 2 and 3).

    It sticks to the end, or slip starts again along the outgoing ray.
    """
    m, mu = contact.m, contact.mu
    t1, t2 = stick_ratio(m[1], m[2], m[3], m[4], m[5])
    if math.sqrt(t1 * t1 + t2 * t2) <= mu:
        return Line(STICK, t1, t2, 0.0)
    c, n, growth = outgoing(m[1], m[2], m[3], m[4], m[5], mu)
    return Line(STRAIGHT if growth > 0.0 else STICK, -mu * c, -mu * n, growth)


@inlined
def straightened(contact, s):
    """Return the line of slip if its direction stays constant to round-off from here on, otherwise the curve.

    An attracting ray (df/dtheta < 0) is used as soon as the distance of u_t from it is round-off, because later
    it would take many steps if slip grows or decreases slowly.
    """
    m, mu, x, y = contact.m, contact.mu, s[0], s[1]
    r = math.sqrt(x * x + y * y)
    c, n = x / r, y / r
    f, g = _turning(m, mu, c, n)
    if abs(f) <= IMPACT_ERROR * (abs(m[1]) + abs(m[2]) + mu * (m[3] + m[5])):
        return Line(STRAIGHT, -mu * c, -mu * n, g)
    slope = mu * ((m[3] - m[5]) * (c * c - n * n) + 4.0 * m[4] * c * n) - (m[1] * c + m[2] * n)
    near = abs(f) * r <= -RAY_TURN * slope * contact.size and abs(f) <= -RAY_ANGLE * slope
    if not (slope < 0.0 and near):
        return CURVE
    for _ in range(3):  # Newton onto the ray itself
        turn = -f / slope
        c, n = c - turn * n, n + turn * c
        norm = math.sqrt(c * c + n * n)
        c, n = c / norm, n / norm
        f, g = _turning(m, mu, c, n)
    return Line(STRAIGHT, -mu * c, -mu * n, g)


@inlined
def _turning(m, mu, c, n):
    """Return the turning of slip in the direction (c, n), |u_t| dtheta/dp, and its growth d|u_t|/dp."""
    fx = m[1] - mu * (m[3] * c + m[4] * n)
    fy = m[2] - mu * (m[4] * c + m[5] * n)
    return c * fy - n * fx, c * fx + n * fy


@kernel
def along_curve(contact, phase, s):
    """Take one step of turning slip; return the new state, the kind of end, and marks of the phases."""
    m, mu, size, law, goal = contact.m, contact.mu, contact.size, phase.law, phase.goal
    r, k = normal_rate(m, mu, s)
    marks = o.PHASE_JAM if k <= 0.0 else 0
    t = expand(m, mu, s)
    h = reach(t[0], t[1], SERIES_ACCURACY * math.sqrt(size * r))
    # With hardly any friction the series reaches far: step little beyond the end expected from here.
    unit = size / m[0]
    left = impact_laws.remaining(law, goal, s[2], s[3], s[7])
    end = min(impact_laws.straight(law, left, s[2], k), LONGEST_IMPULSE * unit) if k > 0.0 else 0.0
    h = min(h, 4.0 * max(end, unit) / r)
    new = moved(m, mu, s, t, h)
    if impact_laws.remaining(law, goal, new[2], new[3], new[7]) <= 0.0:
        return write_end(contact, phase, s, new, t, h), AT_GOAL, marks
    if phase.restitution and below_round_off(m, new[3], new[4], new[5], phase.taken):
        return new, AT_WEDGE, marks | o.WEDGED
    slips = math.sqrt(new[0] * new[0] + new[1] * new[1]) > STOPPED_SHARE * ROUND_OFF * size
    return new, WITHIN if slips else AT_STOP, marks


@inlined
def along_line(contact, phase, line, s):
    """Move to the end of the phase or of slip; return the new state, the kind of end, marks of the phases."""
    m, mu, law, t1, t2, growth = contact.m, contact.mu, phase.law, line.t1, line.t2, line.growth
    k = m[0] + m[1] * t1 + m[2] * t2
    f1, f2 = m[1] + m[3] * t1 + m[4] * t2, m[2] + m[4] * t1 + m[5] * t2
    left = impact_laws.remaining(law, phase.goal, s[2], s[3], s[7])
    length = impact_laws.straight(law, left, s[2], k) if left > 0.0 else 0.0

    # If the pair is wedged the velocity stays. Only a law of impulses then gives the impulse that remains.
    caught, marks, ended = moves_nothing(m, t1, t2, k, growth), 0, AT_GOAL
    if phase.restitution and law not in impact_laws.BY_IMPULSE and not (caught or growth < 0.0):
        p, p1, p2 = s[3] + length, s[4] + length * t1, s[5] + length * t2
        caught = below_round_off(m, p, p1, p2, phase.taken)
    if caught:
        if pushed(s[2], contact.size, contact.still):
            return s, WITHOUT_END, marks
        k, f1, f2, growth = max(0.0, k), 0.0, 0.0, 0.0
        length = left if law in impact_laws.BY_IMPULSE else 0.0
        marks, ended = o.WEDGED if phase.restitution else 0, AT_WEDGE
    elif k <= 0.0 and line.mode == STRAIGHT:
        marks = o.PHASE_JAM
    if line.mode == STICK and not abs(f1) + abs(f2) > SUM_ERROR * (abs(m[1]) + abs(m[2])):
        f1, f2 = 0.0, 0.0  # otherwise W_tt is so nearly singular that stick leaves some creep

    # Slip may end before the phase.
    r, loss = math.sqrt(s[0] * s[0] + s[1] * s[1]), 0.0
    if line.mode == STRAIGHT:
        if mu > 0.0 and growth < 0.0 and r <= -growth * length:
            length, ended = -r / growth, AT_STOP
        loss = mu * length * (r + 0.5 * growth * length)
    if not length < math.inf:
        return s, WITHOUT_END, marks
    s = (
        s[0] + length * f1, s[1] + length * f2, s[2] + length * k, s[3] + length, s[4] + length * t1,
        s[5] + length * t2, s[6] + loss, s[7] + length * (s[2] + 0.5 * k * length),
    )  # fmt: skip
    return s, ended, marks


@kernel
def without_slip(m, s, size):
    """Return the state with u_t = 0: an impulse removes the u_t that remains at the end of slip.

    This u_t is round-off, and so is the impulse, unless W_tt is nearly singular: then u_t stays.
    """
    d1, d2 = solve_tangential(m[3], m[4], m[5], s[0], s[1])
    if not abs(d1) + abs(d2) <= REMAINDER * size:
        return s
    return (0.0, 0.0, s[2], s[3], s[4] - d1, s[5] - d2, s[6], s[7])


@kernel
def write(out, v, w, u, s, before):
    """Write velocities, impulses and works; the arguments are in units of `v` for velocity and `w` for W."""
    p, p1, p2 = before[0] + s[3], before[1] + s[4], before[2] + s[5]
    one, work = v / w, v * (v / w)
    out[o.VELOCITY], out[o.VELOCITY + 1], out[o.VELOCITY + 2] = s[2] * v, s[0] * v, s[1] * v
    out[o.IMPULSE], out[o.IMPULSE + 1], out[o.IMPULSE + 2] = p * one, p1 * one, p2 * one
    for i in range(3):
        out[o.COMPRESSION + i] = before[i] * one
    out[o.WORK_C], out[o.WORK_R] = before[4] * work, s[7] * work
    out[o.FRICTION_LOSS] = (before[3] + s[6]) * work
    energy = 0.5 * (p * (u[0] + s[2]) + p1 * (u[1] + s[0]) + p2 * (u[2] + s[1]))
    out[o.ENERGY_CHANGE] = energy * work
    out[o.P_C] = before[0] * one
