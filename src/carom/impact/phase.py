"""One phase of the layer, compression or restitution, as a sequence of spline steps.

Time is the time of the layer where the normal acceleration is given (`accel` > 0, law A), the
normal impulse where it is not (`accel` = 0; then the end is found from the restitution law).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction.rays import solve_tangential
from carom.impact import laws
from carom.impact.spline import force, quadratures, slip_ratio, solve_slip

# Columns of `history`, a row a knot: time, s, velocity, tangential displacement, force right of it.
COLUMNS = 10

_SHORTEST = 1e-9  # of a phase: a step of slip that fails even so meets u_t = 0
_MAX_STEPS = 10000  # in a phase, beyond those asked for


@kernel
def write(history, row, q, sigma, u_n, x, y, dx, dy, n, t1, t2):
    """Write a knot, if there is room; return the number of the next one."""
    if row < history.shape[0]:
        history[row, 0], history[row, 1] = q, sigma
        history[row, 2], history[row, 3], history[row, 4] = u_n, x, y
        history[row, 5], history[row, 6] = dx, dy
        history[row, 7], history[row, 8], history[row, 9] = n, n * t1, n * t2
    return row + 1


@kernel
def _slip_step(m, mu, accel, x, y, d, shortest, to_rest):
    """Solve a step of `d`, or of half of it ...; return 1 if solved, its length, U, Y.

    A step is refused if Newton's iteration fails on it (slip passes near u_t = 0), or if slip turns
    by more than 60 degrees. `to_rest` counts only for the whole step.
    """
    while True:
        ok, ux, uy, yx, yy = solve_slip(m, mu, accel, x, y, d, to_rest)
        if ok == 1 and not to_rest:
            size = (x * x + y * y) * (ux * ux + uy * uy)
            ok = 1 if d <= shortest or x * ux + y * uy >= 0.5 * math.sqrt(size) else 0
        if ok == 1:
            return 1, d, ux, uy, yx, yy
        if d <= shortest:
            return 0, d, ux, uy, yx, yy
        d, to_rest = 0.5 * d, False


@kernel
def _landed(m, accel, x, y):
    """Return the impulse that takes the rest of u_t = (x, y), an error of the spline, to zero.

    Where the normal velocity is prescribed (law A), W (dp, dP_t) = (0, -u_t); otherwise dp = 0.
    """
    r1, r2 = solve_tangential(m[3], m[4], m[5], x, y)
    if not accel > 0.0:
        return 0.0, -r1, -r2
    k1, k2 = solve_tangential(m[3], m[4], m[5], m[1], m[2])
    dp = (m[1] * r1 + m[2] * r2) / (m[0] - m[1] * k1 - m[2] * k2)
    return dp, -r1 - dp * k1, -r2 - dp * k2


@kernel
def run(m, mu, accel, s, length, n, split, fixed, f1, f2, history, row):
    """Run a phase of `n` equal steps from s = (u_1, u_2, u_n); slip ends at `split` (-1: never).

    Returns 1 if it was solved, the state at the end, whether friction is now the constant ratio
    (f1, f2), the integrals (displacement n, t1, t2; impulse n, t1, t2; friction loss), next row.
    """
    x, y, u_n = s
    q, sigma, dx, dy = 0.0, 0.0, 0.0, 0.0
    p, p1, p2, loss = 0.0, 0.0, 0.0, 0.0
    limit = row + n + _MAX_STEPS
    for i in range(n):
        end = length if i == n - 1 else length * ((i + 1) / n)
        while q < end:
            to_rest = (not fixed) and 0.0 <= split <= end
            stop = max(split, q) if to_rest else end
            d = stop - q
            if d > 0.0:
                t1, t2 = f1, f2
                if not fixed:
                    t1, t2 = slip_ratio(mu, x, y)
                normal, k = force(m, accel, t1, t2)
                if (accel > 0.0 and not k > 0.0) or row > limit:
                    return 0, (x, y, u_n), fixed, (sigma, dx, dy, p, p1, p2, loss), row
                row = write(history, row, q, sigma, u_n, x, y, dx, dy, normal, t1, t2)
                ax = normal * (m[1] + m[3] * t1 + m[4] * t2)
                ay = normal * (m[2] + m[4] * t1 + m[5] * t2)
                straight = fixed
                if not fixed:
                    whole = d
                    ok, d, ux, uy, yx, yy = _slip_step(
                        m, mu, accel, x, y, d, _SHORTEST * length, to_rest
                    )
                    if ok == 0:
                        # The spline's slip ends here, before the resolver's: by its error.
                        if not abs(x) + abs(y) <= 1e3 * d * (abs(ax) + abs(ay)):
                            return 0, (x, y, u_n), fixed, (sigma, dx, dy, p, p1, p2, loss), row
                        straight = to_rest = True
                    elif d < whole:
                        to_rest = False
                    if d < whole:
                        stop = q + d
                if straight:
                    ux, uy = x + d * ax, y + d * ay
                    yx, yy = 0.5 * (x + ux), 0.5 * (y + uy)
                ip, i1, i2, il, gain, moment = quadratures(
                    m, mu, accel, x, y, ux, uy, yx, yy, d, straight, t1, t2
                )
                p, p1, p2, loss = p + ip, p1 + i1, p2 + i2, loss + il
                sigma += d * u_n + moment
                dx, dy = dx + d * yx, dy + d * yy
                u_n += gain
                # The same velocity as (ux, uy), but equal to W P to round-off.
                x += m[1] * ip + m[3] * i1 + m[4] * i2
                y += m[2] * ip + m[4] * i1 + m[5] * i2
                q = stop
            if to_rest:
                ip, i1, i2 = _landed(m, accel, x, y)
                p, p1, p2 = p + ip, p1 + i1, p2 + i2
                u_n += m[0] * ip + m[1] * i1 + m[2] * i2
                x, y, fixed = 0.0, 0.0, True
    return 1, (x, y, u_n), fixed, (sigma, dx, dy, p, p1, p2, loss), row


@kernel
def shoot(m, mu, law, goal, s, length, n, split, fixed, f1, f2, history, row):
    """Run a phase in the normal impulse to where `law` meets its `goal`, first guess `length`."""
    last = math.inf
    result = run(m, mu, 0.0, s, length, n, split, fixed, f1, f2, history, row)
    for _ in range(40):
        (x, y, u_n), at_rest, total = result[1], result[2], result[3]
        t1, t2 = f1, f2
        if not at_rest:
            t1, t2 = slip_ratio(mu, x, y)
        _, k = force(m, 0.0, t1, t2)
        left = laws.remaining(law, goal, u_n, total[3], total[0])
        change = left / laws.rate(law, u_n, k)
        if abs(change) <= 4e-16 * length or (abs(change) <= 1e-12 * length and abs(change) >= last):
            return result
        if not abs(change) < 0.5 * length:
            break
        length, last = length + change, abs(change)
        result = run(m, mu, 0.0, s, length, n, split, fixed, f1, f2, history, row)
    return 0, result[1], result[2], result[3], result[4]


@kernel
def replay(history, first, last, t0, s0, x0, y0, factor):
    """Turn the rows of a phase, counted from its start with N = 1, into time with N = `factor`."""
    for i in range(first, min(last, history.shape[0])):
        history[i, 0] = t0 + history[i, 0] / factor
        history[i, 1] = s0 + history[i, 1] / factor
        history[i, 5] = x0 + history[i, 5] / factor
        history[i, 6] = y0 + history[i, 6] / factor
        history[i, 7] *= factor
        history[i, 8] *= factor
        history[i, 9] *= factor
