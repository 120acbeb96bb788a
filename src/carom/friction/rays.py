"""At u_t = 0, where slip stops: stick, or a new start along the one ray that leads away.

With a = W_tn, B = W_tt (mathematics page, §1.9), du_t/dp = a - mu B e in slip in the direction e, and
B tau = -a in stick. Stick requires |tau| <= mu.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.friction.one_contact import eigenbasis
from carom.friction.thresholds import LEAST_TERM
from carom.geometry.thresholds import LAST_DIGIT, ROUND_OFF


@kernel
def solve_tangential(b11, b12, b22, x, y):
    """Return B^+ (x, y), the least-norm solution, for B symmetric and positive semidefinite."""
    trace = b11 + b22
    if not trace > 0.0:
        return 0.0, 0.0  # nothing moves in the plane of contact
    # Greater pivot first: B times the solution is (x, y) to round-off, even if B is nearly singular.
    if b11 >= b22:
        ratio = b12 / b11
        left = b22 - ratio * b12
        if left > ROUND_OFF * trace:
            second = (y - ratio * x) / left
            return (x - b12 * second) / b11, second
    else:
        ratio = b12 / b22
        left = b11 - ratio * b12
        if left > ROUND_OFF * trace:
            first = (x - ratio * y) / left
            return first, (y - b12 * first) / b22
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

    The ray satisfies a - mu B e = g e, so e = (mu B + g)^-1 a. |(mu B + g)^-1 a| decreases with g, from
    |B^-1 a|/mu > 1 at g = 0 to 0, so there is exactly one ray if mu is below the critical value. Newton's
    iteration on 1/|e(g)| converges to the root from below. If mu is the critical value to round-off, g is 0,
    |(c, s)| <= 1, and -mu (c, s) is the ratio of stick.
    """
    # In the principal axes of B, greater first, each component has only its own round-off, and |e| = 1.
    b1, _, x, y = eigenbasis(b11, b12, b22)
    p, q = x * a1 + y * a2, x * a2 - y * a1
    m1, m2 = mu * b1, (mu * max(0.0, (b11 * b22 - b12 * b12) / b1) if b1 > 0.0 else 0.0)
    size = math.sqrt(a1 * a1 + a2 * a2)
    least = LEAST_TERM * (size + m1)
    g = max(size - m1, least)  # |e(g)| >= size / (m1 + g): a lower bound of the root
    for _ in range(100):
        c, s = p / (m1 + g), q / (m2 + g)
        norm2 = c * c + s * s
        if not norm2 > 1.0 and g <= least:
            return x * c - y * s, y * c + x * s, 0.0
        change = (math.sqrt(norm2) - 1.0) * norm2 / (c * c / (m1 + g) + s * s / (m2 + g))
        if not change > LAST_DIGIT * g:
            break
        g += change
    norm = math.sqrt(norm2)
    c, s = c / norm, s / norm
    return x * c - y * s, y * c + x * s, g
