"""Contact of a prism over a plane curve (B, a profile) with convex solids (A), by sections across its axis.

The curve c(s) runs counter-clockwise, so n = (t_y, -t_x) points out of the solid. In a section, A is a
polygon rounded by a circle of radius r: one vertex for a ball, a capsule or a cylinder with parallel axis.
Each of these is a point of the contact:

    a vertex q of A      feet where |c - q| is least nearby: gap = n . (q - c) - r
    a face of A          points of the curve farthest towards it, beside the face: gap = height over it - r

Both are greatest values of m . c + w c . c/2, with m = q, w = -1 and with m = -n of the face, w = 0: there
(m + w c) . c' changes sign from + to -, and Newton's method finds the place within a row. Blocks of rows that
are too far away are passed over: a block is no farther from the start of its middle row than its arc is long.
Contacts along the thickness have a point at each end of it.

Between two places where the curve is most hollow only one foot can be nearest to a point outside: between two
feet is a place where the distance d is greatest, with a curvature below -1/d; it decreases towards one of these
places, so that a foot beyond the other would be farther. So the number of this stretch of the curve names the
point. For a small circle, which goes along the bottom of a hollow, the hollow is no end of a stretch.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision import thresholds as limits
from carom.collision.faces import normal_of_face, vertex
from carom.collision.features import NOBODY, OF_B, OF_SUPPORT, face_part
from carom.collision.found import put, put_parts
from carom.collision.frame import from_a, point_of_a
from carom.collision.layout import BOX, CYLINDER, HULL, POINT
from carom.collision.profile_curve import (
    ROWS_TOGETHER,
    block_at,
    curve_at,
    is_peak,
    is_straight,
    part_of_place,
    peak_in_row,
    stretch,
)
from carom.collision.profile_faces import (
    crossing,
    faces_of,
    on_face,
)
from carom.geometry.thresholds import ROUND_OFF


@kernel
def _feet(pair, q, r, reach, number, first):
    """Add the feet of a vertex q of A, whose circle has the radius r; return the new count.

    The nearest of all tells whether q is outside. If so, feet on whose outer side it is count; else only this.
    Feet that are farther than the nearest by more than `reach` are left out where that spares work.
    """
    b, rows, found = pair.b, pair.hulls.outlines, pair.found
    mx, my, z = q
    count, nearest, least, most = first, first, math.inf, math.inf
    scale = r + limits.SIDE_REACH * min(pair.a.extent, b.extent)
    for k in range(b.first, b.last, ROWS_TOGETHER):
        _, at, _ = block_at(rows, k, b.last)
        x, y = rows[at].c[0, 0] - mx, rows[at].c[0, 1] - my
        most = min(most, x * x + y * y)
    most = math.sqrt(most) + reach + ROUND_OFF * b.extent
    for start in range(b.first, b.last, ROWS_TOGETHER):
        end, at, arc = block_at(rows, start, b.last)
        x, y = rows[at].c[0, 0] - mx, rows[at].c[0, 1] - my
        if x * x + y * y > (most + arc) * (most + arc):
            continue
        for k in range(start, end):
            if not is_peak(rows, k, mx, my, -1.0, 0.0) or count >= len(found):
                continue
            h = rows[k + 1].start - rows[k].start
            t = peak_in_row(rows[k], h, mx, my, -1.0) if h > 0.0 else 0.0
            x, y, dx, dy, _, _ = curve_at(rows[k], t)
            f = 1.0 / math.sqrt(dx * dx + dy * dy)
            nx, ny, ux, uy = f * dy, -f * dx, mx - x, my - y
            d = nx * ux + ny * uy
            if h == 0.0:  # a corner: the mean of both normals says on which side q is
                after = rows[k + 1].c
                side = d + after[1, 1] * ux - after[1, 0] * uy
                d = math.copysign(math.sqrt(ux * ux + uy * uy), side)
                if d != 0.0:
                    nx, ny = ux / d, uy / d
            row, on_a = found[count], (mx, my, z)
            if pair.a.kind == CYLINDER:
                on_a = (mx - r * nx, my - r * ny, z)
            name = (number << 30) | stretch(b, pair.hulls, rows[k].start + t, scale)
            put(row, d - r, (nx, ny, 0.0), on_a, (x, y, z), (2 << 60) | name)
            put_parts(row, NOBODY, OF_SUPPORT, part_of_place(b, pair.hulls, k, t))
            if abs(d) < least:
                least, nearest = abs(d), count
            count += 1
    if count > first and found[nearest].gap + r < 0.0:
        if nearest > first:
            found[first] = found[nearest]
        return first + 1
    kept = first
    for k in range(first, count):
        if found[k].gap + r >= 0.0:
            if k > kept:
                found[kept] = found[k]
            kept += 1
    return kept


@kernel
def _beside(pair, z):
    """Write the point of a ball at a height beyond the flat sides of the profile: on a side, or on its rim."""
    b, s, found = pair.b, pair.state, pair.found
    up, r = math.copysign(1.0, z), pair.a.radius
    high, x, y = abs(z) - b.half[2], s.p[0], s.p[1]
    count = _feet(pair, (x, y, z), 0.0, 0.0, 0, 0)
    nearest = 0
    for k in range(1, count):
        nearest = k if abs(found[k].gap) < abs(found[nearest].gap) else nearest
    row = found[nearest]
    d, side = row.gap, up * b.half[2]
    if d <= 0.0:  # over a flat side
        put(found[0], high - r, (0.0, 0.0, up), (x, y, z), (x, y, side), (2 << 60) | (1 << 29))
        put_parts(found[0], OF_B, OF_SUPPORT, face_part(0))
        return 1
    away = math.sqrt(d * d + high * high)
    n = (d * row.normal[0] / away, d * row.normal[1] / away, up * high / away)
    part, feature = row.parts[1], row.feature | (1 << 28)
    put(found[0], away - r, n, (x, y, z), (row.on_b[0], row.on_b[1], side), feature)
    put_parts(found[0], NOBODY, OF_SUPPORT, part)
    return 1


@kernel
def axis_of(pair):
    """Return which axis of A is most along the axis of the profile, and the direction of that axis of A."""
    s, kind = pair.state, pair.a.kind
    if kind == POINT:
        return 2, 0.0, 0.0, 1.0
    if kind == HULL:  # a prism: the normal of a face across the axis
        x, y, z = 0.0, 0.0, 0.0
        for k in range(faces_of(pair.a)):
            n = normal_of_face(pair.a, pair.hulls, k)
            nx, ny, nz = from_a(s, n[0], n[1], n[2])
            if abs(nz) > abs(z):
                x, y, z = nx, ny, nz
        return 2, x, y, z
    axis = 2
    if kind == BOX:
        for k in range(2):
            axis = k if abs(s.R[2, k]) > abs(s.R[2, axis]) else axis
    return axis, s.R[0, axis], s.R[1, axis], s.R[2, axis]


@kernel
def _sections(pair, low, high, reach, axis):
    """Add the points of sections at both ends of a common thickness; return how many."""
    s, a, hulls = pair.state, pair.a, pair.hulls
    r = a.half[0] if a.kind == CYLINDER else a.radius
    which, x, y, z = axis
    sections, count = 2 if high > low else 1, 0
    corners = 8 if a.kind == BOX else a.last - a.first if a.kind == HULL else 1
    upright = a.kind != HULL and abs(x) + abs(y) < ROUND_OFF  # both sections are the same
    for end in range(sections):
        level, before = high if end == 1 else low, count
        if end == 1 and upright:
            for k in range(min(before, len(pair.found) - before)):
                row = pair.found[before + k]
                pair.found[before + k] = pair.found[k]
                row.on_a[2], row.on_b[2] = level, level
                row.feature |= 1 << 29
            return before + min(before, len(pair.found) - before)
        for i in range(corners):
            p = (0.0, 0.0, 0.0)
            if corners > 1:
                p = vertex(a, hulls, i)
                if (
                    a.kind == BOX and p[which] > 0.0
                ):  # an edge along the axis has one point in a section
                    continue
            p = point_of_a(s, p[0], p[1], p[2])
            if a.kind == HULL and p[2] > s.p[2]:
                continue
            f = (level - p[2]) / z
            count = _feet(pair, (p[0] + f * x, p[1] + f * y, level), r, reach, i, count)
        for i in range(faces_of(a)):
            count = on_face(pair, i, level, reach, count)
        for k in range(before, count):
            pair.found[k].feature |= end << 29
    return count


@kernel
def profile_pair(pair, reach):
    """Find the points of a convex solid (A) and a profile (B); return their number.

    Beyond its thickness only a ball touches it. For other solids there the gap is a distance along the axis.
    """
    s, a, b, found = pair.state, pair.a, pair.b, pair.found
    half, axis = b.half[2], axis_of(pair)
    if a.kind == POINT and not abs(s.p[2]) <= half:
        return _beside(pair, s.p[2])
    own = 0.0
    if a.kind == HULL:
        for i in range(a.last - a.first):
            p = vertex(a, pair.hulls, i)
            own = max(own, abs(point_of_a(s, p[0], p[1], p[2])[2] - s.p[2]))
    elif a.kind != POINT:
        own = a.half[axis[0]]
    low, high = max(-half, s.p[2] - own), min(half, s.p[2] + own)
    if low > high or (low == high and own > 0.0):
        up = math.copysign(1.0, s.p[2])
        gap = max(abs(s.p[2]) - half - own, 0.0) + half + own
        on_b = (s.p[0], s.p[1], s.p[2] - up * (gap + own))
        put(found[0], gap, (0.0, 0.0, up), (s.p[0], s.p[1], s.p[2] - up * own), on_b, 2 << 60)
        put_parts(found[0], OF_B, OF_SUPPORT, face_part(0))
        return 1
    if abs(axis[3]) < limits.PARALLEL:  # such sections are none: the run must end
        put(found[0], math.nan, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 2 << 60)
        return 1
    count = _sections(pair, low, high, reach, axis)
    least = math.inf
    for k in range(count):
        least = min(least, found[k].gap)
    if faces_of(a) > 0 and least >= -a.radius:
        before = count
        count = crossing(pair, 0.5 * (low + high), count)
        least = found[before].gap if count > before else least
    kept, most = 0, least + reach + ROUND_OFF * min(a.extent, b.extent)
    for k in range(count):
        if found[k].gap <= most:
            if k > kept:
                found[kept] = found[k]
            kept += 1
    return kept


@kernel
def lowest_of_profile(a, hulls, seen, reach, found):
    """Add the lowest points of a profile (A) over a half-space, in axes of the solid; return how many.

    The gap of a point p is seen[3] + p . (seen[0], seen[1], seen[2]).
    """
    ux, uy, uz, height = seen
    rows, count, least = hulls.outlines, 0, math.inf
    across, most = math.sqrt(ux * ux + uy * uy), math.inf
    for k in range(a.first, a.last, ROWS_TOGETHER):
        _, at, _ = block_at(rows, k, a.last)
        most = min(most, ux * rows[at].c[0, 0] + uy * rows[at].c[0, 1])
    most += reach + ROUND_OFF * a.extent
    for start in range(a.first, a.last, ROWS_TOGETHER):
        end, at, arc = block_at(rows, start, a.last)
        if ux * rows[at].c[0, 0] + uy * rows[at].c[0, 1] > most + across * arc:
            continue
        for k in range(start, end):
            if not is_peak(rows, k, -ux, -uy, 0.0, limits.NEARLY_FLAT):
                continue
            h = rows[k + 1].start - rows[k].start
            if is_straight(rows[k], h):
                continue
            t = peak_in_row(rows[k], h, -ux, -uy, 0.0) if h > 0.0 else 0.0
            x, y, _, _, _, _ = curve_at(rows[k], t)
            name, part = (
                stretch(a, hulls, rows[k].start + t, math.inf),
                part_of_place(a, hulls, k, t),
            )
            for end in range(2):
                z = a.half[2] if end == 1 else -a.half[2]
                if count < len(found):
                    gap = height + x * ux + y * uy + z * uz
                    put(
                        found[count],
                        gap,
                        (0.0, 0.0, 0.0),
                        (x, y, z),
                        (x, y, z),
                        (1 << 60) | ((name + (end << 14)) << 45),
                    )
                    put_parts(found[count], NOBODY, part, 0)
                    least = min(least, gap)
                    count += 1
    kept, most = 0, least + reach + ROUND_OFF * a.extent
    for k in range(count):
        if found[k].gap <= most:
            if k > kept:
                found[kept] = found[k]
            kept += 1
    return kept
