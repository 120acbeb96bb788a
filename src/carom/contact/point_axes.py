"""The axes of a contact point: the normal, and two tangents that change steadily with it."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.rotation import cross
from carom.geometry.vectors import dot, plus


@kernel
def tangents(n0, n1, n2, axes):
    """Write rows n, t1, t2: t1 is the tangent part of world x, or of y if n is near x; t2 = n x t1.

    The axis with the least component along n is not used: if two are equal, round-off would decide each time.
    """
    e0, e1, e2 = (1.0, 0.0, 0.0) if abs(n0) < 0.8 else (0.0, 1.0, 0.0)
    d = e0 * n0 + e1 * n1 + e2 * n2
    t0, t1, t2 = e0 - d * n0, e1 - d * n1, e2 - d * n2
    s = 1.0 / math.sqrt(t0 * t0 + t1 * t1 + t2 * t2)
    t0, t1, t2 = s * t0, s * t1, s * t2
    axes[0, 0], axes[0, 1], axes[0, 2] = n0, n1, n2
    axes[1, 0], axes[1, 1], axes[1, 2] = t0, t1, t2
    axes[2, 0], axes[2, 1], axes[2, 2] = cross(n0, n1, n2, t0, t1, t2)


@kernel
def turned_axes(n, e, axes):
    """Write rows n, t1, t2: t1 and t2 are e[1] and e[2] after the shortest turn from e[0] to n.

    They change steadily with n, so that a slip keeps its direction; only at n = -e[0] is the turn not unique.
    """
    e0, e1 = (e[0, 0], e[0, 1], e[0, 2]), (e[1, 0], e[1, 1], e[1, 2])
    divisor = 1.0 + dot(n, e0)
    f = -dot(n, e1) / divisor if divisor > 0.0 else 0.0
    t = plus(plus(e1, f, n), f, e0)
    s = 1.0 / math.sqrt(dot(t, t))
    axes[0, 0], axes[0, 1], axes[0, 2] = n[0], n[1], n[2]
    axes[1, 0], axes[1, 1], axes[1, 2] = s * t[0], s * t[1], s * t[2]
    axes[2, 0], axes[2, 1], axes[2, 2] = cross(n[0], n[1], n[2], s * t[0], s * t[1], s * t[2])
