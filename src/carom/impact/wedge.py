"""Wedging: W is singular during the impact, so the normal impulse changes no velocity (mathematics page, §1.9).

A body that joints leave few freedoms has a W of rank 1 or 2. With z = (1, tau), z.W z = k - mu g for slip
that grows at the rate g, and k for stick: so k <= 0 without slip that fades means W z = 0, friction holds
the pair however large the impulse is.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel

#: a sum of products counts as none below this part of them: their errors are some 1e-15, and what is left is
#: known to a thousandth at least
_ROUND_OFF = 1e-12
_OF_W = 1e-14
_LAST_DIGIT = 2.2e-16
_BALANCE = (
    1e-6  # part of the energy that compression took to which the balance of an impact is known
)
#: a speed of approach counts as none below this part of the speed of impact: round-off, and the seed of a jam
_PUSHED = 1e-9


@kernel
def moves_nothing(m, t1, t2, k, grow):
    """Return whether the impulse p (1, t1, t2) changes no velocity, `m` as in `slip_step`.

    k = du_n/dp, judged by the products of z.W z from which it is left, and `grow` = d|u_t|/dp (0 in stick).
    """
    a1, a2, b = m[1] * t1, m[2] * t2, m[4] * t1 * t2
    terms = m[0] + 2.0 * (abs(a1) + abs(a2) + abs(b)) + m[3] * t1 * t1 + m[5] * t2 * t2
    # W itself may be a difference, known to the round-off of its greatest entry alone.
    own = max(m[0], m[3], m[5]) * min(1.0, (abs(a1) + abs(a2)) / m[0]) if grow == 0.0 else 0.0
    if not abs(k) > _ROUND_OFF * terms + _OF_W * own:
        k = 0.0
    sides = abs(m[1]) + abs(m[2]) + (m[3] + m[5]) * math.sqrt(t1 * t1 + t2 * t2)
    return k <= 0.0 and grow >= -_ROUND_OFF * sides


@kernel
def drowned(m, p, p1, p2, energy):
    """Return whether the round-off of P.W P, of an impulse of restitution, shows in the balance of energy.

    `energy` is what compression took. Only Newton's law asks for such impulses, as k comes near to nothing:
    p = e v0/k, where Stronge's p grows with 1/sqrt(k) only.
    """
    p, p1, p2 = abs(p), abs(p1), abs(p2)
    both = m[0] * p * p + m[3] * p1 * p1 + m[5] * p2 * p2
    both += 2.0 * (abs(m[1]) * p * p1 + abs(m[2]) * p * p2 + abs(m[4]) * p1 * p2)
    return not _LAST_DIGIT * both <= _BALANCE * energy


@kernel
def pushed(u_n, size, still):
    """Return whether a pair that nothing moves still approaches, faster than `still`: no impulse stops it."""
    return not u_n >= -max(_PUSHED * size, still)


@kernel
def power_of_two(x):
    """Return the power of two just above x > 0: a unit by which nothing is rounded."""
    _, exponent = math.frexp(x)
    return math.ldexp(1.0, exponent)
