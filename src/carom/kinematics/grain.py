"""Anisotropic friction: tangents along and across the grain of a surface, in which its cone is circular.

An elliptic cone (F_1/mu_1)^2 + (F_2/mu_2)^2 <= N^2 with slip along its normal is Coulomb's cone of
mu = sqrt(mu_1 mu_2) in the rows t_i' = (mu_i/mu) t_i: u_i' = (mu_i/mu) u_i and F_i' = (mu/mu_i) F_i have the
same power, |F'| <= mu N is the ellipse, and F' against u' its normal (mathematics page, §1.10). So the tangents
of a point with a grain are perpendicular, but no unit vectors.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.geometry.rotation import cross, norm, rotate
from carom.kinematics.thresholds import LEAST_GRAIN
from carom.model.arrays import BODY_AXES, OTHER_AXES


@unit
def lay_along_grain(contact, state, point):
    """Turn the tangents of a point along and across the grain, with their lengths (mu_i/mu)."""
    g0, g1, g2 = contact.grain[0], contact.grain[1], contact.grain[2]
    if contact.grain_of == BODY_AXES:
        q = state[contact.body].Q
        g0, g1, g2 = rotate(q, contact.grain)
    elif contact.grain_of == OTHER_AXES:
        q = state[contact.other].Q
        g0, g1, g2 = rotate(q, contact.grain)
    n, first, second = point.axes[0], point.axes[1], point.axes[2]
    along = n[0] * g0 + n[1] * g1 + n[2] * g2
    g0, g1, g2 = g0 - along * n[0], g1 - along * n[1], g2 - along * n[2]
    sine = norm((g0, g1, g2))
    if not sine > 0.0:
        return
    g0, g1, g2 = g0 / sine, g1 / sine, g2 / sine
    c = cross(n[0], n[1], n[2], g0, g1, g2)
    s = contact.across ** (0.5 * share_of_grain(sine))
    first[0], first[1], first[2] = g0 / s, g1 / s, g2 / s
    second[0], second[1], second[2] = s * c[0], s * c[1], s * c[2]


@kernel
def share_of_grain(sine):
    """Return the exponent that makes friction isotropic where the grain is normal to the surface.

    It is 1 from the sine `LEAST_GRAIN` on, and below that the smooth step 10 x^3 - 15 x^4 + 6 x^5.
    """
    x = min(sine / LEAST_GRAIN, 1.0)
    return x * x * x * (10.0 + x * (6.0 * x - 15.0))


@kernel
def lengths_of_tangents(point):
    """Return the lengths of both tangents, which are 1 without a grain but for round-off."""
    return norm(point.axes[1]), norm(point.axes[2])


@kernel
def turn_plain(contact, turns, length, point):
    """Make a point that of rolling or pivoting friction, which is isotropic, if `turns` is above 0."""
    point.turns, point.length = turns, length
    if contact.grain_of != 0 and turns > 0:
        s = lengths_of_tangents(point)
        for i in range(2):
            for k in range(3):
                point.axes[1 + i, k] /= s[i]
