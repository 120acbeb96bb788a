"""One step of slip, by the explicit Runge-Kutta method of order 8.

With dtau = dp / |u_t| in place of the normal impulse p, Coulomb slip (mathematics page, II.9) is

    du_t/dtau = |u_t| W_tn - mu W_tt u_t,

smooth down to u_t = 0, which it reaches only as tau -> infinity, and autonomous. All else is a
quadrature over the slip: p = int |u_t|, P_t = -mu int u_t, friction loss = mu int |u_t|^2.
"""

from __future__ import annotations

import math

from carom.impact import dop853 as c
from carom.jit import kernel


@kernel
def order_eight(a1, a2, m11, m12, m22, x, y, h):
    """Step u_t = (x, y) by `h` in tau; (a1, a2) is W_tn, (m11, m12, m22) is mu W_tt.

    Returns the quadratures of |u_t|, x, y and |u_t|^2, the new x, y, and the error of the latter.
    """
    r0 = math.sqrt(x * x + y * y)
    f0 = a1 * r0 - m11 * x - m12 * y
    g0 = a2 * r0 - m12 * x - m22 * y
    x1 = x + h * (c.A1_0 * f0)
    y1 = y + h * (c.A1_0 * g0)
    r1 = math.sqrt(x1 * x1 + y1 * y1)
    f1 = a1 * r1 - m11 * x1 - m12 * y1
    g1 = a2 * r1 - m12 * x1 - m22 * y1
    x2 = x + h * (c.A2_0 * f0 + c.A2_1 * f1)
    y2 = y + h * (c.A2_0 * g0 + c.A2_1 * g1)
    r2 = math.sqrt(x2 * x2 + y2 * y2)
    f2 = a1 * r2 - m11 * x2 - m12 * y2
    g2 = a2 * r2 - m12 * x2 - m22 * y2
    x3 = x + h * (c.A3_0 * f0 + c.A3_2 * f2)
    y3 = y + h * (c.A3_0 * g0 + c.A3_2 * g2)
    r3 = math.sqrt(x3 * x3 + y3 * y3)
    f3 = a1 * r3 - m11 * x3 - m12 * y3
    g3 = a2 * r3 - m12 * x3 - m22 * y3
    x4 = x + h * (c.A4_0 * f0 + c.A4_2 * f2 + c.A4_3 * f3)
    y4 = y + h * (c.A4_0 * g0 + c.A4_2 * g2 + c.A4_3 * g3)
    r4 = math.sqrt(x4 * x4 + y4 * y4)
    f4 = a1 * r4 - m11 * x4 - m12 * y4
    g4 = a2 * r4 - m12 * x4 - m22 * y4
    x5 = x + h * (c.A5_0 * f0 + c.A5_3 * f3 + c.A5_4 * f4)
    y5 = y + h * (c.A5_0 * g0 + c.A5_3 * g3 + c.A5_4 * g4)
    r5 = math.sqrt(x5 * x5 + y5 * y5)
    f5 = a1 * r5 - m11 * x5 - m12 * y5
    g5 = a2 * r5 - m12 * x5 - m22 * y5
    x6 = x + h * (c.A6_0 * f0 + c.A6_3 * f3 + c.A6_4 * f4 + c.A6_5 * f5)
    y6 = y + h * (c.A6_0 * g0 + c.A6_3 * g3 + c.A6_4 * g4 + c.A6_5 * g5)
    r6 = math.sqrt(x6 * x6 + y6 * y6)
    f6 = a1 * r6 - m11 * x6 - m12 * y6
    g6 = a2 * r6 - m12 * x6 - m22 * y6
    x7 = x + h * (c.A7_0 * f0 + c.A7_3 * f3 + c.A7_4 * f4 + c.A7_5 * f5 + c.A7_6 * f6)
    y7 = y + h * (c.A7_0 * g0 + c.A7_3 * g3 + c.A7_4 * g4 + c.A7_5 * g5 + c.A7_6 * g6)
    r7 = math.sqrt(x7 * x7 + y7 * y7)
    f7 = a1 * r7 - m11 * x7 - m12 * y7
    g7 = a2 * r7 - m12 * x7 - m22 * y7
    x8 = x + h * (c.A8_0 * f0 + c.A8_3 * f3 + c.A8_4 * f4 + c.A8_5 * f5 + c.A8_6 * f6 + c.A8_7 * f7)
    y8 = y + h * (c.A8_0 * g0 + c.A8_3 * g3 + c.A8_4 * g4 + c.A8_5 * g5 + c.A8_6 * g6 + c.A8_7 * g7)
    r8 = math.sqrt(x8 * x8 + y8 * y8)
    f8 = a1 * r8 - m11 * x8 - m12 * y8
    g8 = a2 * r8 - m12 * x8 - m22 * y8
    x9 = x + h * (
        c.A9_0 * f0
        + c.A9_3 * f3
        + c.A9_4 * f4
        + c.A9_5 * f5
        + c.A9_6 * f6
        + c.A9_7 * f7
        + c.A9_8 * f8
    )
    y9 = y + h * (
        c.A9_0 * g0
        + c.A9_3 * g3
        + c.A9_4 * g4
        + c.A9_5 * g5
        + c.A9_6 * g6
        + c.A9_7 * g7
        + c.A9_8 * g8
    )
    r9 = math.sqrt(x9 * x9 + y9 * y9)
    f9 = a1 * r9 - m11 * x9 - m12 * y9
    g9 = a2 * r9 - m12 * x9 - m22 * y9
    x10 = x + h * (
        c.A10_0 * f0
        + c.A10_3 * f3
        + c.A10_4 * f4
        + c.A10_5 * f5
        + c.A10_6 * f6
        + c.A10_7 * f7
        + c.A10_8 * f8
        + c.A10_9 * f9
    )
    y10 = y + h * (
        c.A10_0 * g0
        + c.A10_3 * g3
        + c.A10_4 * g4
        + c.A10_5 * g5
        + c.A10_6 * g6
        + c.A10_7 * g7
        + c.A10_8 * g8
        + c.A10_9 * g9
    )
    r10 = math.sqrt(x10 * x10 + y10 * y10)
    f10 = a1 * r10 - m11 * x10 - m12 * y10
    g10 = a2 * r10 - m12 * x10 - m22 * y10
    x11 = x + h * (
        c.A11_0 * f0
        + c.A11_3 * f3
        + c.A11_4 * f4
        + c.A11_5 * f5
        + c.A11_6 * f6
        + c.A11_7 * f7
        + c.A11_8 * f8
        + c.A11_9 * f9
        + c.A11_10 * f10
    )
    y11 = y + h * (
        c.A11_0 * g0
        + c.A11_3 * g3
        + c.A11_4 * g4
        + c.A11_5 * g5
        + c.A11_6 * g6
        + c.A11_7 * g7
        + c.A11_8 * g8
        + c.A11_9 * g9
        + c.A11_10 * g10
    )
    r11 = math.sqrt(x11 * x11 + y11 * y11)
    f11 = a1 * r11 - m11 * x11 - m12 * y11
    g11 = a2 * r11 - m12 * x11 - m22 * y11
    ir = h * (
        c.B_0 * r0
        + c.B_5 * r5
        + c.B_6 * r6
        + c.B_7 * r7
        + c.B_8 * r8
        + c.B_9 * r9
        + c.B_10 * r10
        + c.B_11 * r11
    )
    ix = h * (
        c.B_0 * x
        + c.B_5 * x5
        + c.B_6 * x6
        + c.B_7 * x7
        + c.B_8 * x8
        + c.B_9 * x9
        + c.B_10 * x10
        + c.B_11 * x11
    )
    iy = h * (
        c.B_0 * y
        + c.B_5 * y5
        + c.B_6 * y6
        + c.B_7 * y7
        + c.B_8 * y8
        + c.B_9 * y9
        + c.B_10 * y10
        + c.B_11 * y11
    )
    irr = h * (
        c.B_0 * r0 * r0
        + c.B_5 * r5 * r5
        + c.B_6 * r6 * r6
        + c.B_7 * r7 * r7
        + c.B_8 * r8 * r8
        + c.B_9 * r9 * r9
        + c.B_10 * r10 * r10
        + c.B_11 * r11 * r11
    )
    five_x = (
        c.E_0 * f0
        + c.E_5 * f5
        + c.E_6 * f6
        + c.E_7 * f7
        + c.E_8 * f8
        + c.E_9 * f9
        + c.E_10 * f10
        + c.E_11 * f11
    )
    five_y = (
        c.E_0 * g0
        + c.E_5 * g5
        + c.E_6 * g6
        + c.E_7 * g7
        + c.E_8 * g8
        + c.E_9 * g9
        + c.E_10 * g10
        + c.E_11 * g11
    )
    three_x = (
        c.F_0 * f0
        + c.F_5 * f5
        + c.F_6 * f6
        + c.F_7 * f7
        + c.F_8 * f8
        + c.F_9 * f9
        + c.F_10 * f10
        + c.F_11 * f11
    )
    three_y = (
        c.F_0 * g0
        + c.F_5 * g5
        + c.F_6 * g6
        + c.F_7 * g7
        + c.F_8 * g8
        + c.F_9 * g9
        + c.F_10 * g10
        + c.F_11 * g11
    )
    five = five_x * five_x + five_y * five_y
    three = three_x * three_x + three_y * three_y
    # Hairer's combination of the two estimates: of order 7 in the end.
    error = abs(h) * five / math.sqrt(five + 0.01 * three) if five > 0.0 else 0.0
    return (
        ir,
        ix,
        iy,
        irr,
        x + a1 * ir - m11 * ix - m12 * iy,
        y + a2 * ir - m12 * ix - m22 * iy,
        error,
    )


