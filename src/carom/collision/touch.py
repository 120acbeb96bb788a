"""The points that carry the contact of two solids: `touch`.

Sphere, capsule and box among themselves in closed form (two boxes whose vertices or edges face each other
without crossing by the general way), all others by `convex.closest`. The set is the overlap of the
two faces that look at each other, or the ends of the line along which two edges lie, with the nearest pair
of points always in it.
"""

from __future__ import annotations

from carom._compiled.decorators import entry, kernel
from carom._compiled.units import unit
from carom.collision.box import point_box, segment_box
from carom.collision.box_box import face_or_edges
from carom.collision.clip import overlap
from carom.collision.convex import closest
from carom.collision.faces import load_face
from carom.collision.features import EDGES
from carom.collision.found import hand_on
from carom.collision.frame import enter
from carom.collision.layout import BOX, POINT, SEGMENT
from carom.collision.round import point_point, point_segment, segment_segment
from carom.collision.segments import ends_of_line
from carom.collision.support import separation

ROUNDING = 1e-12  # relative to the smaller solid
ALIGNED = 0.7  # cosine of normal and face from which on the face can be the reference; it is, if it
# parts the solids to within the reach
ON_FACE = 1.0 - 1e-12  # from which on the normal is the face's


@entry
def touch(a, b, hulls, xa, qa, xb, qb, reach, work, out):
    """Write the points of the contact of two solids to `out` (8,); return how many.

    Parameters
    ----------
    a, b : SOLID
        Records of a table of `layout.solid_table`.
    hulls : Hulls
    xa, qa, xb, qb : (3,), (4,)
        World poses of the solids (of the bodies combined with `x`, `Q` of the solids).
    reach : float
        Points with gaps up to the least gap plus `reach` are given [m]; 0 gives the ones at the least gap.
    work : PairWork
    out : TOUCH_POINT (8,)
        The normal points from B to A. The least of the gaps is the distance of the two solids, negative
        where they overlap slightly.
    """
    s, found = work.state[0], work.found
    flip = a.kind > b.kind
    if flip:
        a, b = b, a
        xa, qa, xb, qb = xb, qb, xa, qa
    enter(s, xa, qa, xb, qb)
    count = _ordered(s, a, b, hulls, reach, found)
    return hand_on(s, found, count, a.radius, b.radius, flip, out)


@unit
def touch_unit(a, b, hulls, xa, qa, xb, qb, reach, work, out):
    """As `touch`, compiled once; the number of points goes to ``work.state[0].total``."""
    work.state[0].total = touch(a, b, hulls, xa, qa, xb, qb, reach, work, out)


@kernel
def _ordered(s, a, b, hulls, reach, found):
    """Find the points of a pair whose first kind is not above its second."""
    boxes = a.kind == BOX and b.kind == BOX
    if b.kind <= SEGMENT:
        if b.kind == POINT:
            point_point(s, a, b, found)
            return 1
        if a.kind == POINT:
            point_segment(s, a, b, found)
            return 1
        segment_segment(s, a, b, found)
    elif b.kind == BOX and a.kind == POINT:
        point_box(s, a, b, found)
        return 1
    elif b.kind == BOX and a.kind == SEGMENT:
        segment_box(s, a, b, found)
    elif not boxes:
        closest(s, a, b, hulls, found)
    elif not face_or_edges(s, a, b, found):
        closest(s, a, b, hulls, found)
        boxes = False
    while True:
        count = _manifold(s, a, b, hulls, reach, found)
        if not (boxes and found[0].feature == 0):
            return count
        # No points of the two faces are as near as the axis says: vertices or edges beside them are nearest.
        closest(s, a, b, hulls, found)
        boxes = False


@kernel
def _lowest_side(s, side, nx, ny, nz):
    """Return the two neighbouring corners of a face that are lowest along a direction, together."""
    count, best, chosen = s.count[side], 0.0, 0
    for k in range(count):
        p, q = s.corner[side, k], s.corner[side, (k + 1) % count]
        height = (p[0] + q[0]) * nx + (p[1] + q[1]) * ny + (p[2] + q[2]) * nz
        if k == 0 or height < best:
            best, chosen = height, k
    return chosen, (chosen + 1) % count


@kernel
def _manifold(s, a, b, hulls, reach, found):
    """Add to the nearest points, the first found, those that carry the contact with them."""
    n = found[0].normal
    nx, ny, nz, least = n[0], n[1], n[2], found[0].gap
    tolerance = ROUNDING * min(a.extent, b.extent)
    on_a = load_face(s, 0, a, hulls, -nx, -ny, -nz)
    on_b = load_face(s, 1, b, hulls, nx, ny, nz)
    if s.count[0] < 2 or s.count[1] < 2:
        return 1
    radii, most, count = a.radius + b.radius, least + reach, 1
    if max(on_a, on_b) > ALIGNED:
        ref = 1 if on_b + 1e-9 >= on_a else 0
        m, f = s.normal[ref], 2.0 * ref - 1.0
        apart = separation(s, a, b, hulls, f * m[0], f * m[1], f * m[2])
        if apart - a.inner - b.inner - radii >= least - reach - tolerance:
            count = overlap(s, ref, radii, least - tolerance, most, found, count)
    if not max(on_a, on_b) > ON_FACE:
        i, j = _lowest_side(s, 0, nx, ny, nz)
        k, l = _lowest_side(s, 1, -nx, -ny, -nz)
        before = count
        count = ends_of_line(s, i, j, k, l, radii, least - tolerance, most, found, count)
        if found[0].feature >> 60 == EDGES and count == before + 2:
            return _without_first(found, count, least + tolerance, 2)
    return _without_first(found, count, least + tolerance, 1) if found[0].feature == 0 else count


@kernel
def _without_first(found, count, most, enough):
    """Drop the nearest pair, any pair of two parallel faces or edges, if `enough` others are as near."""
    near = 0
    for k in range(1, count):
        near += found[k].gap <= most
    if near < enough:
        return count
    _copy(found, count - 1, 0)
    return count - 1


@kernel
def _copy(found, source, target):
    """Copy a point to another row."""
    a, b = found[source], found[target]
    b.gap, b.feature = a.gap, a.feature
    for i in range(3):
        b.normal[i], b.on_a[i], b.on_b[i] = a.normal[i], a.on_a[i], a.on_b[i]
