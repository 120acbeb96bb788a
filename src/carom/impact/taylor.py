"""One step of slip, by the Taylor series of its solution.

With dtau = dp/|u_t| in place of the normal impulse p, Coulomb slip (mathematics page, §1.9) is

    du_t/dtau = r W_tn - mu W_tt u_t,    r = |u_t|,

autonomous, and smooth down to u_t = 0, which it reaches only as tau -> infinity. The series follows
from q := r^2 = u_t.u_t and r r = q, order by order (q_n = sum x_i x_{n-i} + y_i y_{n-i}; r_n from
sum r_i r_{n-i} = q_n). The other results are integrals of the series: p = int r, P_t = -mu int u_t,
friction loss = mu int q. The end of a phase inside a step is found on the series, without another
step.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel

ORDER = 16


@kernel
def series(rate, x0, y0):
    """Return the coefficients in tau of u_t = (x, y), r and q from u_t = (x0, y0).

    `rate` is W_tn and mu W_tt, (a_1, a_2, m_11, m_12, m_22). The results are four tuples: x and y of orders 0
    to ORDER, r and q of orders 0 to ORDER - 1. All sums are written out in pairs: a loop would need arrays.
    """
    # fmt: off
    q0 = x0*x0 + y0*y0
    r0 = math.sqrt(q0)
    half = 0.5 / r0
    x1, y1 = _next(rate, r0, x0, y0, 1.0)
    q1 = 2.0 * (x0*x1 + y0*y1)
    r1 = half * q1
    x2, y2 = _next(rate, r1, x1, y1, 1 / 2)
    q2 = 2.0 * (x0*x2 + y0*y2) + (x1*x1 + y1*y1)
    r2 = half * (q2 - (r1*r1))
    x3, y3 = _next(rate, r2, x2, y2, 1 / 3)
    q3 = 2.0 * ((x0*x3 + x1*x2) + (y0*y3 + y1*y2))
    r3 = half * (q3 - (2.0 * (r1*r2)))
    x4, y4 = _next(rate, r3, x3, y3, 1 / 4)
    q4 = 2.0 * ((x0*x4 + x1*x3) + (y0*y4 + y1*y3)) + (x2*x2 + y2*y2)
    r4 = half * (q4 - (2.0 * (r1*r3) + r2*r2))
    x5, y5 = _next(rate, r4, x4, y4, 1 / 5)
    q5 = 2.0 * (((x0*x5 + x1*x4) + (x2*x3 + y0*y5)) + (y1*y4 + y2*y3))
    r5 = half * (q5 - (2.0 * (r1*r4 + r2*r3)))
    x6, y6 = _next(rate, r5, x5, y5, 1 / 6)
    q6 = 2.0 * (((x0*x6 + x1*x5) + (x2*x4 + y0*y6)) + (y1*y5 + y2*y4)) + (x3*x3 + y3*y3)
    r6 = half * (q6 - (2.0 * (r1*r5 + r2*r4) + r3*r3))
    x7, y7 = _next(rate, r6, x6, y6, 1 / 7)
    q7 = 2.0 * (((x0*x7 + x1*x6) + (x2*x5 + x3*x4)) + ((y0*y7 + y1*y6) + (y2*y5 + y3*y4)))
    r7 = half * (q7 - (2.0 * ((r1*r6 + r2*r5) + r3*r4)))
    x8, y8 = _next(rate, r7, x7, y7, 1 / 8)
    q8 = (2.0 * (((x0*x8 + x1*x7) + (x2*x6 + x3*x5)) + ((y0*y8 + y1*y7) + (y2*y6 + y3*y5)))
          + (x4*x4 + y4*y4))
    r8 = half * (q8 - (2.0 * ((r1*r7 + r2*r6) + r3*r5) + r4*r4))
    x9, y9 = _next(rate, r8, x8, y8, 1 / 9)
    q9 = 2.0 * ((((x0*x9 + x1*x8) + (x2*x7 + x3*x6)) + ((x4*x5 + y0*y9) + (y1*y8 + y2*y7))) +
         (y3*y6 + y4*y5))
    r9 = half * (q9 - (2.0 * ((r1*r8 + r2*r7) + (r3*r6 + r4*r5))))
    x10, y10 = _next(rate, r9, x9, y9, 1 / 10)
    q10 = 2.0 * ((((x0*x10 + x1*x9) + (x2*x8 + x3*x7)) + ((x4*x6 + y0*y10) + (y1*y9 + y2*y8))) +
          (y3*y7 + y4*y6)) + (x5*x5 + y5*y5)
    r10 = half * (q10 - (2.0 * ((r1*r9 + r2*r8) + (r3*r7 + r4*r6)) + r5*r5))
    x11, y11 = _next(rate, r10, x10, y10, 1 / 11)
    q11 = 2.0 * ((((x0*x11 + x1*x10) + (x2*x9 + x3*x8)) + ((x4*x7 + x5*x6) + (y0*y11 + y1*y10))) +
          ((y2*y9 + y3*y8) + (y4*y7 + y5*y6)))
    r11 = half * (q11 - (2.0 * (((r1*r10 + r2*r9) + (r3*r8 + r4*r7)) + r5*r6)))
    x12, y12 = _next(rate, r11, x11, y11, 1 / 12)
    q12 = 2.0 * ((((x0*x12 + x1*x11) + (x2*x10 + x3*x9)) + ((x4*x8 + x5*x7) + (y0*y12 + y1*y11)))
          + ((y2*y10 + y3*y9) + (y4*y8 + y5*y7))) + (x6*x6 + y6*y6)
    r12 = half * (q12 - (2.0 * (((r1*r11 + r2*r10) + (r3*r9 + r4*r8)) + r5*r7) + r6*r6))
    x13, y13 = _next(rate, r12, x12, y12, 1 / 13)
    q13 = 2.0 * ((((x0*x13 + x1*x12) + (x2*x11 + x3*x10)) + ((x4*x9 + x5*x8) + (x6*x7 + y0*y13)))
          + (((y1*y12 + y2*y11) + (y3*y10 + y4*y9)) + (y5*y8 + y6*y7)))
    r13 = half * (q13 - (2.0 * (((r1*r12 + r2*r11) + (r3*r10 + r4*r9)) + (r5*r8 + r6*r7))))
    x14, y14 = _next(rate, r13, x13, y13, 1 / 14)
    q14 = 2.0 * ((((x0*x14 + x1*x13) + (x2*x12 + x3*x11)) + ((x4*x10 + x5*x9) + (x6*x8 + y0*y14)))
          + (((y1*y13 + y2*y12) + (y3*y11 + y4*y10)) + (y5*y9 + y6*y8))) + (x7*x7 + y7*y7)
    r14 = half * (q14 - (2.0 * (((r1*r13 + r2*r12) + (r3*r11 + r4*r10)) + (r5*r9 + r6*r8)) +
          r7*r7))
    x15, y15 = _next(rate, r14, x14, y14, 1 / 15)
    q15 = 2.0 * ((((x0*x15 + x1*x14) + (x2*x13 + x3*x12)) + ((x4*x11 + x5*x10) + (x6*x9 + x7*x8)))
          + (((y0*y15 + y1*y14) + (y2*y13 + y3*y12)) + ((y4*y11 + y5*y10) + (y6*y9 + y7*y8))))
    r15 = half * (q15 - (2.0 * (((r1*r14 + r2*r13) + (r3*r12 + r4*r11)) + ((r5*r10 + r6*r9) +
          r7*r8))))
    x16, y16 = _next(rate, r15, x15, y15, 1 / 16)
    return (
        (x0, x1, x2, x3, x4, x5, x6, x7, x8, x9, x10, x11, x12, x13, x14, x15, x16),
        (y0, y1, y2, y3, y4, y5, y6, y7, y8, y9, y10, y11, y12, y13, y14, y15, y16),
        (r0, r1, r2, r3, r4, r5, r6, r7, r8, r9, r10, r11, r12, r13, r14, r15),
        (q0, q1, q2, q3, q4, q5, q6, q7, q8, q9, q10, q11, q12, q13, q14, q15),
    )
    # fmt: on


@inlined
def _next(rate, r, x, y, part):
    """Return the coefficients of u_t of order n from those of order n - 1; `part` is 1/n."""
    a1, a2, m11, m12, m22 = rate
    return (a1 * r - (m11 * x + m12 * y)) * part, (a2 * r - (m12 * x + m22 * y)) * part


@kernel
def value(c, h):
    """Return the value at `h` of the series `c` of orders 0 to ORDER."""
    v = c[16]
    v = v * h + c[15]
    v = v * h + c[14]
    v = v * h + c[13]
    v = v * h + c[12]
    v = v * h + c[11]
    v = v * h + c[10]
    v = v * h + c[9]
    v = v * h + c[8]
    v = v * h + c[7]
    v = v * h + c[6]
    v = v * h + c[5]
    v = v * h + c[4]
    v = v * h + c[3]
    v = v * h + c[2]
    v = v * h + c[1]
    v = v * h + c[0]
    return v


@kernel
def integral(c, h):
    """Return the integral from 0 to `h` of the series `c`, of orders 0 to ORDER - 1."""
    v = c[15] * 0.0625
    v = v * h + c[14] * 0.06666666666666667
    v = v * h + c[13] * 0.07142857142857142
    v = v * h + c[12] * 0.07692307692307693
    v = v * h + c[11] * 0.08333333333333333
    v = v * h + c[10] * 0.09090909090909091
    v = v * h + c[9] * 0.1
    v = v * h + c[8] * 0.1111111111111111
    v = v * h + c[7] * 0.125
    v = v * h + c[6] * 0.14285714285714285
    v = v * h + c[5] * 0.16666666666666666
    v = v * h + c[4] * 0.2
    v = v * h + c[3] * 0.25
    v = v * h + c[2] * 0.3333333333333333
    v = v * h + c[1] * 0.5
    v = v * h + c[0]
    return v * h


@kernel
def reach(x, y, accuracy):
    """Return the step in tau at which each of the last two terms of u_t is at most `accuracy`."""
    last = max(abs(x[16]), abs(y[16]))
    other = max(abs(x[15]), abs(y[15]))
    h = math.inf
    if last > 0.0:
        h = (accuracy / last) ** 0.0625
    if other > 0.0:
        h = min(h, (accuracy / other) ** 0.06666666666666667)
    return h
