"""The paper's phase inside the boundary layer, in time, by geometric cubic splines.

The coordinates are flat: (s, x^2, x^3), s = b ln(x/b). There are two forms of the normal force:

- Newton's law uses law A (mathematics page, §1.8): the normal acceleration a is prescribed. It is constant,
  v_0^2/(2 b l) in compression, and e^2 times that in restitution; N = a/k(tau).
- With Poisson's and Stronge's laws, and Newton's if k(tau) <= 0 somewhere (jam), steps are taken in the normal
  impulse, and then converted to time with constant N_c = |A_c|/(b l), N_r = A_r/(b l) (§1.10).

In both forms s returns to 0 from exactly -b l; a wedged pair stays at -b l, compressed. The impact solver gives
the time at which slip ends, where a step must be divided; all velocities are those of the spline.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from carom._compiled.decorators import entry, kernel
from carom.friction.rays import outgoing, stick_ratio
from carom.geometry.thresholds import ROUND_OFF
from carom.impact import layout as o
from carom.impact.phase import NO_LAW, Friction, Span, ratio, replay, shoot
from carom.impact.phase import write as write_knot
from carom.impact.resolve import resolve, write
from carom.impact.spline import Contact, force
from carom.impact.thresholds import NO_RESTITUTION
from carom.law import impact_laws

_DOUBLINGS = 8  # of the steps, if a phase was not solved


class Passage(NamedTuple):
    """One passage through the layer: its input, and the result of the impact solver."""

    m: tuple  # W, as in `slip_step`
    mu: float
    u: tuple  # velocity before, normal first
    e: float
    law: int
    depth: float  # b l
    steps: int  # of a phase
    timed: bool  # law A: steps in time; else in the normal impulse
    wedged: bool  # the phases then end where the impact solver has ended them, and by no law


@entry
def traverse(hit, law, layer, history):
    """Integrate the impact `hit` through the layer (width b, penetration delta, steps of the spline).

    Its W, u, friction, restitution and `out` are those of `resolve`. Compression and restitution have half of
    the steps each (at least one). Knots are written to the rows of `history` (t, s, u_n, u_1, u_2, x^2, x^3, N,
    T_1, T_2), as many as it has, and their number to ``out[KNOTS]``. Forces are those just after the knot, and
    just before the last knot.
    """
    W, u, mu, e, out = hit.W, hit.u, hit.friction, hit.restitution, hit.out
    code = resolve(W, u, mu, e, law, out)
    if code != o.OK:
        return code
    b, delta, steps = layer
    m, before = (W[0, 0], W[0, 1], W[0, 2], W[1, 1], W[1, 2], W[2, 2]), (u[0], u[1], u[2])
    depth, phases = -b * math.log1p(-delta), int(out[o.PHASES])
    wedged = phases & o.WEDGED != 0
    code = o.SPLINE_FAILED
    for _ in range(_DOUBLINGS):
        n = max(1, steps // 2)
        if law == impact_laws.NEWTON and phases & (o.PHASE_JAM | o.WEDGED) == 0:
            given = Passage(m, mu, before, e, law, depth, n, True, wedged)
            code = _pass(given, history, out)
        if code != o.OK:  # also so near a jam that law A fails with this number of steps
            given = Passage(m, mu, before, e, law, depth, n, False, wedged)
            code = _pass(given, history, out)
        if code == o.OK:
            out[o.X_MIN] = b * (1.0 - delta)
            return code
        steps *= 2  # slip comes too near u_t = 0 for steps of this length
    return code


@kernel
def _friction(given):
    """Return the friction at the start, and whether the contact sticks once u_t = 0."""
    m, mu, (u0, u1, u2) = given.m, given.mu, given.u
    if not mu > 0.0:
        return Friction(True, 0.0, 0.0), False
    at_rest = not math.sqrt(u1 * u1 + u2 * u2) > ROUND_OFF * math.sqrt(u0 * u0 + u1 * u1 + u2 * u2)
    t1, t2 = stick_ratio(m[1], m[2], m[3], m[4], m[5])
    if math.sqrt(t1 * t1 + t2 * t2) <= mu:
        return Friction(at_rest, t1, t2), True
    c, s, _ = outgoing(m[1], m[2], m[3], m[4], m[5], mu)
    return Friction(at_rest, -mu * c, -mu * s), False


@kernel
def _pass(given, history, out):
    """Integrate both phases; `out` has the result of `resolve`, and at the end that of the layer."""
    u, e, v0, depth, timed = given.u, given.e, -given.u[0], given.depth, given.timed
    friction, sticks = _friction(given)

    # Compression, from u_n = -v0 to 0.
    accel = 0.5 * v0 * v0 / depth if timed else 0.0
    contact = Contact(given.m, given.mu, accel)
    ok, end, fixed, total, row = shoot(
        contact, _compression(given, accel, out), friction, history, 0
    )
    if ok == 0:
        return o.SPLINE_FAILED
    before = (u[1], u[2], u[0])
    # In stick u_t is exactly 0, without the round-off of W (1, tau).
    state = (0.0, 0.0, 0.0) if fixed and sticks else (end[0], end[1], 0.0)
    work_c, loss = _works(given, before, state, total)
    C, R = (total[3], total[4], total[5]), (0.0, 0.0, 0.0)
    factor, work_r = 1.0 if timed else -work_c / depth, 0.0
    time = v0 / accel if timed else C[0] / factor
    place = (-depth, total[1] / factor, total[2] / factor)
    replay(history, 0, row, (0.0, 0.0, 0.0, 0.0), factor)

    # Restitution, which the law ends.
    friction = Friction(fixed, friction.t1, friction.t2)
    if e >= NO_RESTITUTION and not (given.wedged and out[o.IMPULSE] <= out[o.P_C]):
        first, before = row, state
        accel *= e * e
        goal = impact_laws.goal(given.law, e, v0, C[0], work_c)
        contact = Contact(given.m, given.mu, accel)
        span = _restitution(given, accel, goal, before, not fixed, out)
        ok, end, fixed, total, row = shoot(contact, span, friction, history, row)
        if ok == 0:
            return o.SPLINE_FAILED
        friction = Friction(fixed, friction.t1, friction.t2)
        u_n = e * v0 if timed else end[2]
        state = (0.0, 0.0, u_n) if fixed and sticks else (end[0], end[1], u_n)
        work_r, lost = _works(given, before, state, total)
        loss += lost
        R = (total[3], total[4], total[5])
        if given.wedged and not work_r > ROUND_OFF * -work_c:
            row = first  # an impulse that moves nothing takes no time
        else:
            factor = 1.0 if timed else work_r / depth
            replay(history, first, row, (time, place[0], place[1], place[2]), factor)
            time += e * v0 / accel if timed else total[3] / factor
            place = (0.0, place[1] + total[1] / factor, place[2] + total[2] / factor)

    # The last knot, and the results.
    t1, t2 = ratio(contact, friction, state)
    normal, _ = force(contact, t1, t2)
    row = write_knot(history, row, time, state, place, (normal * factor, t1, t2))
    after = (state[0], state[1], state[2], R[0], R[1], R[2], 0.0, work_r)
    write(out, 1.0, 1.0, u, after, (C[0], C[1], C[2], loss, work_c))
    out[o.STEPS], out[o.DURATION], out[o.KNOTS] = row - 1, time, row
    return o.OK


@kernel
def _compression(given, accel, out):
    """Return the phase of compression."""
    slip_end_p, p_c, v0 = out[o.SLIP_END_P], out[o.P_C], -given.u[0]
    start = (given.u[1], given.u[2], given.u[0])
    ends = 0.0 <= slip_end_p <= p_c
    if given.timed:
        split = min((out[o.SLIP_END_UN] + v0) / accel, v0 / accel) if ends else -1.0
        return Span(start, given.steps, v0 / accel, split, NO_LAW, 0.0)
    law = NO_LAW if given.wedged else impact_laws.NEWTON
    return Span(start, given.steps, p_c, slip_end_p if ends else -1.0, law, 0.0)


@kernel
def _restitution(given, accel, goal, start, slips, out):
    """Return the phase of restitution from `start`, where the contact still `slips` or not."""
    p_c = out[o.P_C]
    later = out[o.SLIP_END_P] >= 0.0 and slips
    if given.timed:
        length = given.e * -given.u[0] / accel
        split = min(max(out[o.SLIP_END_UN] / accel, 0.0), length) if later else -1.0
        return Span(start, given.steps, length, split, NO_LAW, 0.0)
    split = max(out[o.SLIP_END_P] - p_c, 0.0) if later else -1.0
    law = NO_LAW if given.wedged else given.law
    return Span(start, given.steps, out[o.IMPULSE] - p_c, split, law, goal)


@kernel
def _works(given, before, after, total):
    """Return the work of the normal force in a phase and the loss by friction."""
    P0, P1, P2 = total[3], total[4], total[5]
    energy = P0 * (before[2] + after[2]) + P1 * (before[0] + after[0]) + P2 * (before[1] + after[1])
    energy *= 0.5
    # With steps in the impulse it is the work along the spline's s, so that s_min = -b l.
    work = energy + total[6] if given.timed or not given.mu > 0.0 else total[0]
    return work, work - energy
