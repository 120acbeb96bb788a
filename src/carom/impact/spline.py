"""One step of the geometric cubic spline through the boundary layer (mathematics page, II.11).

In the flat coordinates of the layer the equation is du/dt = N W (1, tau); the unknown is the cubic
Hermite of the step, given by the velocity at its end, U, and its mean velocity, Y. The weak form
with test functions 1 and D - t, by three Gauss points,

    U = u_0 + int acc dt,    D Y = D u_0 + int (D - t) acc dt,

is solved by Newton's iteration for the tangential part; the normal part follows. The step is exact
where the acceleration is constant, of order 4 in general.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel

_X1, _X2, _X3 = 0.5 - 0.5 * math.sqrt(0.6), 0.5, 0.5 + 0.5 * math.sqrt(0.6)
_W1, _W2, _W3 = 5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0


@kernel
def gauss(i):
    """Return node and weight of the i-th of three Gauss points on [0, 1]."""
    if i == 0:
        return _X1, _W1
    if i == 1:
        return _X2, _W2
    return _X3, _W3


@kernel
def force(m, accel, t1, t2):
    """Return N (paper, Eq. (8)) and k for the ratio (t1, t2): N = accel / k (law A, II.9), or 1.

    N is 1 if `accel` is 0: the time of the step is the normal impulse then, scaled later by `layer` (II.10).
    """
    k = m[0] + m[1] * t1 + m[2] * t2
    return (accel / k if accel > 0.0 else 1.0), k


@kernel
def slip_ratio(mu, x, y):
    """Return tau = -mu u_t/|u_t| of slip."""
    r = math.sqrt(x * x + y * y)
    return -mu * x / r, -mu * y / r


@kernel
def solve_slip(m, mu, accel, x0, y0, d, to_rest):
    """Return 1 if the step of length `d` in slip from (x0, y0) was solved, U and Y (paper, Eq. (9)).

    `to_rest` says that slip is known to end with the step: then U starts at 0.
    """
    t1, t2 = slip_ratio(mu, x0, y0)
    n, _ = force(m, accel, t1, t2)
    ux = 0.0 if to_rest else x0 + d * n * (m[1] + m[3] * t1 + m[4] * t2)
    uy = 0.0 if to_rest else y0 + d * n * (m[2] + m[4] * t1 + m[5] * t2)
    yx, yy = 0.5 * (x0 + ux), 0.5 * (y0 + uy)
    scale = abs(x0) + abs(y0)
    last = math.inf
    for _ in range(30):
        r1, r2, r3, r4 = ux - x0, uy - y0, yx - x0, yy - y0
        # Jacobian by 2x2 blocks: [A B; C E] (dU; dY) = -(r1 r2; r3 r4).
        a11, a12, a21, a22 = 1.0, 0.0, 0.0, 1.0
        b11, b12, b21, b22 = 0.0, 0.0, 0.0, 0.0
        c11, c12, c21, c22 = 0.0, 0.0, 0.0, 0.0
        e11, e12, e21, e22 = 1.0, 0.0, 0.0, 1.0
        for i in range(3):
            z, w = gauss(i)
            al, be, ga = 6.0 * z * (1.0 - z), (1.0 - z) * (1.0 - 3.0 * z), z * (3.0 * z - 2.0)
            x, y = al * yx + be * x0 + ga * ux, al * yy + be * y0 + ga * uy
            r = math.sqrt(x * x + y * y)
            if not r > 0.0:
                return 0, ux, uy, yx, yy
            c, s = x / r, y / r
            t1, t2 = -mu * c, -mu * s
            n, k = force(m, accel, t1, t2)
            if not k > 0.0 and accel > 0.0:
                return 0, ux, uy, yx, yy
            f1, f2 = m[1] + m[3] * t1 + m[4] * t2, m[2] + m[4] * t1 + m[5] * t2
            w1 = d * w
            w2 = w1 * (1.0 - z)
            r1, r2, r3, r4 = r1 - w1 * n * f1, r2 - w1 * n * f2, r3 - w2 * n * f1, r4 - w2 * n * f2
            # dF/du_t = q (-s, c), rank one: only the turning of u_t changes the force.
            g1, g2 = -m[3] * s + m[4] * c, -m[4] * s + m[5] * c
            bend = (-m[1] * s + m[2] * c) / k if accel > 0.0 else 0.0
            q1, q2 = -mu * n / r * (g1 - bend * f1), -mu * n / r * (g2 - bend * f2)
            j11, j12, j21, j22 = -q1 * s, q1 * c, -q2 * s, q2 * c
            v = w1 * ga
            a11, a12, a21, a22 = a11 - v * j11, a12 - v * j12, a21 - v * j21, a22 - v * j22
            v = w1 * al
            b11, b12, b21, b22 = b11 - v * j11, b12 - v * j12, b21 - v * j21, b22 - v * j22
            v = w2 * ga
            c11, c12, c21, c22 = c11 - v * j11, c12 - v * j12, c21 - v * j21, c22 - v * j22
            v = w2 * al
            e11, e12, e21, e22 = e11 - v * j11, e12 - v * j12, e21 - v * j21, e22 - v * j22
        # Eliminate dY: H = B E^-1, (A - H C) dU = -(r12 - H r34).
        det = e11 * e22 - e12 * e21
        h11, h12 = (b11 * e22 - b12 * e21) / det, (b12 * e11 - b11 * e12) / det
        h21, h22 = (b21 * e22 - b22 * e21) / det, (b22 * e11 - b21 * e12) / det
        a11, a12 = a11 - h11 * c11 - h12 * c21, a12 - h11 * c12 - h12 * c22
        a21, a22 = a21 - h21 * c11 - h22 * c21, a22 - h21 * c12 - h22 * c22
        p1, p2 = r1 - h11 * r3 - h12 * r4, r2 - h21 * r3 - h22 * r4
        schur = a11 * a22 - a12 * a21
        dx, dy = (a12 * p2 - a22 * p1) / schur, (a21 * p1 - a11 * p2) / schur
        q1, q2 = -r3 - c11 * dx - c12 * dy, -r4 - c21 * dx - c22 * dy
        ux, uy = ux + dx, uy + dy
        yx, yy = yx + (e22 * q1 - e12 * q2) / det, yy + (e11 * q2 - e21 * q1) / det
        change = abs(dx) + abs(dy)
        if not change < math.inf:
            return 0, ux, uy, yx, yy
        if change <= 1e-15 * scale or (change <= 1e-12 * scale and change >= last):
            return 1, ux, uy, yx, yy
        last = change
    return 0, ux, uy, yx, yy


@kernel
def quadratures(m, mu, accel, x0, y0, ux, uy, yx, yy, d, fixed, f1, f2):
    """Return the integrals over a solved step: p, P_1, P_2, friction loss, u_n gain, its moment.

    The last two are int acc_n dt and int (D - t) acc_n dt. `fixed` says that the friction ratio is
    the constant (f1, f2) and not that of slip.
    """
    p, p1, p2, loss, gain, moment = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        z, w = gauss(i)
        al, be, ga = 6.0 * z * (1.0 - z), (1.0 - z) * (1.0 - 3.0 * z), z * (3.0 * z - 2.0)
        x, y = al * yx + be * x0 + ga * ux, al * yy + be * y0 + ga * uy
        t1, t2 = f1, f2
        if not fixed:
            t1, t2 = slip_ratio(mu, x, y)
        n, k = force(m, accel, t1, t2)
        p += w * n
        p1 += w * n * t1
        p2 += w * n * t2
        loss -= w * n * (t1 * x + t2 * y)
        normal = accel if accel > 0.0 else k
        gain += w * normal
        moment += w * (1.0 - z) * normal
    return d * p, d * p1, d * p2, d * loss, d * gain, d * d * moment
