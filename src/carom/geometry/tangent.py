"""Differential T of the exponential on SO(3) and its inverse, in scalars: kernels.

The formulas are those in `differential`, here for one rotation vector at a time.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry
from carom.geometry.rotation import cross


@entry
def coefficients(t2):
    """Return (1 - cos t)/t^2 and (t - sin t)/t^3 of the squared angle; below t = 1 by series."""
    if t2 < 1.0:
        first = 1.0
        second = 1.0
        for k in range(8, 0, -1):
            first = 1.0 - first * t2 / ((2 * k + 1) * (2 * k + 2))
            second = 1.0 - second * t2 / ((2 * k + 2) * (2 * k + 3))
        return first / 2.0, second / 6.0
    t = math.sqrt(t2)
    half = math.sin(0.5 * t)
    return 2.0 * half * half / t2, (t - math.sin(t)) / (t2 * t)


@entry
def inverse_coefficient(t2):
    """Return (1 - (t/2) cot(t/2))/t^2 of the squared angle; below t = 2 by series."""
    u2 = 0.25 * t2
    u = math.sqrt(u2)
    if u2 < 1.0:
        g = 1.0
        for k in range(9, 0, -1):
            g = 1.0 - g * u2 / (2 * k * (2 * k + 3))
        return g / 12.0 * (u / math.sin(u)) if u > 0.0 else 1.0 / 12.0
    return (math.sin(u) - u * math.cos(u)) / (4.0 * u2 * math.sin(u))


@entry
def apply(ax, ay, az, bx, by, bz):
    """Return T(a) b: the body angular velocity for the rate b of the rotation vector a."""
    first, second = coefficients(ax * ax + ay * ay + az * az)
    cx, cy, cz = cross(ax, ay, az, bx, by, bz)
    dx, dy, dz = cross(ax, ay, az, cx, cy, cz)
    return (
        bx - first * cx + second * dx,
        by - first * cy + second * dy,
        bz - first * cz + second * dz,
    )


@entry
def apply_inverse(ax, ay, az, bx, by, bz):
    """Return T(a)^-1 b, for |a| < 2 pi: the rate of a for the body angular velocity b."""
    f = inverse_coefficient(ax * ax + ay * ay + az * az)
    cx, cy, cz = cross(ax, ay, az, bx, by, bz)
    dx, dy, dz = cross(ax, ay, az, cx, cy, cz)
    return bx + 0.5 * cx + f * dx, by + 0.5 * cy + f * dy, bz + 0.5 * cz + f * dz
