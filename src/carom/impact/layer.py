"""The paper's phase inside the boundary layer, in time, by geometric cubic splines.

Flat coordinates (s, x^2, x^3), s = b ln(x/b). Two ways of giving the normal force:

- Newton's law: law A (mathematics page, II.8), the normal acceleration is prescribed, constant in
  compression, v_0^2/(2 b l), and e^2 of it in restitution; N = a/k(tau).
- Poisson and Stronge, and Newton when k(tau) <= 0 on the way (jam): the steps are taken in the
  normal impulse and replayed in time with constant N_c = |A_c|/(b l), N_r = A_r/(b l) (II.10).

Either way s returns to 0 from exactly -b l; where the pair is wedged it stays there, compressed. The
instant at which slip ends, where a step must be split, is taken from the resolver; every velocity is the
spline's own.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.friction.rays import outgoing, stick_ratio
from carom.impact import laws
from carom.impact import layout as o
from carom.impact.phase import replay, run, shoot, write
from carom.impact.resolve import resolve_one
from carom.impact.spline import force, slip_ratio

_AT_REST = 1e-12  # as in `resolve`
_DOUBLINGS = 8  # of the steps, if a phase was not solved
E_MIN = 1e-6  # below this restitution the impact ends with compression: T_r = T_c/e


@kernel
def _final_friction(m, mu):
    """Return the constant friction ratio once u_t = 0, and whether it is that of stick."""
    if not mu > 0.0:
        return 0.0, 0.0, False
    f1, f2 = stick_ratio(m[1], m[2], m[3], m[4], m[5])
    if math.sqrt(f1 * f1 + f2 * f2) <= mu:
        return f1, f2, True
    c, s, _ = outgoing(m[1], m[2], m[3], m[4], m[5], mu)
    return -mu * c, -mu * s, False


@entry
def traverse(W, u, mu, e, law, b, delta, steps, history, out):
    """Pass one impact through the layer of width `b`, to the depth `delta` b, in `steps` steps.

    As `resolve`, with the same `out`. `steps` are shared equally by compression and restitution
    (one each at least). Knots go to the rows of `history` (t, s, u_n, u_1, u_2, x^2, x^3, N, T_1,
    T_2), as many as there is room for; their number to ``out[KNOTS]``. Forces are those right of
    the knot, at the last one those left of it.
    """
    code = resolve_one(W, u, mu, e, law, out)
    if code != o.OK:
        return code
    jam = (int(out[o.PHASES]) & (o.JAM | o.WEDGED)) != 0
    code = o.NO_CONVERGENCE
    for _ in range(_DOUBLINGS):
        if law == laws.NEWTON and not jam:
            code = _pass(W, u, mu, e, law, False, b, delta, steps, history, out)
        if code != o.OK:  # or so near a jam that law A fails at this number of steps
            code = _pass(W, u, mu, e, law, True, b, delta, steps, history, out)
        if code == o.OK:
            return code
        steps *= 2  # slip passes too near u_t = 0 for steps of this length
    return code


@kernel
def _pass(W, u, mu, e, law, impulse_form, b, delta, steps, history, out):
    """Run both phases, in time (law A) or in normal impulse; `out` holds what `resolve` says."""
    m = (W[0, 0], W[0, 1], W[0, 2], W[1, 1], W[1, 2], W[2, 2])
    v0 = -u[0]
    depth = -b * math.log1p(-delta)  # b l
    n = max(1, steps // 2)
    slip_end_p, slip_end_u = out[o.SLIP_END_P], out[o.SLIP_END_UN]
    p_c, p_f = out[o.P_C], out[o.IMPULSE]
    wedged = (
        int(out[o.PHASES]) & o.WEDGED
    ) != 0  # no law says where the phases end: the resolver does
    ends_in_c = 0.0 <= slip_end_p <= p_c

    size = math.sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2])
    at_rest = not math.sqrt(u[1] * u[1] + u[2] * u[2]) > _AT_REST * size
    fixed = at_rest or mu == 0.0
    f1, f2, sticks = _final_friction(m, mu)

    # Compression, from u_n = -v0 to 0.
    start = (u[1], u[2], u[0])
    if impulse_form:
        accel, split = 0.0, slip_end_p if ends_in_c else -1.0
        if wedged:
            result = run(m, mu, 0.0, start, p_c, n, split, fixed, f1, f2, history, 0)
        else:
            result = shoot(m, mu, laws.NEWTON, 0.0, start, p_c, n, split, fixed, f1, f2, history, 0)
    else:
        accel = 0.5 * v0 * v0 / depth
        split = min((slip_end_u + v0) / accel, v0 / accel) if ends_in_c else -1.0
        result = run(m, mu, accel, start, v0 / accel, n, split, fixed, f1, f2, history, 0)
    ok, state, fixed, total, row = result
    if ok == 0:
        return o.NO_CONVERGENCE
    x1, y1, u_end = state[0], state[1], 0.0
    if fixed and sticks:
        x1, y1 = 0.0, 0.0  # not the round-off of W (1, tau)
    c0, c1, c2 = total[3], total[4], total[5]
    energy = 0.5 * (c0 * u[0] + c1 * (u[1] + x1) + c2 * (u[2] + y1))
    # The work of the normal force: of the spline's s in the impulse form, so that s_min = -b l.
    work_c = total[0] if impulse_form and mu > 0.0 else energy + total[6]
    loss = work_c - energy
    factor = -work_c / depth if impulse_form else 1.0
    time = c0 / factor if impulse_form else v0 / accel
    sx, sy, s_end = total[1] / factor, total[2] / factor, -depth
    replay(history, 0, row, 0.0, 0.0, 0.0, 0.0, factor)

    # Restitution, to where the law ends it.
    p0, p1, p2, work_r = c0, c1, c2, 0.0
    if e >= E_MIN and not (wedged and p_f <= p_c):
        first, start = row, (x1, y1, 0.0)
        later = slip_end_p >= 0.0 and not fixed
        if impulse_form:
            split = max(slip_end_p - p_c, 0.0) if later else -1.0
            goal = laws.goal(law, e, v0, c0, work_c)
            length = p_f - p_c
            if wedged:
                result = run(m, mu, 0.0, start, length, n, split, fixed, f1, f2, history, row)
            else:
                result = shoot(
                    m, mu, law, goal, start, length, n, split, fixed, f1, f2, history, row
                )
        else:
            accel *= e * e
            length = e * v0 / accel
            split = min(max(slip_end_u / accel, 0.0), length) if later else -1.0
            result = run(m, mu, accel, start, length, n, split, fixed, f1, f2, history, row)
        ok, state, fixed, total, row = result
        if ok == 0:
            return o.NO_CONVERGENCE
        x2, y2, u_end = state[0], state[1], state[2] if impulse_form else e * v0
        if fixed and sticks:
            x2, y2 = 0.0, 0.0
        r0, r1, r2 = total[3], total[4], total[5]
        energy = 0.5 * (r0 * u_end + r1 * (x1 + x2) + r2 * (y1 + y2))
        work_r = total[0] if impulse_form and mu > 0.0 else energy + total[6]
        loss += work_r - energy
        if wedged and not work_r > _AT_REST * -work_c:
            row = first  # an impulse that moves nothing takes no time
        else:
            factor = work_r / depth if impulse_form else 1.0
            replay(history, first, row, time, s_end, sx, sy, factor)
            time += r0 / factor if impulse_form else length
            sx, sy, s_end = sx + total[1] / factor, sy + total[2] / factor, 0.0
        p0, p1, p2 = p0 + r0, p1 + r1, p2 + r2
        x1, y1 = x2, y2

    t1, t2 = f1, f2
    if not fixed:
        t1, t2 = slip_ratio(mu, x1, y1)
    normal, _ = force(m, accel, t1, t2)
    row = write(history, row, time, s_end, u_end, x1, y1, sx, sy, normal * factor, t1, t2)

    out[o.VELOCITY], out[o.VELOCITY + 1], out[o.VELOCITY + 2] = u_end, x1, y1
    out[o.IMPULSE], out[o.IMPULSE + 1], out[o.IMPULSE + 2] = p0, p1, p2
    out[o.COMPRESSION], out[o.COMPRESSION + 1], out[o.COMPRESSION + 2] = c0, c1, c2
    out[o.WORK_C], out[o.WORK_R], out[o.FRICTION_LOSS] = work_c, work_r, loss
    out[o.ENERGY_CHANGE] = 0.5 * (p0 * (u[0] + u_end) + p1 * (u[1] + x1) + p2 * (u[2] + y1))
    out[o.P_C] = c0
    out[o.STEPS] = row - 1
    out[o.DURATION], out[o.X_MIN] = time, b * (1.0 - delta)
    out[o.KNOTS] = row
    return o.OK