@kernel
def order_four(a1, a2, m11, m12, m22, x, y, h):
    """As `order_eight`, by the classical method of order 4, no estimate: for tiny `h`."""
    r0 = math.sqrt(x * x + y * y)
    x1 = x + 0.5 * h * (a1 * r0 - m11 * x - m12 * y)
    y1 = y + 0.5 * h * (a2 * r0 - m12 * x - m22 * y)
    r1 = math.sqrt(x1 * x1 + y1 * y1)
    x2 = x + 0.5 * h * (a1 * r1 - m11 * x1 - m12 * y1)
    y2 = y + 0.5 * h * (a2 * r1 - m12 * x1 - m22 * y1)
    r2 = math.sqrt(x2 * x2 + y2 * y2)
    x3 = x + h * (a1 * r2 - m11 * x2 - m12 * y2)
    y3 = y + h * (a2 * r2 - m12 * x2 - m22 * y2)
    r3 = math.sqrt(x3 * x3 + y3 * y3)
    ir = h * (r0 + 2.0 * r1 + 2.0 * r2 + r3) / 6.0
    ix = h * (x + 2.0 * x1 + 2.0 * x2 + x3) / 6.0
    iy = h * (y + 2.0 * y1 + 2.0 * y2 + y3) / 6.0
    irr = h * (r0 * r0 + 2.0 * r1 * r1 + 2.0 * r2 * r2 + r3 * r3) / 6.0
    return (
        ir,
        ix,
        iy,
        irr,
        x + a1 * ir - m11 * ix - m12 * iy,
        y + a2 * ir - m12 * ix - m22 * iy,
        0.0,
    )
