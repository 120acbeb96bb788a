"""Contact of a solid (A) with a half-space (B), in closed form: the lowest points of the solid."""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom._compiled.units import unit
from carom.collision.faces import LOWEST, RIM, rim_point, vertex
from carom.collision.features import NOBODY, of_vertex_a
from carom.collision.found import put, put_parts, spread
from carom.collision.layout import BOX, CYLINDER, PROFILE, SEGMENT
from carom.collision.profile import lowest_of_profile
from carom.collision.support import support
from carom.geometry.rotation import rotate, rotate_back
from carom.geometry.thresholds import ROUND_OFF


@entry
def touch_plane(a, plane, hulls, reach, work, out):
    """Write the points of the contact of a solid with a half-space to `out` (8,); return how many.

    Arguments are those of `touch.touch`, and a `Plane`. The feature of a vertex is its number. A rim has up to
    four points: its lowest point, which moves along the rim in rolling (left out if the rim is flat on the
    plane), and points fixed in the body at quarters of a turn. More points would make a flat impact slow: their
    rows are linearly dependent, so that the points open and close in alternation.
    """
    plane_unit(a, plane, hulls, reach, work, out)
    return work.state[0].total


@unit
def plane_unit(a, plane, hulls, reach, work, out):
    """Do this for `touch_plane` and for kernels: the number of points goes to ``work.state[0].total``."""
    found, x, q, n, r = work.found, a.x, a.Q, plane.normal, a.solid.radius
    ux, uy, uz = rotate_back(q, n)
    seen = ux, uy, uz, x[0] * n[0] + x[1] * n[1] + x[2] * n[2] - plane.offset - r
    if a.solid.kind == CYLINDER:
        count = _rims(a.solid, seen, reach, found)
    elif a.solid.kind == PROFILE:
        count = lowest_of_profile(a.solid, hulls, seen, reach, found)
    else:
        count = _vertices(a.solid, hulls, seen, reach, found)
    count = spread(found, count, ROUND_OFF * a.solid.extent)
    for k in range(count):
        p, gap = found[k].on_a, found[k].gap
        px, py, pz = rotate(q, p)
        px, py, pz = x[0] + px - r * n[0], x[1] + py - r * n[1], x[2] + pz - r * n[2]
        foot = (px - gap * n[0], py - gap * n[1], pz - gap * n[2])
        put(out[k], gap, (n[0], n[1], n[2]), (px, py, pz), foot, found[k].feature)
        if a.solid.kind == PROFILE:
            put_parts(out[k], NOBODY, found[k].parts[0], 0)
    work.state[0].total = count


@kernel
def _add(found, count, seen, p, most, number):
    """Add a point of the core, in axes of the body, if its gap is at most `most`; return the new count."""
    gap = seen[3] + p[0] * seen[0] + p[1] * seen[1] + p[2] * seen[2]
    if not gap <= most or count >= len(found):
        return count
    put(found[count], gap, (0.0, 0.0, 0.0), p, p, of_vertex_a(number))
    return count + 1


@kernel
def _vertices(a, hulls, seen, reach, found):
    """Add the lowest point of the core, and all vertices that are higher by at most `reach`."""
    ux, uy, uz, height = seen
    px, py, pz, number = support(a, hulls, -ux, -uy, -uz)
    # For an ellipsoid: its own lowest point, not that of the smaller body inside it.
    px, py, pz = px - a.inner * ux, py - a.inner * uy, pz - a.inner * uz
    most = height + px * ux + py * uy + pz * uz
    count = _add(found, 0, seen, (px, py, pz), math.inf, number)
    more = 2 if a.kind == SEGMENT else 8 if a.kind == BOX else a.last - a.first
    for i in range(more):
        if i != number:
            count = _add(found, count, seen, vertex(a, hulls, i), most + reach, i)
    return count


@kernel
def _rims(a, seen, reach, found):
    """Add the points of the rims of a cylinder; a disc has one rim."""
    ux, uy, uz, height = seen
    r, h = a.half[0], a.half[2]
    across = math.sqrt(ux * ux + uy * uy)
    tilted = across > ROUND_OFF
    cx, cy = (-ux / across, -uy / across) if tilted else (-1.0, 0.0)  # towards the lowest point
    most = height - abs(uz) * h - r * across + reach + 2.0 * ROUND_OFF * (r + h)
    near = 2 * (math.floor(math.atan2(cy, cx) * (2.0 / math.pi) + 0.5) % 4)
    count, lower = 0, 1 if h > 0.0 and uz < 0.0 else 0
    for side in range(2 if h > 0.0 else 1):
        z = h if side == 1 else -h
        if side != lower and abs(uz) > 0.5:
            continue  # the upper rim carries nothing, even if a thin disc has it within the reach
        if tilted:
            count = _add(found, count, seen, (r * cx, r * cy, z), most, LOWEST + side)
        for k in range(0, RIM if abs(uz) > 0.5 else 0, 2):  # a steep rim has only its lowest point
            if not (tilted and k == near):  # the lowest point replaces the nearest fixed one
                c, s = rim_point(k)
                count = _add(found, count, seen, (r * c, r * s, z), most, side * RIM + k)
    return count
