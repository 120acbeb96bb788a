"""The discrete rotation of a rigid body by its momentum: symplectic, with exact momentum.

It follows from the discrete Lagrangian tr((1 - F) J_d)/h of a rotation F by the unit quaternion (a, b) in body
axes (Moser and Veselov 1991; McLachlan and Zanna 2005):

    a J b + b x J b = h/2 m,     a = sqrt(1 - |b|^2),     m = R_0^T l.

The order is 2; a step -h with the same l reverses a step h. The left side is bounded: one step rotates by less
than half a turn, for equal moments by less than a quarter.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross, multiply, normalize, rotate_back
from carom.geometry.thresholds import NO_CHANGE, ROUND_OFF


@kernel
def turn_by_momentum(body, q, h, momenta, out):
    """Write the attitude after a time h; momenta[3:6] is l. Returns False if it turns too far."""
    J = body.inertia
    m = rotate_back(q, momenta[3:])
    g = (0.5 * h * m[0], 0.5 * h * m[1], 0.5 * h * m[2])
    b = (g[0] / J[0], g[1] / J[1], g[2] / J[2])
    last, done = math.inf, False
    for _ in range(30):
        s = b[0] * b[0] + b[1] * b[1] + b[2] * b[2]
        if not s < 1.0:
            return False
        a = math.sqrt(1.0 - s)
        d = newton_change(J, a, b, g)
        b = (b[0] + d[0], b[1] + d[1], b[2] + d[2])
        change = max(abs(d[0]), max(abs(d[1]), abs(d[2])))
        if change <= NO_CHANGE or (change <= ROUND_OFF and not change < 0.5 * last):
            done = True
            break
        last = change
    if not done:
        return False
    a = math.sqrt(1.0 - (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]))
    out[0], out[1], out[2], out[3] = normalize(multiply(q, (a, b[0], b[1], b[2])))
    return True


@kernel
def newton_change(J, a, b, g):
    """Return the change of b by Newton's method, K d = g - a J b - b x J b.

    K = a J - (J b) b^T/a + hat(b) J - hat(J b).
    """
    l = (J[0] * b[0], J[1] * b[1], J[2] * b[2])
    c = cross(b[0], b[1], b[2], l[0], l[1], l[2])
    r0, r1, r2 = g[0] - a * l[0] - c[0], g[1] - a * l[1] - c[1], g[2] - a * l[2] - c[2]
    i = 1.0 / a
    k00, k11 = a * J[0] - l[0] * b[0] * i, a * J[1] - l[1] * b[1] * i
    k22 = a * J[2] - l[2] * b[2] * i
    k01 = -l[0] * b[1] * i - b[2] * J[1] + l[2]
    k02 = -l[0] * b[2] * i + b[1] * J[2] - l[1]
    k10 = -l[1] * b[0] * i + b[2] * J[0] - l[2]
    k12 = -l[1] * b[2] * i - b[0] * J[2] + l[0]
    k20 = -l[2] * b[0] * i - b[1] * J[0] + l[1]
    k21 = -l[2] * b[1] * i + b[0] * J[1] - l[0]
    x = cross(k01, k11, k21, k02, k12, k22)  # second column x third
    f = 1.0 / (k00 * x[0] + k10 * x[1] + k20 * x[2])
    y = cross(k02, k12, k22, k00, k10, k20)
    z = cross(k00, k10, k20, k01, k11, k21)
    return (
        f * (x[0] * r0 + x[1] * r1 + x[2] * r2),
        f * (y[0] * r0 + y[1] * r1 + y[2] * r2),
        f * (z[0] * r0 + z[1] * r1 + z[2] * r2),
    )
