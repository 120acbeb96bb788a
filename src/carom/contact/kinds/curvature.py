"""The curvatures of the surface of a solid at a contact point."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.implicit import field_at, times
from carom.collision.layout import CURVED_GROUND, CYLINDER, ELLIPSOID, POINT, SEGMENT
from carom.collision.support import change_of_support
from carom.contact.kinds.partner import pose_of
from carom.geometry.rotation import rotate_back
from carom.geometry.thresholds import RESOLUTION
from carom.geometry.vectors import dot


@kernel
def place_and_axes(point, state):
    """Return the normal and both tangents of a contact point, and its place in the world."""
    x, arm = state[point.a].x, point.arm_a
    place = (x[0] + arm[0], x[1] + arm[1], x[2] + arm[2])
    return _vector(point.axes[0]), _vector(point.axes[1]), _vector(point.axes[2]), place


@kernel
def curvature(system, k, b, state, frame):
    """Return the curvatures (t t, t s, s s) of solid k of body b at a place with the normal n.

    They are above 0 where it is convex. Faces and edges count as flat.
    """
    solid, (n, t, s, place) = system.solids[k], frame
    x, q = pose_of(solid, b, state)
    n, t, s = rotate_back(q, n), rotate_back(q, t), rotate_back(q, s)
    r, half, kind = solid.radius, solid.half, solid.kind
    if kind == CURVED_GROUND:
        surface = system.hulls.surfaces[solid.surface]
        at = (place[0] - x[0], place[1] - x[1], place[2] - x[2])
        _, g, H = field_at(surface, system.hulls, rotate_back(q, at))
        size = math.sqrt(dot(g, g))
        if dot(g, n) < (1.0 - RESOLUTION) * size:  # on one of its planes
            return 0.0, 0.0, 0.0
        Ht, Hs = times(H, t), times(H, s)
        return dot(t, Ht) / size, dot(t, Hs) / size, dot(s, Hs) / size
    if kind == ELLIPSOID:
        Ht, Hs = change_of_support(solid, n, t), change_of_support(solid, n, s)
        a, b_, c = r + dot(t, Ht), dot(t, Hs), r + dot(s, Hs)
        f = 1.0 / (a * c - b_ * b_)
        return f * c, -f * b_, f * a
    if kind in (SEGMENT, CYLINDER) and abs(n[2]) <= RESOLUTION:
        f = 1.0 / (r + (half[0] if kind == CYLINDER else 0.0))
        return f * (1.0 - t[2] * t[2]), -f * t[2] * s[2], f * (1.0 - s[2] * s[2])
    if kind in (POINT, SEGMENT):
        return 1.0 / r, 0.0, 1.0 / r
    return 0.0, 0.0, 0.0


@kernel
def _vector(a):
    return a[0], a[1], a[2]
