"""Exact solution for one contact: stick if the cone allows it, otherwise the slip nearest to stick."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction.thresholds import TANGENTIAL_ERROR
from carom.geometry.thresholds import REMAINDER, ROUND_OFF


@kernel
def eigenbasis(a11, a12, a22):
    """Return (l1, l2, c, s): eigenvalues l1 >= l2 of a symmetric 2x2 matrix, (c, s) belongs to l1."""
    half = 0.5 * (a11 - a22)
    r = math.sqrt(half * half + a12 * a12)
    if not r > 0.0:
        return a11, a22, 1.0, 0.0
    if half >= 0.0:
        c, s = half + r, a12
    else:
        c, s = abs(a12), (r - half) if a12 >= 0.0 else (half - r)
    norm = math.sqrt(c * c + s * s)
    middle = 0.5 * (a11 + a22)
    return middle + r, middle - r, c / norm, s / norm


@kernel
def upper_triangle(W):
    """Return (W_nn, W_n1, W_n2, W_11, W_12, W_22) of a symmetric matrix (3, 3)."""
    return W[0, 0], W[0, 1], W[0, 2], W[1, 1], W[1, 2], W[2, 2]


@kernel
def solve_one(W, velocity, mu):
    """Return (found, p_n, p_1, p_2) for W, given by its upper triangle, and the velocity without impulses.

    In slip w_t = -alpha p_t, alpha > 0; with the normal eliminated p_t = -(A + alpha)^-1 b. In the
    eigenbasis of A the condition |p_t| = mu p_n, multiplied by the denominators D_i = a_i + alpha, is
    h = |(b_1 D_2, b_2 D_1)| + m (c_n D_1 D_2 - g_1 D_2 - g_2 D_1) = 0: a convex term and a
    concave quadratic. If the convex term is replaced by its tangent, the root of the quadratic is below the
    least root of h: the iteration converges quadratically to that root from below.
    """
    return solve_in_basis(
        W, basis_of(W) if velocity[0] < 0.0 else (0.0, 0.0, 1.0, 0.0), velocity, mu
    )


@kernel
def basis_of(W):
    """Return (d1, d2, c, s): eigenvalues and eigenbasis of A = W_tt - W_tn W_nt/W_nn; round-off is set to 0."""
    wnn, wn1, wn2, w11, w12, w22 = W
    if not wnn > 0.0:
        return 0.0, 0.0, 1.0, 0.0
    a11, a12, a22 = w11 - wn1 * wn1 / wnn, w12 - wn1 * wn2 / wnn, w22 - wn2 * wn2 / wnn
    d1, d2, c, s = eigenbasis(a11, a12, a22)
    least = ROUND_OFF * (w11 + w22)
    return d1 if d1 > least else 0.0, d2 if d2 > least else 0.0, c, s


@kernel
def solve_in_basis(W, basis, velocity, mu):
    """Solve as `solve_one` does, with the known eigenbasis of A."""
    wnn, wn1, wn2, _, _, _ = W
    d1, d2, c, s = basis
    cn, c1, c2 = velocity
    if cn >= 0.0:
        return True, 0.0, 0.0, 0.0
    if not wnn > 0.0:
        return False, 0.0, 0.0, 0.0
    if not mu > 0.0:
        return True, -cn / wnn, 0.0, 0.0
    b1, b2 = c1 - wn1 * cn / wnn, c2 - wn2 * cn / wnn
    b1, b2 = c * b1 + s * b2, c * b2 - s * b1
    g1, g2 = c * wn1 + s * wn2, c * wn2 - s * wn1
    if d1 == 0.0 or d2 == 0.0:
        tiny = TANGENTIAL_ERROR * (abs(c1) + abs(c2) + (abs(wn1) + abs(wn2)) * abs(cn) / wnn)
        b1 = b1 if d1 > 0.0 or abs(b1) > tiny else 0.0
        b2 = b2 if d2 > 0.0 or abs(b2) > tiny else 0.0
    found, p1, p2 = _tangential((d1, d2), (b1, b2), (g1, g2), wnn, cn, mu)
    pn = -(cn + g1 * p1 + g2 * p2) / wnn
    return found, pn, c * p1 - s * p2, s * p1 + c * p2


@kernel
def _tangential(d, b, g, wnn, cn, mu):
    """Return (found, p_1, p_2) in the eigenbasis: eigenvalues `d` of A, components of b and of W_tn = g."""
    (d1, d2), (b1, b2), (g1, g2) = d, b, g
    if (d1 > 0.0 or b1 == 0.0) and (d2 > 0.0 or b2 == 0.0):
        p1 = -b1 / d1 if d1 > 0.0 else 0.0
        p2 = -b2 / d2 if d2 > 0.0 else 0.0
        if math.sqrt(p1 * p1 + p2 * p2) * wnn <= -mu * (cn + g1 * p1 + g2 * p2):
            return True, p1, p2
    m = mu / wnn
    if d1 == 0.0:  # A = 0: tangential impulses alone move nothing
        size = math.sqrt(b1 * b1 + b2 * b2)
        denominator = size - m * (g1 * b1 + g2 * b2)
        if not denominator > 0.0:
            return False, 0.0, 0.0
        alpha = -denominator / (m * cn)
        return True, -b1 / alpha, -b2 / alpha
    k1, k2 = m * g1 * b1, m * g2 * b2
    if d2 == 0.0 and b2 == 0.0:  # planar: D_2 cancels, and h is linear
        alpha = (abs(b1) - k1) / (-m * cn) - d1
        return alpha > 0.0, -b1 / (d1 + alpha), 0.0
    alpha = 0.0
    for _ in range(100):
        e1, e2 = d1 + alpha, d2 + alpha
        x, y = b1 * e2, b2 * e1
        q = math.sqrt(x * x + y * y)
        value = q + m * cn * e1 * e2 - k1 * e2 - k2 * e1
        if not value > 0.0:
            break
        rate = (b1 * x + b2 * y) / q if q > 0.0 else 0.0
        rate += m * cn * (e1 + e2) - k1 - k2
        # value + rate t + m cn t^2 = 0, the root t > 0, without cancellation
        root = math.sqrt(rate * rate - 4.0 * m * cn * value)
        t = (rate + root) / (-2.0 * m * cn) if rate > 0.0 else 2.0 * value / (root - rate)
        alpha += t
        if not t > REMAINDER * alpha:  # with quadratic convergence the rest is round-off
            break
    e1, e2 = d1 + alpha, d2 + alpha
    if not (alpha > 0.0 and e2 > 0.0):
        return False, 0.0, 0.0
    return True, -b1 / e1, -b2 / e2
