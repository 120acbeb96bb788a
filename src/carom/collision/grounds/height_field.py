"""A height field: phi = z - h(x, y) with a bicubic spline h on a uniform grid."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel


@kernel
def _basis(u, count):
    """Return the first of four B-splines at u, in cells, and their values, slopes and second derivatives.

    Beyond the grid all coefficients are equal to the last one, so that u may be cut off there.
    """
    u = min(max(u, -3.0), count + 3.0)
    k = math.floor(u)
    t = u - k
    s = 1.0 - t
    value = (
        s * s * s / 6.0,
        (3.0 * t * t * (t - 2.0) + 4.0) / 6.0,
        (3.0 * t * (1.0 + t * s) + 1.0) / 6.0,
        t * t * t / 6.0,
    )
    slope = -0.5 * s * s, t * (1.5 * t - 2.0), 0.5 + t * (1.0 - 1.5 * t), 0.5 * t * t
    return k, value, slope, (s, 3.0 * t - 2.0, 1.0 - 3.0 * t, t)


@kernel
def onto(surface, hulls, p):
    """Return the point beneath p."""
    return p[0], p[1], p[2] - field_at(surface, hulls, p)[0]


@kernel
def field_at(surface, hulls, p):
    """Return phi, its gradient (3) and its Hessian (6) at a point."""
    numbers, n, m = hulls.numbers, surface.count[0], surface.count[1]
    dx, dy = surface.spacing[0], surface.spacing[1]
    i, w, w1, w2 = _basis((p[0] - surface.corner[0]) / dx, n)
    j, v, v1, v2 = _basis((p[1] - surface.corner[1]) / dy, m)
    h, hx, hy, hxx, hxy, hyy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for a in range(4):
        row = surface.first + min(max(i + a, 0), n + 2) * (m + 3)
        s, s1, s2 = 0.0, 0.0, 0.0
        for b in range(4):
            c = numbers[row + min(max(j + b, 0), m + 2)]
            s, s1, s2 = s + v[b] * c, s1 + v1[b] * c, s2 + v2[b] * c
        h, hx, hxx = h + w[a] * s, hx + w1[a] * s, hxx + w2[a] * s
        hy, hxy, hyy = hy + w[a] * s1, hxy + w1[a] * s1, hyy + w[a] * s2
    slope = -hx / dx, -hy / dy, 1.0
    return p[2] - h, slope, (-hxx / (dx * dx), -hyy / (dy * dy), 0.0, -hxy / (dx * dy), 0.0, 0.0)
