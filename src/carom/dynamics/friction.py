"""The force of one persistent contact from its 3 x 3 inverse mass W, in stick and in slip (Coulomb's law)."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction.one_contact import solve_one, upper_triangle

_EMPTY = 1e-13  # of the trace of W: pivots below are round-off, nothing moves in that direction


@kernel
def stick_force(W, an, a1, a2):
    """Return lam with W lam = -a; if there are several, the one with the least friction.

    A tangent direction in which nothing can move gets no force. W is singular if joints leave the point one
    direction of slip; any other choice would then need more friction than sticking requires.
    """
    # symmetric elimination, normal first, leads to B t = r, B = W_tt - W_tn W_nt/W_nn
    l1, l2 = W[1, 0] / W[0, 0], W[2, 0] / W[0, 0]
    b11, b12, b22 = W[1, 1] - l1 * W[1, 0], W[2, 1] - l2 * W[1, 0], W[2, 2] - l2 * W[2, 0]
    r1, r2 = l1 * an - a1, l2 * an - a2
    none = _EMPTY * (W[0, 0] + W[1, 1] + W[2, 2])
    # first the pivot with less cancellation
    if b22 <= none or (b11 > none and b11 * W[2, 2] >= b22 * W[1, 1]):
        t1, t2 = least(b11, b12, b22, r1, r2, none)
    else:
        t2, t1 = least(b22, b12, b11, r2, r1, none)
    return -an / W[0, 0] - l1 * t1 - l2 * t2, t1, t2


@kernel
def least(b11, b12, b22, r1, r2, none):
    """Return the least (t1, t2) with B t = r; pivots below `none` count as zero."""
    if not b11 > none:
        return 0.0, 0.0
    ratio = b12 / b11
    left = b22 - ratio * b12
    if left > none:
        t2 = (r2 - ratio * r1) / left
        return (r1 - b12 * t2) / b11, t2
    # rank one, B = b11 (1, ratio)^T (1, ratio)
    t1 = r1 / (b11 * (1.0 + ratio * ratio))
    return t1, ratio * t1


@kernel
def slip_force(W, an, a1, a2, u1, u2, mu):
    """Return lam = N (1, -mu e) for which the normal row vanishes; e is along the slip, or starting slip.

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
    _, n, t1, t2 = solve_one(upper_triangle(W), (an, a1, a2), mu)
    return n, t1, t2
