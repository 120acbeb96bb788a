"""A step of high order: the Taylor series of the layer between changes of mode, for p = 1.

Normal forces are linear in the depth, friction of sticking contacts is linear in the other forces, and that
of slipping ones follows order by order from q = u_t.u_t, g = q^(-1/2), F = N g, T = -mu F u_t. Where slip may
end soon time is stretched, dt = sigma dtau with 1/sigma = 1 + sum c_i/|u_t,i|: in tau slip fades like an
exponential, and the series reaches far. Changes of mode are found on the series, without another step.
"""

from __future__ import annotations

import math

from carom.impact.corner.law import OPEN
from carom.impact.corner.layout import (
    HOLDING,
    MASS,
    S_D,
    S_F,
    S_FS,
    S_G,
    S_LOSS,
    S_N,
    S_P,
    S_Q,
    S_RATE,
    S_SIGMA,
    S_U,
    STICK_T,
    STUCK,
    WEIGHT,
    D,
    P,
    U,
)
from carom.impact.corner.motion import add_velocity
from carom.jit import kernel

_FARTHEST = 4.0  # longest step, in units of the time of the fastest contact
_FARTHEST_STRETCHED = 40.0
_SAMPLES = 4
_NEAR = 0.3  # slip may end within this time: stretch


@kernel
def degree_for(rtol):
    """Return the degree at which a step costs least per length."""
    return min(24, max(9, int(4.0 - 0.55 * math.log(rtol))))


@kernel
def slips(c):
    """Return whether the friction of contact `c` is that of slip."""
    return c.mode != OPEN and c.mu > 0.0 and c.sticks == 0


@kernel
def likely_force(c, d, u_n):
    """Return the normal force of contact `c`, or of a moment later where it is only closing."""
    force = c.slope * (d - c.rest)
    return max(force, max(0.0, force) + _NEAR * c.slope * max(0.0, -u_n))


@kernel
def stretch_weights(k, work):
    """Write c_i, the rate at which a contact's own friction can change its slip; return if it matters."""
    stretched = False
    u, d, weights = work.vector[U], work.vector[D], work.vector[WEIGHT]
    for i in range(k):
        weights[i] = 0.0
        c = work.contact[i]
        if slips(c):
            n = 3 * i
            r = math.sqrt(u[n + 1] * u[n + 1] + u[n + 2] * u[n + 2])
            weights[i] = c.grip * likely_force(c, d[i], u[n])
            if weights[i] * 2.0 > r:
                stretched = True
    return stretched


@kernel
def expand(k, z, work, degree, stretched):
    """Write the series of velocity, impulse and depth to `degree`; `z` contacts stick (see `grip`)."""
    S, W, weights = work.series, work.matrix[MASS], work.vector[WEIGHT]
    u, pp, d, q, g, f, fs = S[S_U], S[S_P], S[S_D], S[S_Q], S[S_G], S[S_F], S[S_FS]
    normal, loss, inverse, sigma = S[S_N], S[S_LOSS], S[S_RATE], S[S_SIGMA]
    for i in range(3 * k):
        u[0, i] = work.vector[U, i]
        pp[0, i] = work.vector[P, i]
    for i in range(k):
        d[0, i] = work.vector[D, i]
        loss[0, i] = 0.0
    for n in range(degree):
        step = 1.0 / (n + 1)
        total = 1.0 if n == 0 else 0.0
        for i in range(k):
            c = work.contact[i]
            if c.mode == OPEN:
                continue
            normal[n, i] = c.slope * (d[n, i] - c.rest if n == 0 else d[n, i])
            if not slips(c):
                continue
            x, y = 3 * i + 1, 3 * i + 2
            s = 0.0
            for j in range(n + 1):
                s += u[j, x] * u[n - j, x] + u[j, y] * u[n - j, y]
            q[n, i] = s
            if n == 0:
                g[0, i] = 1.0 / math.sqrt(s)
            else:
                s = 0.0
                for j in range(1, n + 1):
                    s += (n - 0.5 * j) * q[j, i] * g[n - j, i]
                g[n, i] = -s / (n * q[0, i])
            s = 0.0
            for j in range(n + 1):
                s += normal[j, i] * g[n - j, i]
            f[n, i] = c.mu * s
            total += weights[i] * g[n, i]
        if stretched:
            inverse[n, 0] = total
            if n == 0:
                sigma[0, 0] = 1.0 / total
            else:
                s = 0.0
                for j in range(1, n + 1):
                    s += inverse[j, 0] * sigma[n - j, 0]
                sigma[n, 0] = -s * sigma[0, 0]
        new = pp[n + 1]
        for i in range(k):
            c = work.contact[i]
            b = 3 * i
            new[b], new[b + 1], new[b + 2] = 0.0, 0.0, 0.0
            s = u[n, b]
            if stretched:
                s = 0.0
                for j in range(n + 1):
                    s += u[j, b] * sigma[n - j, 0]
            d[n + 1, i] = -s * step
            if c.mode == OPEN:
                continue
            s = normal[n, i]
            if stretched:
                s = 0.0
                for j in range(n + 1):
                    s += normal[j, i] * sigma[n - j, 0]
            new[b] = s * step
            if not slips(c):
                continue
            s = f[n, i]
            if stretched:
                s = 0.0
                for j in range(n + 1):
                    s += f[j, i] * sigma[n - j, 0]
            fs[n, i] = s
            s1, s2, s3 = 0.0, 0.0, 0.0
            for j in range(n + 1):
                v = fs[j, i]
                s1 += v * u[n - j, b + 1]
                s2 += v * u[n - j, b + 2]
                s3 += v * q[n - j, i]
            new[b + 1], new[b + 2] = -s1 * step, -s2 * step
            loss[n + 1, i] = s3 * step
        velocity = u[n + 1]
        for i in range(3 * k):
            velocity[i] = 0.0
        add_velocity(3 * k, W, new, velocity)
        if z > 0:
            stick(k, z, work, new, velocity)


