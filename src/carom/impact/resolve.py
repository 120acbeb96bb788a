"""One frictional impact by the Darboux-Keller equation, solved to round-off.

The normal impulse p is the time (mathematics page, II.9): du/dp = W (1, tau), tau = -mu u_t/|u_t|
in slip, tau = -W_tt^-1 W_tn in stick. Where the direction of slip is constant u is linear in p and
the piece is closed; else it is stepped (`taylor`). A jam needs no care here: p always grows. Where no
impulse moves anything any more (`wedge`) the velocity that was reached stays.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.friction.rays import outgoing, solve_tangential, stick_ratio
from carom.impact import laws
from carom.impact import layout as o
from carom.impact.slip_step import expand, land, moved, normal_rate
from carom.impact.taylor import reach
from carom.impact.wedge import drowned, moves_nothing, power_of_two, pushed

_ACCURACY = 1e-14  # last term of the series of slip, relative to the root of |u_t| |u|
_AT_REST = 1e-12  # slip is over below this part of the speed of impact
_ON_RAY = 1e-13  # the direction of slip is constant if it turns slower than this (relative)
_ROUND_OFF = 4e-15
_LEFT = 1e-9  # greatest impulse that takes such slip, relative to that of the impact
_FARTHEST = 1e6  # longest step in p, in units of size / W_nn: round-off of u grows with p
_MAX_STEPS = 2000

# What the contact does.
_CURVED, _STRAIGHT, _STICK = 0, 1, 2


@kernel
def _direction(m, mu, s, size):
    """Return 1 if slip keeps its direction from here on to round-off, the direction, and its rate.

    f is the turning of slip, |u_t| dtheta/dp, and g its growth d|u_t|/dp. A ray that attracts
    (df/dtheta < 0) is taken as soon as the distance of u_t from it is round-off: waiting longer
    would cost many steps where slip grows or fades slowly.
    """
    x, y = s[0], s[1]
    r = math.sqrt(x * x + y * y)
    c, n = x / r, y / r
    fx = m[1] - mu * (m[3] * c + m[4] * n)
    fy = m[2] - mu * (m[4] * c + m[5] * n)
    f, g = c * fy - n * fx, c * fx + n * fy
    if abs(f) <= _ON_RAY * (abs(m[1]) + abs(m[2]) + mu * (m[3] + m[5])):
        return 1, c, n, g
    slope = mu * ((m[3] - m[5]) * (c * c - n * n) + 4.0 * m[4] * c * n) - (m[1] * c + m[2] * n)
    if slope < 0.0 and abs(f) * r <= -1e-14 * slope * size and abs(f) <= -1e-3 * slope:
        for _ in range(3):  # Newton onto the ray itself
            turn = -f / slope
            c, n = c - turn * n, n + turn * c
            norm = math.sqrt(c * c + n * n)
            c, n = c / norm, n / norm
            fx = m[1] - mu * (m[3] * c + m[4] * n)
            fy = m[2] - mu * (m[4] * c + m[5] * n)
            f, g = c * fy - n * fx, c * fx + n * fy
        return 1, c, n, g
    return 0, c, n, g


@entry
def resolve(W, u, mu, e, law, out):
    """Resolve one impact as `resolve_one`, for calls from Python."""
    return resolve_one(W, u, mu, e, law, out)


@kernel
def resolve_one(W, u, mu, e, law, out):
    """Resolve one impact of inverse mass `W` (3, 3), approach velocity `u` (3,), friction `mu`.

    Normal first, ``u[0] < 0``; `e` and `law` (as in `laws`) give the restitution; results go to
    `out` as `layout` says, where STILL is given. Returns 0, or the code of what went wrong (`out` then
    holds no result).
    """
    total = W[0, 0] + W[0, 1] + W[0, 2] + W[1, 1] + W[1, 2] + W[2, 2] + u[0] + u[1] + u[2] + mu + e
    if not (math.isfinite(total) and W[0, 0] > 0.0):
        return o.BAD_INPUT
    if not u[0] < 0.0:
        return o.NOT_APPROACHING
    # Units of W and u themselves: powers of the series of slip neither overflow nor vanish.
    w = power_of_two(max(W[0, 0], W[1, 1], W[2, 2]))
    v = power_of_two(max(abs(u[0]), abs(u[1]), abs(u[2])))
    m = (W[0, 0] / w, W[0, 1] / w, W[0, 2] / w, W[1, 1] / w, W[1, 2] / w, W[2, 2] / w)
    u0, u1, u2 = u[0] / v, u[1] / v, u[2] / v
    size = math.sqrt(u0 * u0 + u1 * u1 + u2 * u2)
    s = (u1, u2, u0, 0.0, 0.0, 0.0, 0.0, 0.0)

    t1, t2, c, n, grow = 0.0, 0.0, 0.0, 0.0, 0.0
    phases, steps = 0, 0
    slip_end_p, slip_end_u = -1.0, 0.0
    compressing, now, goal = True, laws.NEWTON, 0.0
    before = (0.0, 0.0, 0.0, 0.0, 0.0)  # p, P_1, P_2, loss, work at the end of compression
    resting = not math.sqrt(u1 * u1 + u2 * u2) > _AT_REST * size
    mode = _CURVED
    if mu == 0.0:
        mode = _STRAIGHT
        phases = o.SLIP if not resting else 0
        resting = False

    while True:
        steps += 1
        if steps > _MAX_STEPS:
            return o.TOO_MANY_STEPS

        # At u_t = 0 (II.9, 2 and 3): stick to the end, or start again along the outgoing ray.
        if resting:
            resting = False
            if phases & o.SLIP:
                slip_end_p, slip_end_u = before[0] + s[3], s[2]
            s = _without_slip(m, s, size)
            t1, t2 = stick_ratio(m[1], m[2], m[3], m[4], m[5])
            mode, grow = _STICK, 0.0
            if not math.sqrt(t1 * t1 + t2 * t2) <= mu:
                c, n, grow = outgoing(m[1], m[2], m[3], m[4], m[5], mu)
                t1, t2 = -mu * c, -mu * n
            if grow > 0.0:
                phases |= o.RESTART if phases & o.SLIP else 0
                mode = _STRAIGHT
            else:
                phases |= o.STICK
        elif mode == _CURVED:
            constant, c, n, grow = _direction(m, mu, s, size)
            if constant:
                mode = _STRAIGHT
        if mode != _STICK and mu > 0.0:
            phases |= o.SLIP

        # One piece: to the end of the phase, to the end of slip, or one step.
        done, stuck = False, False
        if mode == _CURVED:
            _, k = normal_rate(m, mu, s)
            if k <= 0.0:
                phases |= o.JAM
            t = expand(m, mu, s)
            r = math.sqrt(s[0] * s[0] + s[1] * s[1])
            h = reach(t[0], t[1], _ACCURACY * math.sqrt(size * r))
            # Hardly any friction: not far beyond the end that is to be seen from here.
            unit = size / m[0]
            left = laws.remaining(now, goal, s[2], s[3], s[7])
            end = min(laws.straight(now, left, s[2], k), _FARTHEST * unit) if k > 0.0 else 0.0
            h = min(h, 4.0 * max(end, unit) / r)
            new = moved(m, mu, s, t, h)
            if laws.remaining(now, goal, new[2], new[3], new[7]) <= 0.0:
                s = land(m, mu, now, goal, s, new, t, h)
                done = True
            else:
                s = new
                resting = not math.sqrt(s[0] * s[0] + s[1] * s[1]) > 1e-3 * _AT_REST * size
                if not compressing and drowned(m, s[3], s[4], s[5], before[3] - before[4]):
                    done = stuck = True
                    phases |= o.WEDGED
        else:
            if mode == _STRAIGHT:
                t1, t2 = -mu * c, -mu * n
            k = m[0] + m[1] * t1 + m[2] * t2
            f1, f2 = m[1] + m[3] * t1 + m[4] * t2, m[2] + m[4] * t1 + m[5] * t2
            left = laws.remaining(now, goal, s[2], s[3], s[7])
            length = laws.straight(now, left, s[2], k) if left > 0.0 else 0.0
            stuck = moves_nothing(m, t1, t2, k, grow)
            if not compressing and now not in laws.BY_IMPULSE and not (stuck or grow < 0.0):
                p, p1, p2 = s[3] + length, s[4] + length * t1, s[5] + length * t2
                stuck = drowned(m, p, p1, p2, before[3] - before[4])
            if stuck:
                if pushed(s[2], size, out[o.STILL] / v):
                    return o.NO_END
                # Wedged: the velocity stays. Only a law of impulses knows how much impulse is to come.
                k, f1, f2, grow = max(0.0, k), 0.0, 0.0, 0.0
                length = left if now in laws.BY_IMPULSE else 0.0
                if not compressing:
                    phases |= o.WEDGED
            if k <= 0.0 and mode == _STRAIGHT and not stuck:
                phases |= o.JAM
            if mode == _STICK and not abs(f1) + abs(f2) > _ROUND_OFF * (abs(m[1]) + abs(m[2])):
                f1, f2 = 0.0, 0.0  # else W_tt is so thin that stick leaves some creep
            done = True
            r = math.sqrt(s[0] * s[0] + s[1] * s[1])
            if mode == _STRAIGHT and mu > 0.0 and grow < 0.0 and r <= -grow * length:
                length = -r / grow
                done = False
                resting = True
            if not length < math.inf:
                return o.NO_END
            loss = mu * length * (r + 0.5 * grow * length) if mode == _STRAIGHT else 0.0
            s = (
                s[0] + length * f1,
                s[1] + length * f2,
                s[2] + length * k,
                s[3] + length,
                s[4] + length * t1,
                s[5] + length * t2,
                s[6] + loss,
                s[7] + length * (s[2] + 0.5 * k * length),
            )

        if not compressing and not stuck and s[2] < -_AT_REST * size:
            # Driven together again before restitution was over (jam): compression goes on, and
            # what came back counts to it. So p_c and A_c belong to the last zero of u_n.
            compressing, now, goal, done = True, laws.NEWTON, 0.0, False
            s = (s[0], s[1], s[2], s[3] + before[0], s[4] + before[1], s[5] + before[2],
                 s[6] + before[3], s[7] + before[4])  # fmt: skip
            before = (0.0, 0.0, 0.0, 0.0, 0.0)
        if not done:
            continue
        if not compressing:
            break
        compressing = False
        before = (s[3], s[4], s[5], s[6], s[7])
        s = (s[0], s[1], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        if not e > 0.0:
            break
        now = law
        goal = laws.goal(law, e, -u0, before[0], before[4])

    s = (s[0], s[1], max(0.0, s[2]), s[3], s[4], s[5], s[6], s[7])
    P = (before[0] + s[3], before[1] + s[4], before[2] + s[5])
    if not 0.0 < P[0] < math.inf:
        return o.NO_END
    write(out, v, w, (u0, u1, u2), s, P, before)
    out[o.PHASES] = phases
    out[o.STEPS] = steps
    out[o.SLIP_END_P] = slip_end_p * (v / w) if slip_end_p >= 0.0 else -1.0
    out[o.SLIP_END_UN] = slip_end_u * v
    out[o.DURATION], out[o.X_MIN], out[o.KNOTS] = 0.0, 0.0, 0.0
    return o.OK


@kernel
def _without_slip(m, s, size):
    """Return the state with u_t = 0: what is left of it at the end of slip goes into the impulse.

    It is round-off, and so is the impulse, unless hardly anything moves in the tangent plane: there it stays.
    """
    d1, d2 = solve_tangential(m[3], m[4], m[5], s[0], s[1])
    if not abs(d1) + abs(d2) <= _LEFT * size:
        return s
    return (0.0, 0.0, s[2], s[3], s[4] - d1, s[5] - d2, s[6], s[7])


@kernel
def write(out, v, w, u, s, P, before):
    """Write velocities, impulses and works, from those in the units `v` of velocity and `w` of W."""
    p, p1, p2 = P
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
