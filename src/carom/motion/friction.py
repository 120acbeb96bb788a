"""The force of one held contact from its 3 x 3 inverse mass W: all of it, or Coulomb's law in slip."""

from __future__ import annotations

import math

from carom.coulomb.one import solve_one
from carom.jit import kernel


@kernel
def stick_force(W, an, a1, a2):
    """Return lam with W lam = -a. A tangent direction of no compliance (W_ii = 0) gets no force."""
    # symmetric elimination, normal first; a pivot at round-off of its diagonal is left out
    l10, l20 = W[1, 0] / W[0, 0], W[2, 0] / W[0, 0]
    d1 = W[1, 1] - l10 * W[1, 0]
    c21 = W[2, 1] - l20 * W[1, 0]
    y0, y1, y2 = -an, -a1 + l10 * an, -a2 + l20 * an
    free1 = d1 > 1e-13 * W[1, 1]
    l21 = c21 / d1 if free1 else 0.0
    d2 = W[2, 2] - l20 * W[2, 0] - l21 * c21
    y2 -= l21 * y1
    t2 = y2 / d2 if d2 > 1e-13 * W[2, 2] else 0.0
    t1 = y1 / d1 - l21 * t2 if free1 else 0.0
    n = y0 / W[0, 0] - l10 * t1 - l20 * t2
    return n, t1, t2


@kernel
def slip_force(W, an, a1, a2, u1, u2, mu):
    """Return lam = N (1, -mu e) with the normal row at rest; e along the slip, or where slip will start.

    N = -a_n / (W_nn - mu W_nt.e). At u_t = 0 it is the force of the contact problem w = W f + a: slip starts
    along its acceleration, in the direction e with a_t + N (W_tn - mu W_tt e) = g e, g > 0.
    """
    speed = math.sqrt(u1 * u1 + u2 * u2)
    if speed > 0.0:
        e1, e2 = u1 / speed, u2 / speed
        n = -an / (W[0, 0] - mu * (W[0, 1] * e1 + W[0, 2] * e2))
        return n, -mu * n * e1, -mu * n * e2
    if not an < 0.0:
        return -an / W[0, 0], 0.0, 0.0
    _, n, t1, t2 = solve_one(W[0, 0], W[0, 1], W[0, 2], W[1, 1], W[1, 2], W[2, 2], an, a1, a2, mu)
    return n, t1, t2