@kernel
def stick(k, z, work, impulse, velocity):
    """Add to `impulse` the friction that keeps the `z` sticking contacts at rest, and what it does."""
    hold, slot, t = work.matrix[HOLDING], work.index[STUCK], work.vector[STICK_T]
    for a in range(2 * z):
        s, row = 0.0, hold[a]
        for b in range(z):
            n = 3 * slot[b]
            s -= row[2 * b] * velocity[n + 1] + row[2 * b + 1] * velocity[n + 2]
        t[a] = s
    for b in range(z):
        n = 3 * slot[b]
        x, y = t[2 * b], t[2 * b + 1]
        impulse[n + 1] += x
        impulse[n + 2] += y
        row1, row2 = work.matrix[MASS, n + 1], work.matrix[MASS, n + 2]
        for i in range(3 * k):
            velocity[i] += x * row1[i] + y * row2[i]
    for b in range(z):
        n = 3 * slot[b]
        velocity[n + 1], velocity[n + 2] = 0.0, 0.0


@kernel
def reach(k, work, degree, stretched, tolerance):
    """Return the step at which the last two terms are within `tolerance`."""
    u, d = work.series[S_U], work.series[S_D]
    last, other = 0.0, 0.0
    for i in range(k):
        n = 3 * i
        c = work.contact[i]
        last = max(last, abs(u[degree, n]), abs(d[degree, i]))
        other = max(other, abs(u[degree - 1, n]), abs(d[degree - 1, i]))
        if slips(c):  # the direction of slow slip counts
            r = math.sqrt(u[0, n + 1] * u[0, n + 1] + u[0, n + 2] * u[0, n + 2])
            f = 1.0 / math.sqrt(min(1.0, r))
            last = max(last, f * abs(u[degree, n + 1]), f * abs(u[degree, n + 2]))
            other = max(other, f * abs(u[degree - 1, n + 1]), f * abs(u[degree - 1, n + 2]))
    h = _FARTHEST_STRETCHED if stretched else _FARTHEST
    if last > 0.0:
        h = min(h, (tolerance / last) ** (1.0 / degree))
    if other > 0.0:
        h = min(h, (tolerance / other) ** (1.0 / (degree - 1)))
    return h


@kernel
def move(k, work, degree, x):
    """Go to `x` on the series: depths and impulses; what friction dissipated is added."""
    for i in range(3 * k):
        s = work.series[S_P, degree, i]
        for j in range(degree - 1, -1, -1):
            s = s * x + work.series[S_P, j, i]
        work.vector[P, i] = s
    for i in range(k):
        s = work.series[S_D, degree, i]
        for j in range(degree - 1, -1, -1):
            s = s * x + work.series[S_D, j, i]
        work.vector[D, i] = s
        c = work.contact[i]
        if slips(c):
            s = work.series[S_LOSS, degree, i]
            for j in range(degree - 1, -1, -1):
                s = s * x + work.series[S_LOSS, j, i]
            c.loss += s


@kernel
def first_turn(k, work, degree, end):
    """Return the first x in [0, end] where slip has turned by a right angle, or 2 end.

    Slip along a line passes through u_t = 0 without any sign of it in the series, which then go on with
    friction of the wrong sign.
    """
    u, first = work.series[S_U], 2.0 * end
    for i in range(k):
        if not slips(work.contact[i]):
            continue
        a, low = 3 * i + 1, 0.0
        x0, y0 = u[0, a], u[0, a + 1]
        for s in range(_SAMPLES):
            high = end * ((s + 1) / _SAMPLES)
            if _along(u, a, degree, x0, y0, high) <= 0.0:
                for _ in range(60):
                    x = 0.5 * (low + high)
                    if _along(u, a, degree, x0, y0, x) > 0.0:
                        low = x
                    else:
                        high = x
                    if high - low <= 1e-15 * end:
                        break
                first = min(first, high)
                end = min(end, high)
                break
            low = high
    return first


@kernel
def _along(u, a, degree, x0, y0, x):
    """Return the slip at `x` along (x0, y0)."""
    p, q = u[degree, a], u[degree, a + 1]
    for j in range(degree - 1, -1, -1):
        p = p * x + u[j, a]
        q = q * x + u[j, a + 1]
    return p * x0 + q * y0
