"""One step of the geometric cubic spline through the boundary layer (mathematics page, §1.11).

In the flat coordinates of the layer the equation is du/dt = N W (1, tau). The unknown is the cubic
Hermite polynomial of the step, given by the velocity U at its end and the mean velocity Y. The weak form
with test functions 1 and D - t, integrated with three Gauss points,

    U = u_0 + int acc dt,    D Y = D u_0 + int (D - t) acc dt,

is solved by Newton's iteration for the tangential part; the normal part follows. The step is exact
if the acceleration is constant, and of order 4 in general.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from carom._compiled.decorators import kernel
from carom.geometry.thresholds import LAST_DIGIT, ROUND_OFF

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


class Contact(NamedTuple):
    """A contact in a phase of the layer, with the prescription of the normal force."""

    m: tuple  # W, as in `slip_step`
    mu: float
    accel: float  # normal acceleration (law A); 0: N = 1, and the time is the normal impulse


class Step(NamedTuple):
    """A solved step: u_t at its start and at its end, the mean u_t, the length."""

    start: tuple
    end: tuple
    mean: tuple
    length: float


@kernel
def force(contact, t1, t2):
    """Return N (paper, Eq. (8)) and k for the ratio (t1, t2): N = accel / k (law A, §1.9), or 1.

    If `accel` is 0, N is 1 and steps are in the normal impulse; `layer` converts them to time later (§1.10).
    """
    m, accel = contact.m, contact.accel
    k = m[0] + m[1] * t1 + m[2] * t2
    return (accel / k if accel > 0.0 else 1.0), k


@kernel
def slip_ratio(mu, x, y):
    """Return tau = -mu u_t/|u_t| of slip."""
    r = math.sqrt(x * x + y * y)
    return -mu * x / r, -mu * y / r


@kernel
def solve_slip(contact, start, d, to_rest):
    """Return 1 if the step of length `d` in slip from u_t = `start` was solved, and the step (paper, Eq. (9)).

    with `to_rest` slip is known to end with the step: then the first guess of U is 0.
    """
    m, (x0, y0) = contact.m, start
    t1, t2 = slip_ratio(contact.mu, x0, y0)
    n, _ = force(contact, t1, t2)
    ux = 0.0 if to_rest else x0 + d * n * (m[1] + m[3] * t1 + m[4] * t2)
    uy = 0.0 if to_rest else y0 + d * n * (m[2] + m[4] * t1 + m[5] * t2)
    yx, yy = 0.5 * (x0 + ux), 0.5 * (y0 + uy)
    scale = abs(x0) + abs(y0)
    last = math.inf
    for _ in range(30):
        step = Step(start, (ux, uy), (yx, yy), d)
        ok, mismatch, A, B, C, E = _equations(contact, step)
        if ok == 0:
            return 0, step
        dx, dy, ex, ey = _eliminated(mismatch, A, B, C, E)
        ux, uy, yx, yy = ux + dx, uy + dy, yx + ex, yy + ey
        change = abs(dx) + abs(dy)
        if not change < math.inf:
            break
        if change <= LAST_DIGIT * scale or (change <= ROUND_OFF * scale and change >= last):
            return 1, Step(start, (ux, uy), (yx, yy), d)
        last = change
    return 0, Step(start, (ux, uy), (yx, yy), d)


@kernel
def _hermite(step, z):
    """Return u_t at the fraction `z` of a step, and the weights of Y and of U in it."""
    al, be, ga = 6.0 * z * (1.0 - z), (1.0 - z) * (1.0 - 3.0 * z), z * (3.0 * z - 2.0)
    (x0, y0), (ux, uy), (yx, yy) = step.start, step.end, step.mean
    return al * yx + be * x0 + ga * ux, al * yy + be * y0 + ga * uy, al, ga


@kernel
def _equations(contact, step):
    """Return 1 if the forces exist, the residual of the weak form, and its Jacobian by blocks [A B; C E]."""
    m, mu, accel, d = contact.m, contact.mu, contact.accel, step.length
    (x0, y0), (ux, uy), (yx, yy) = step.start, step.end, step.mean
    mismatch = ux - x0, uy - y0, yx - x0, yy - y0
    A, B = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0)
    C, E = B, A
    for i in range(3):
        z, w = gauss(i)
        x, y, al, ga = _hermite(step, z)
        r = math.sqrt(x * x + y * y)
        if not r > 0.0:
            return 0, mismatch, A, B, C, E
        c, s = x / r, y / r
        t1, t2 = -mu * c, -mu * s
        n, k = force(contact, t1, t2)
        if not k > 0.0 and accel > 0.0:
            return 0, mismatch, A, B, C, E
        f1, f2 = m[1] + m[3] * t1 + m[4] * t2, m[2] + m[4] * t1 + m[5] * t2
        w1 = d * w
        w2 = w1 * (1.0 - z)
        r1, r2, r3, r4 = mismatch
        mismatch = r1 - w1 * n * f1, r2 - w1 * n * f2, r3 - w2 * n * f1, r4 - w2 * n * f2
        # dF/du_t = q (-s, c) has rank one: only the direction of u_t changes the force.
        g1, g2 = -m[3] * s + m[4] * c, -m[4] * s + m[5] * c
        bend = (-m[1] * s + m[2] * c) / k if accel > 0.0 else 0.0
        q1, q2 = -mu * n / r * (g1 - bend * f1), -mu * n / r * (g2 - bend * f2)
        J = -q1 * s, q1 * c, -q2 * s, q2 * c
        A, B = _less(A, w1 * ga, J), _less(B, w1 * al, J)
        C, E = _less(C, w2 * ga, J), _less(E, w2 * al, J)
    return 1, mismatch, A, B, C, E


@kernel
def _less(A, v, J):
    """Return A - v J of 2x2 blocks."""
    return A[0] - v * J[0], A[1] - v * J[1], A[2] - v * J[2], A[3] - v * J[3]


@kernel
def _eliminated(mismatch, A, B, C, E):
    """Return (dU; dY) = -[A B; C E]^-1 mismatch: H = B E^-1, (A - H C) dU = -(r_12 - H r_34)."""
    r1, r2, r3, r4 = mismatch
    (a11, a12, a21, a22), (b11, b12, b21, b22) = A, B
    (c11, c12, c21, c22), (e11, e12, e21, e22) = C, E
    det = e11 * e22 - e12 * e21
    h11, h12 = (b11 * e22 - b12 * e21) / det, (b12 * e11 - b11 * e12) / det
    h21, h22 = (b21 * e22 - b22 * e21) / det, (b22 * e11 - b21 * e12) / det
    a11, a12 = a11 - h11 * c11 - h12 * c21, a12 - h11 * c12 - h12 * c22
    a21, a22 = a21 - h21 * c11 - h22 * c21, a22 - h21 * c12 - h22 * c22
    p1, p2 = r1 - h11 * r3 - h12 * r4, r2 - h21 * r3 - h22 * r4
    schur = a11 * a22 - a12 * a21
    dx, dy = (a12 * p2 - a22 * p1) / schur, (a21 * p1 - a11 * p2) / schur
    q1, q2 = -r3 - c11 * dx - c12 * dy, -r4 - c21 * dx - c22 * dy
    return dx, dy, (e22 * q1 - e12 * q2) / det, (e11 * q2 - e21 * q1) / det


@kernel
def quadratures(contact, step, straight, ratio):
    """Return the integrals over a solved step: p, P_1, P_2, friction loss, the gain of u_n, and its moment.

    The last two are int acc_n dt and int (D - t) acc_n dt. If `straight`, friction has the constant `ratio`
    in place of that of slip.
    """
    p, p1, p2, loss, gain, moment = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    d, t1, t2 = step.length, ratio[0], ratio[1]
    for i in range(3):
        z, w = gauss(i)
        x, y, _, _ = _hermite(step, z)
        if not straight:
            t1, t2 = slip_ratio(contact.mu, x, y)
        n, k = force(contact, t1, t2)
        p += w * n
        p1 += w * n * t1
        p2 += w * n * t2
        loss -= w * n * (t1 * x + t2 * y)
        normal = contact.accel if contact.accel > 0.0 else k
        gain += w * normal
        moment += w * (1.0 - z) * normal
    return d * p, d * p1, d * p2, d * loss, d * gain, d * d * moment
