"""Wedging: W is singular during the impact, so the normal impulse changes no velocity (mathematics page, §1.9).

If joints leave a body few degrees of freedom, W has rank 1 or 2. With z = (1, tau), z.W z is k - mu g in slip
that grows at the rate g, and k in stick. Since z.W z >= 0, k <= 0 and g >= 0 imply W z = 0: friction blocks the
pair, however large the impulse is.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.thresholds import EPSILON, REMAINDER, ROUND_OFF, SUM_ERROR
from carom.impact.thresholds import ENERGY_BALANCE


@kernel
def moves_nothing(m, t1, t2, k, grow):
    """Return whether the impulse p (1, t1, t2) changes no velocity, `m` as in `slip_step`.

    k = du_n/dp is compared with the products whose sum is z.W z; `grow` is d|u_t|/dp (0 in stick).
    """
    a1, a2, b = m[1] * t1, m[2] * t2, m[4] * t1 * t2
    terms = m[0] + 2.0 * (abs(a1) + abs(a2) + abs(b)) + m[3] * t1 * t1 + m[5] * t2 * t2
    # W itself may be a difference; its errors are then round-off of its greatest entry.
    own = max(m[0], m[3], m[5]) * min(1.0, (abs(a1) + abs(a2)) / m[0]) if grow == 0.0 else 0.0
    if not abs(k) > ROUND_OFF * terms + SUM_ERROR * own:
        k = 0.0
    sides = abs(m[1]) + abs(m[2]) + (m[3] + m[5]) * math.sqrt(t1 * t1 + t2 * t2)
    return k <= 0.0 and grow >= -ROUND_OFF * sides


@kernel
def below_round_off(m, p, p1, p2, energy):
    """Return whether round-off of P.W P, P the impulse of restitution, is visible in the energy balance.

    `energy` was lost in compression. Only Newton's law requires such large impulses if k is nearly zero:
    p = e v0/k, while Stronge's p grows only with 1/sqrt(k).
    """
    p, p1, p2 = abs(p), abs(p1), abs(p2)
    both = m[0] * p * p + m[3] * p1 * p1 + m[5] * p2 * p2
    both += 2.0 * (abs(m[1]) * p * p1 + abs(m[2]) * p * p2 + abs(m[4]) * p1 * p2)
    return not EPSILON * both <= ENERGY_BALANCE * energy


@kernel
def pushed(u_n, size, still):
    """Return whether a wedged pair approaches faster than `still`, so that no impulse stops it."""
    return not u_n >= -max(REMAINDER * size, still)


@kernel
def power_of_two(x):
    """Return the power of two just above x > 0: division by it causes no rounding."""
    _, exponent = math.frexp(x)
    return math.ldexp(1.0, exponent)
