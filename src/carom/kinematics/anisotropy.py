"""Anisotropic friction: tangents along and across the axis of anisotropy, in which its cone is circular.

An elliptic cone (F_1/mu_1)^2 + (F_2/mu_2)^2 <= N^2 with slip along its normal is Coulomb's cone of
mu = sqrt(mu_1 mu_2) in the rows t_i' = (mu_i/mu) t_i: u_i' = (mu_i/mu) u_i and F_i' = (mu/mu_i) F_i have the
same power, |F'| <= mu N is the ellipse, and F' against u' its normal (mathematics page, §1.10). So the tangents
of a point with anisotropic friction are perpendicular, but no unit vectors.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.geometry.rotation import cross, norm, rotate
from carom.kinematics.thresholds import LEAST_ANGLE
from carom.model.arrays import BODY_AXES, OTHER_AXES
from carom.model.workspace import MOTION_POINT


@unit
def lay_along_axis(contact, state, point):
    """Turn the tangents of a point along and across the axis of anisotropy, with their lengths (mu_i/mu)."""
    g0, g1, g2 = contact.friction_axis[0], contact.friction_axis[1], contact.friction_axis[2]
    if contact.axis_of == BODY_AXES:
        q = state[contact.body].Q
        g0, g1, g2 = rotate(q, contact.friction_axis)
    elif contact.axis_of == OTHER_AXES:
        q = state[contact.other].Q
        g0, g1, g2 = rotate(q, contact.friction_axis)
    n, first, second = point.axes[0], point.axes[1], point.axes[2]
    along = n[0] * g0 + n[1] * g1 + n[2] * g2
    g0, g1, g2 = g0 - along * n[0], g1 - along * n[1], g2 - along * n[2]
    sine = norm((g0, g1, g2))
    if not sine > 0.0:
        return
    g0, g1, g2 = g0 / sine, g1 / sine, g2 / sine
    c = cross(n[0], n[1], n[2], g0, g1, g2)
    s = contact.across ** (0.5 * share_of_axis(sine))
    first[0], first[1], first[2] = g0 / s, g1 / s, g2 / s
    second[0], second[1], second[2] = s * c[0], s * c[1], s * c[2]


@kernel
def share_of_axis(sine):
    """Return the exponent that makes friction isotropic where the axis is normal to the surface.

    It is 1 from the sine `LEAST_GRAIN` on, and below that the smooth step 10 x^3 - 15 x^4 + 6 x^5.
    """
    x = min(sine / LEAST_ANGLE, 1.0)
    return x * x * x * (10.0 + x * (6.0 * x - 15.0))


@kernel
def lengths_of_tangents(point):
    """Return the lengths of both tangents, which are 1 of isotropic friction but for round-off."""
    return norm(point.axes[1]), norm(point.axes[2])


@kernel
def turn_plain(contact, motion, length, point):
    """Make a point that of rolling or pivoting friction, which is isotropic, if `motion` is one of them."""
    point.motion, point.length = motion, length
    if contact.axis_of != 0 and motion != MOTION_POINT:
        s = lengths_of_tangents(point)
        for i in range(2):
            for k in range(3):
                point.axes[1 + i, k] /= s[i]
