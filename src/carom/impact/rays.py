"""What becomes of slip at u_t = 0: stick, or a new start along the one ray that leads away.

Impulse form (mathematics page, II.9), a = W_tn, B = W_tt: in slip du_t/dp = a - mu B e with e the
direction of slip; in stick B tau = -a. Stick needs |tau| <= mu.
"""

from __future__ import annotations

import math

from carom.jit import entry, kernel

# Pivots of B below this part of its trace are zero: a rail, or a planar problem in space.
_EMPTY = 1e-13


@kernel
def solve_tangential(b11, b12, b22, x, y):
    """Return B^+ (x, y), the least-norm solution, for B symmetric and positive semidefinite."""
    trace = b11 + b22
    det = b11 * b22 - b12 * b12
    if det > _EMPTY * trace * trace:
        return (b22 * x - b12 * y) / det, (b11 * y - b12 * x) / det
    if not trace > 0.0:
        return 0.0, 0.0  # nothing moves in the plane of contact
    # Rank one: B = trace d d^T, B^+ = B / trace^2.
    return (b11 * x + b12 * y) / trace / trace, (b12 * x + b22 * y) / trace / trace


@entry
def stick_ratio(a1, a2, b11, b12, b22):
    """Return tau = -B^+ a: the friction impulse per normal impulse that keeps u_t = 0."""
    t1, t2 = solve_tangential(b11, b12, b22, a1, a2)
    return -t1, -t2


@kernel
def outgoing(a1, a2, b11, b12, b22, mu):
    """Return (c, s, g): the direction in which slip starts from rest, and its rate d|u_t|/dp > 0.

    The ray satisfies a - mu B e = g e, so e = (mu B + g)^-1 a, and |(mu B + g)^-1 a| falls with g:
    from |a|_{stick}/mu > 1 at g = 0 to 0. So for mu below the critical value there is exactly one.
    Newton's iteration on 1/|e(g)| rises to the root from the left without ever passing it.
    """
    size = math.sqrt(a1 * a1 + a2 * a2)
    half = 0.5 * (b11 - b22)
    largest = 0.5 * (b11 + b22) + math.sqrt(half * half + b12 * b12)
    g = size - mu * largest  # |e(g)| >= size / (mu largest + g): a lower bound of the root
    g = max(g, 1e-15 * (size + mu * largest))
    c, s = a1 / size, a2 / size
    for _ in range(100):
        m11, m12, m22 = mu * b11 + g, mu * b12, mu * b22 + g
        det = m11 * m22 - m12 * m12
        c = (m22 * a1 - m12 * a2) / det
        s = (m11 * a2 - m12 * a1) / det
        norm2 = c * c + s * s
        slope = (m22 * c * c - 2.0 * m12 * c * s + m11 * s * s) / det
        change = (math.sqrt(norm2) - 1.0) * norm2 / slope
        g += change
        if not abs(change) > 1e-15 * g:
            break
    norm = math.sqrt(c * c + s * s)
    return c / norm, s / norm, g
