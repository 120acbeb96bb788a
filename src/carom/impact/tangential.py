"""Tangential restitution: an impact that ends in stick returns a part of the slip before it (rough spheres).

After the impact u_t = 0. A further impulse dP changes it to -e_t u_t^-, and leaves u_n as its law made it:

    dP_t = K^-1 (-e_t u_t^-),   K = W_tt - W_tn W_nt/W_nn,   dP_n = -W_nt.dP_t/W_nn.

Only the part s <= 1 of dP is applied with which the whole impulse is in the cone, |P_t| <= mu P_n, and which
returns no more energy than friction has taken (Garwin 1969; Walton 1993) and the impact has lost: the normal
force of Newton's or Poisson's law may have added some.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.friction.rays import solve_tangential
from carom.impact import layout as o


@entry
def return_slip(W, u, mu, e, out):
    """Add the impulse of tangential restitution `e` to the result `out` of an impact that began with u."""
    if int(out[o.PHASES]) & (o.PHASE_STICK | o.WEDGED) != o.PHASE_STICK:
        return
    a, b = W[0, 1] / W[0, 0], W[0, 2] / W[0, 0]
    x, y = -e * u[1], -e * u[2]
    t1, t2 = solve_tangential(
        W[1, 1] - a * W[0, 1], W[1, 2] - a * W[0, 2], W[2, 2] - b * W[0, 2], x, y
    )
    n = -(a * t1 + b * t2)
    p, p1, p2, lost = out[o.IMPULSE], out[o.IMPULSE + 1], out[o.IMPULSE + 2], out[o.FRICTION_LOSS]
    # |P_t + s dP_t|^2 = mu^2 (P_n + s dP_n)^2 at the cone
    cone = greatest_part(
        t1 * t1 + t2 * t2 - mu * mu * n * n,
        p1 * t1 + p2 * t2 - mu * mu * p * n,
        mu * mu * p * p - p1 * p1 - p2 * p2,
    )
    # dP_n u_n s + dP_t.du_t s^2/2 is the energy that comes back
    drawn, back = n * out[o.VELOCITY], 0.5 * (t1 * x + t2 * y)
    room = max(0.0, min(lost, -out[o.ENERGY_CHANGE]))
    s = min(cone, greatest_part(back, 0.5 * drawn, room))
    out[o.IMPULSE], out[o.IMPULSE + 1], out[o.IMPULSE + 2] = p + s * n, p1 + s * t1, p2 + s * t2
    out[o.VELOCITY + 1] += s * x
    out[o.VELOCITY + 2] += s * y
    gained = min(room, s * (drawn + s * back))
    out[o.FRICTION_LOSS] = lost - gained
    out[o.ENERGY_CHANGE] += gained


@kernel
def greatest_part(a, b, c):
    """Return the greatest s in [0, 1] up to which a s^2 + 2 b s <= c, for c >= 0."""
    if not c > 0.0:
        return 0.0
    square = b * b + a * c
    pivot = b + math.sqrt(square) if square >= 0.0 else 0.0
    return min(1.0, c / pivot) if pivot > 0.0 else 1.0
