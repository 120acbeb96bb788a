"""Level surfaces: faces of static solids in one plane, which bound a solid without edges between them.

A surface R is a union of convex faces. Near a point in the interior of R, the static solids fill the half-space
below the plane, even where the point is on an edge between two faces. So a contact there has the normal of the
plane, and its gap is the height above the plane. Only the rim of R, the parts of the edges beyond which no face
continues, can obstruct.

A side of a face is given by m and d, with m the unit normal in the plane that points into the face: a point q
is at the depth m . q - d inside this side.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.thresholds import MARGIN
from carom.geometry.thresholds import RESOLUTION
from carom.geometry.vectors import dot, minus, plus


@kernel
def height(surface, q):
    """Return the height of a point above the plane of a surface."""
    return dot(surface.normal, q) - surface.offset


@kernel
def depth_in_face(levels, face, q):
    """Return the distance of a point from the nearest side of a face, negative outside."""
    least = math.inf
    for k in range(face.first, face.last):
        side = levels.sides[k]
        least = min(least, dot(side.inward, q) - side.level)
    return least


@kernel
def face_below(levels, first, last, q, tolerance):
    """Return the first of a range of faces in whose column a point is, -1 for none."""
    for i in range(first, last):
        face, d = levels.faces[i], minus(q, levels.faces[i].centre)
        near = dot(d, d) <= (face.reach + tolerance) ** 2
        if near and depth_in_face(levels, face, q) >= -tolerance:
            return i
    return -1


@kernel
def nearest_face(levels, first, last, q):
    """Return the face of a range whose column is nearest to a point."""
    best, chosen = -math.inf, first
    for i in range(first, last):
        depth = depth_in_face(levels, levels.faces[i], q)
        if depth > best:
            best, chosen = depth, i
    return chosen


@kernel
def distance_from_rim(levels, surface, q):
    """Return the distance of a point from the rim of a surface; infinite if there is no rim."""
    least = math.inf
    for i in range(surface.first_rim, surface.last_rim):
        a, b = levels.rims[i].begin, levels.rims[i].end
        u, v = minus(b, a), minus(q, a)
        v = plus(v, -max(0.0, min(1.0, dot(u, v) / dot(u, u))), u)
        least = min(least, dot(v, v))
    return math.sqrt(least)


@kernel
def carries(levels, surface, first, last, touch, rounding):
    """Return whether the faces from `first` to `last` carry a point of a contact.

    `rounding` is the radius of curvature of the body there.

    A point below the plane is carried if the way out through the plane is the shortest: shorter than that
    through the rim, and than that through the back of the solid.
    """
    q, gap, room = touch.on_b, touch.gap, MARGIN * surface.tolerance
    i = face_below(levels, first, last, q, room)
    if i < 0:
        return False
    if gap >= -room:
        return True
    if -gap > 0.5 * levels.faces[i].thickness:
        return False
    return -gap - rounding <= distance_from_rim(levels, surface, q)


@kernel
def continues(levels, surface, q, m):
    """Return whether a face through q continues along m, so that m is no normal of the surface at q."""
    room = MARGIN * surface.tolerance
    for i in range(surface.first, surface.last):
        face = levels.faces[i]
        if face_below(levels, i, i + 1, q, room) < 0:
            continue
        for k in range(face.first, face.last):
            if dot(m, minus(levels.sides[k].corner, q)) > RESOLUTION * face.reach + room:
                return True
    return False
