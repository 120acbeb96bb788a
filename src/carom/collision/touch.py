"""The points that carry the contact of two solids: `touch`.

Pairs of spheres, capsules and boxes are solved in closed form, all others by `convex.closest`; so are two boxes
whose nearest parts are vertices, or edges that do not cross. The points are those of the overlap of two
opposite faces, or the ends of the line along which two edges lie. They always include a nearest pair of points.
Pairs with a profile have kernels of their own (`carom.collision.profile`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import by_reference, entry, kernel
from carom._compiled.units import unit
from carom.collision.box import point_box, segment_box
from carom.collision.box_box import face_or_edges
from carom.collision.clip import overlap
from carom.collision.convex import closest
from carom.collision.faces import load_face
from carom.collision.features import EDGES, NOBODY
from carom.collision.found import hand_on, swap
from carom.collision.frame import enter
from carom.collision.layout import BOX, CURVED_GROUND, CYLINDER, POINT, PROFILE, SEGMENT, Pair
from carom.collision.on_surface import on_surface
from carom.collision.profile import profile_pair
from carom.collision.round import (
    discs_in_one_plane,
    point_point,
    point_segment,
    segment_segment,
)
from carom.collision.segments import are_parallel, ends_of_line
from carom.collision.support import separation
from carom.collision.thresholds import FACING, REFERENCE_GAIN
from carom.collision.two_profiles import two_profiles
from carom.geometry.thresholds import ROUND_OFF


@entry
def touch(a, b, hulls, reach, work, out):
    """Write the points of the contact of two solids to `out` (8,); return how many.

    Parameters
    ----------
    a, b : Placed
        Records of a table of `layout.solid_table`, with world poses (of the bodies combined with `x`, `Q`
        of the solids).
    hulls : Hulls
    reach : float
        Points with gaps up to the least gap plus `reach` are given [m]; 0 gives the ones at the least gap.
    work : PairWork
    out : TOUCH_POINT (8,)
        The normal points from B to A. The least of the gaps is the distance of the two solids, negative
        where they overlap slightly.
    """
    touch_unit(a, b, hulls, reach, work, out)
    return work.state[0].total


@unit
def touch_unit(a, b, hulls, reach, work, out):
    """Do this for `touch` and for kernels: the number of points goes to ``work.state[0].total``."""
    flip = a.solid.kind > b.solid.kind
    if flip:
        a, b = b, a
    enter(work.state[0], a, b)
    pair = by_reference(
        Pair(a.solid, b.solid, hulls, work.state[0], work.found, work.poses, work.known)
    )
    if b.solid.kind == CURVED_GROUND:
        on_surface(a.solid, b.solid, hulls, reach, work)
        count = work.state[0].total
    else:
        count = _ordered(pair, reach)
    work.state[0].total = hand_on(pair, count, flip, out)


@kernel
def _ordered(pair, reach):
    """Find the points of a pair in which the kind of A is not above that of B; return their number."""
    a, b = pair.a, pair.b
    boxes = a.kind == BOX and b.kind == BOX
    if b.kind == PROFILE:
        return two_profiles(pair, reach) if a.kind == PROFILE else profile_pair(pair, reach)
    if b.kind <= SEGMENT:
        if b.kind == POINT:
            point_point(pair)
            return 1
        if a.kind == POINT:
            point_segment(pair)
            return 1
        segment_segment(pair)
    elif b.kind == BOX and a.kind == POINT:
        point_box(pair)
        return 1
    elif b.kind == BOX and a.kind == SEGMENT:
        segment_box(pair)
    elif b.kind == CYLINDER and discs_in_one_plane(pair):
        return 1
    elif not (boxes and face_or_edges(pair)):
        closest(pair)
        boxes = False
    while True:
        count = _manifold(pair, reach)
        if not (boxes and pair.found[0].feature == 0):
            return count
        # No points of the two faces are as near as the axis says: the nearest points are vertices or on edges.
        closest(pair)
        boxes = False


@kernel
def _lowest_side(s, side, nx, ny, nz):
    """Return the two neighbouring corners of a face with the lowest mean along a direction."""
    count, best, chosen = s.count[side], 0.0, 0
    for k in range(count):
        p, q = s.corner[side, k], s.corner[side, (k + 1) % count]
        height = (p[0] + q[0]) * nx + (p[1] + q[1]) * ny + (p[2] + q[2]) * nz
        if k == 0 or height < best:
            best, chosen = height, k
    return chosen, (chosen + 1) % count


@kernel
def _manifold(pair, reach):
    """Add the other points of the contact to the nearest pair, the first in `found`; return the count."""
    s, a, b, found = pair.state, pair.a, pair.b, pair.found
    n = found[0].normal
    nx, ny, nz, least = n[0], n[1], n[2], found[0].gap
    tolerance = ROUND_OFF * min(a.extent, b.extent)
    on_a = load_face(pair, 0, -nx, -ny, -nz)
    on_b = load_face(pair, 1, nx, ny, nz)
    if s.count[0] < 2 or s.count[1] < 2:
        return 1
    most, count, name = least + reach, 1, found[0].feature
    if name >> 60 == EDGES and found[0].owner != NOBODY:
        found[
            0
        ].feature = 0  # on a face any two edges, or diagonals, cross: `overlap` knows which count
    if max(on_a, on_b) > FACING:
        ref = 1 if on_b + REFERENCE_GAIN >= on_a else 0
        m, f = s.normal[ref], 2.0 * ref - 1.0
        apart = separation(pair, f * m[0], f * m[1], f * m[2])
        if apart - a.inner - b.inner - (a.radius + b.radius) >= least - reach - tolerance:
            inc = 1 - ref
            mantle = (a.kind if inc == 0 else b.kind) == CYLINDER and s.count[inc] == 2
            if mantle:  # the line of the mantle that is lowest over the face
                load_face(pair, inc, -m[0], -m[1], -m[2])
            count = overlap(pair, ref, least - tolerance, most, count)
            if mantle:
                load_face(pair, inc, -f * nx, -f * ny, -f * nz)
    rims = (a.kind == CYLINDER and s.count[0] > 2) or (b.kind == CYLINDER and s.count[1] > 2)
    if not (rims or max(on_a, on_b) > 1.0 - ROUND_OFF):  # the sides of a rim's polygon are no edges
        ends_a, ends_b = _lowest_side(s, 0, nx, ny, nz), _lowest_side(s, 1, -nx, -ny, -nz)
        before = count
        count = ends_of_line(pair, ends_a, ends_b, most, count)
        if found[0].feature >> 60 == EDGES and count == before + 2:
            # a search finds parallel lines of mantles less exactly than their ends are known
            most = math.inf if are_parallel(s, ends_a, ends_b) else least + tolerance
            return _without_first(found, count, most, 2)
    if found[0].feature == 0:
        count = _without_first(found, count, least + tolerance, 1)
        found[0].feature = name if found[0].feature == 0 else found[0].feature
    return count


@kernel
def _without_first(found, count, most, enough):
    """Drop the first pair, an arbitrary one of parallel faces or edges, if `enough` others are as near."""
    near = 0
    for k in range(1, count):
        near += found[k].gap <= most
    if near < enough:
        return count
    swap(found, 0, count - 1)
    return count - 1
