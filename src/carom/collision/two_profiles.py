"""Contact of two prisms over plane curves, both profiles, in a common plane.

In axes of B, with the outward normals n_a, n_b and the unit tangents t_a, t_b of the curves a(s) and b(t), a
point of the contact is a pair of places where the distance is least nearby:

    n_a x n_b = 0,   (a - b) . t_b = 0,   n_a . n_b < 0,   gap = n_b . (a - b).

Newton's method finds it for each two rows that are near each other; with n_a' = kappa_a t_a, t_b' = -kappa_b
n_b its matrix is regular where kappa_a + kappa_b + gap kappa_a kappa_b is not 0, and the distance is least
where this is above 0. A convex corner has all normals between those of its sides. Straight rows that are
parallel touch with their corners.

Far sides of both have such pairs, too: where the gap is below 0, nothing of the curve of B may be nearer to a
than b. Blocks of rows that are too far away are passed over (`carom.collision.profile`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision import thresholds as limits
from carom.collision.features import NOBODY, OF_B, OF_SUPPORT, face_part
from carom.collision.found import put, put_parts, swap
from carom.collision.known_poses import recall, remember
from carom.collision.layout import MOST_POINTS
from carom.collision.profile_curve import (
    ROWS_OF_BLOCKS,
    ROWS_TOGETHER,
    block_at,
    curve_at,
    is_peak,
    is_straight,
    part_of_place,
    peak_in_row,
    rows_at,
    stretch,
)
from carom.geometry.thresholds import ROUND_OFF

PAIR_STEPS = 30
CORNER = 1 << 14  # in a name: that of a corner


@inlined
def along_a(turn, x, y):
    """Return a direction of A in axes of B."""
    c, s, f, _, _ = turn
    return c * x - f * s * y, s * x + f * c * y


@inlined
def place_of_a(turn, x, y):
    """Return a place of A in axes of B."""
    c, s, f, px, py = turn
    return px + c * x - f * s * y, py + s * x + f * c * y


@inlined
def place_in_a(turn, x, y):
    """Return a place in axes of A."""
    c, s, f, px, py = turn
    x, y = x - px, y - py
    return c * x + s * y, f * (c * y - s * x)


@kernel
def turn_of_a(s):
    """Return how A is turned in the plane of B: cosine, sine, -1 if it is turned over, and its place."""
    R, p = s.R, s.p
    f = 1.0 / math.sqrt(R[0, 0] * R[0, 0] + R[1, 0] * R[1, 0])
    return f * R[0, 0], f * R[1, 0], math.copysign(1.0, R[2, 2]), p[0], p[1]


@kernel
def nearest_block(solid, rows, x, y):
    """Return the middle row of the block that is nearest to a place, in axes of the solid."""
    best, chosen = math.inf, solid.first
    for k in range(solid.first, solid.last, ROWS_TOGETHER):
        _, at, _ = block_at(rows, k, solid.last)
        dx, dy = rows[at].c[0, 0] - x, rows[at].c[0, 1] - y
        if dx * dx + dy * dy < best:
            best, chosen = dx * dx + dy * dy, at
    return chosen


@kernel
def far_bound(pair, turn):
    """Return an upper bound of the distance of the curves, that of two places near each other."""
    rows, (x, y) = pair.hulls.outlines, (turn[3], turn[4])
    least = math.inf
    for _ in range(2):
        c = rows[nearest_block(pair.b, rows, x, y)].c
        bx, by = c[0, 0], c[0, 1]
        qx, qy = place_in_a(turn, bx, by)
        c = rows[nearest_block(pair.a, rows, qx, qy)].c
        x, y = place_of_a(turn, c[0, 0], c[0, 1])
        least = min(least, math.sqrt((x - bx) ** 2 + (y - by) ** 2))
    return least


@kernel
def each_block(pair, turn, most, search):
    """Visit the blocks of both curves that may be within `most`.

    Return the least distance of the starts of their rows, or with `search` how many points were found.
    """
    a, b, rows = pair.a, pair.b, pair.hulls.outlines
    count, least = 0, most
    for i in range(a.first, a.last, ROWS_TOGETHER):
        end_a, at, arc = block_at(rows, i, a.last)
        x, y = place_of_a(turn, rows[at].c[0, 0], rows[at].c[0, 1])
        if x * x + y * y > (b.extent + least + arc) ** 2:
            continue
        j = b.first
        while j < b.last:
            if (j - b.first) % ROWS_OF_BLOCKS == 0:
                end_b, at, way = rows_at(rows, j, min(j + ROWS_OF_BLOCKS, b.last))
                dx, dy = rows[at].c[0, 0] - x, rows[at].c[0, 1] - y
                if dx * dx + dy * dy > (least + arc + way) ** 2:
                    j = end_b
                    continue
            end_b, at, way = block_at(rows, j, b.last)
            dx, dy = rows[at].c[0, 0] - x, rows[at].c[0, 1] - y
            if dx * dx + dy * dy <= (least + arc + way) ** 2:
                blocks = (i, end_a, j, end_b)
                if search:
                    count = search_blocks(pair, turn, blocks, most, count)
                else:
                    least = min(least, closest_starts(rows, turn, blocks, least))
            j = end_b
    return least, count


@kernel
def closest_starts(rows, turn, blocks, least):
    """Return the least distance of the starts of rows of two blocks, if it is below `least`."""
    i, end_a, j, end_b = blocks
    square = least * least
    _, at, way = block_at(rows, j, end_b)
    mx, my = rows[at].c[0, 0], rows[at].c[0, 1]
    for k in range(i, end_a):
        x, y = place_of_a(turn, rows[k].c[0, 0], rows[k].c[0, 1])
        if (x - mx) ** 2 + (y - my) ** 2 > (least + way) ** 2:
            continue
        for l in range(j, end_b):
            dx, dy = rows[l].c[0, 0] - x, rows[l].c[0, 1] - y
            square = min(square, dx * dx + dy * dy)
    return math.sqrt(square)


@kernel
def search_blocks(pair, turn, blocks, most, count):
    """Add the points of all rows of two blocks that may be within `most`; return the new count."""
    rows, (i, end_a, j, end_b) = pair.hulls.outlines, blocks
    _, at, way = block_at(rows, j, end_b)
    mx, my = rows[at].c[0, 0], rows[at].c[0, 1]
    for k in range(i, end_a):
        h = rows[k + 1].start - rows[k].start
        x, y = place_of_a(turn, rows[k].c[0, 0], rows[k].c[0, 1])
        if (x - mx) ** 2 + (y - my) ** 2 > (most + way + limits.CHORD * h) ** 2:
            continue
        for l in range(j, end_b):
            dx, dy = rows[l].c[0, 0] - x, rows[l].c[0, 1] - y
            both = limits.CHORD * (h + rows[l + 1].start - rows[l].start)
            square = dx * dx + dy * dy
            if square <= (most + both) ** 2:
                count = search_rows(pair, turn, k, l, count)
                if square <= both * both and chords_cross(rows, turn, k, l):
                    pair.state.count[0], pair.state.count[1] = k, l
    return count


@inlined
def bow_of(rows, k, h):
    """Return a bound of the distance of a row from its chord: h^2/8 times its curvature, c2 is half of it."""
    c, d = rows[k].c, rows[k + 1].c
    return 0.25 * h * h * max(abs(c[2, 0]) + abs(c[2, 1]), abs(d[2, 0]) + abs(d[2, 1]))


@kernel
def chords_cross(rows, turn, k, l):
    """Return whether the chords of two rows cross by more than they bow: then the solids overlap."""
    h, g = rows[k + 1].start - rows[k].start, rows[l + 1].start - rows[l].start
    if h == 0.0 or g == 0.0:
        return False
    a, b, c, d = rows[k].c, rows[k + 1].c, rows[l].c, rows[l + 1].c
    ax, ay = place_of_a(turn, a[0, 0], a[0, 1])
    bx, by = place_of_a(turn, b[0, 0], b[0, 1])
    ux, uy, vx, vy = bx - ax, by - ay, d[0, 0] - c[0, 0], d[0, 1] - c[0, 1]
    bow = bow_of(rows, k, h) + bow_of(rows, l, g)
    first = ux * (c[0, 1] - ay) - uy * (c[0, 0] - ax)
    second = ux * (d[0, 1] - ay) - uy * (d[0, 0] - ax)
    if not (first * second < 0.0 and min(abs(first), abs(second)) > bow * h):
        return False
    third = vx * (ay - c[0, 1]) - vy * (ax - c[0, 0])
    fourth = vx * (by - c[0, 1]) - vy * (bx - c[0, 0])
    return third * fourth < 0.0 and min(abs(third), abs(fourth)) > bow * g


@kernel
def search_rows(pair, turn, k, l, count):
    """Add the point of a row of A and a row of B, if they have one; return the new count."""
    rows = pair.hulls.outlines
    h, g = rows[k + 1].start - rows[k].start, rows[l + 1].start - rows[l].start
    if h > 0.0 and g > 0.0:
        if not may_oppose(rows, turn, k, l) or (
            is_straight(rows[k], h) and is_straight(rows[l], g)
        ):
            return count
        s, t, found = tangent_places(rows, turn, k, l)
        return add_smooth(pair, turn, (k, s), (l, t), count) if found else count
    if h == 0.0 and g == 0.0:
        return add_corners(pair, turn, k, l, count)
    if h == 0.0:
        return add_corner_of_a(pair, turn, k, l, count)
    return add_corner_of_b(pair, turn, k, l, count)


@kernel
def may_oppose(rows, turn, k, l):
    """Return whether two rows may have places that face each other, by what is at their ends."""
    c, d, u, v = rows[k].c, rows[k + 1].c, rows[l].c, rows[l + 1].c
    x, y = along_a(turn, c[1, 0], c[1, 1])
    p, q = along_a(turn, d[1, 0], d[1, 1])
    h, g = rows[k + 1].start - rows[k].start, rows[l + 1].start - rows[l].start
    if turn[2] * (x * u[1, 0] + y * u[1, 1]) > -limits.OPPOSED:
        return False
    first, second = x * u[1, 1] - y * u[1, 0], x * v[1, 1] - y * v[1, 0]
    third, fourth = p * u[1, 1] - q * u[1, 0], p * v[1, 1] - q * v[1, 0]
    bend = max(abs(c[2, 0]) + abs(c[2, 1]), abs(d[2, 0]) + abs(d[2, 1])) * h
    bend += max(abs(u[2, 0]) + abs(u[2, 1]), abs(v[2, 0]) + abs(v[2, 1])) * g
    room = limits.BOW * bend + ROUND_OFF
    if min(min(first, second), min(third, fourth)) > room:
        return False
    if max(max(first, second), max(third, fourth)) < -room:
        return False
    # along the rows: the places are between the ends, but for what the distance turns
    ax, ay = place_of_a(turn, c[0, 0], c[0, 1])
    ex, ey = place_of_a(turn, d[0, 0], d[0, 1])
    wx, wy = ax - u[0, 0], ay - u[0, 1]
    start, end = wx * u[1, 0] + wy * u[1, 1], (ex - u[0, 0]) * u[1, 0] + (ey - u[0, 1]) * u[1, 1]
    room = (
        limits.CHORD * (h + g) * bend
        + (abs(wx) + abs(wy) + h + g) * 4.0 * bend
        + ROUND_OFF * (h + g)
    )
    return min(start, end) <= g + room and max(start, end) >= -room


@kernel
def tangent_places(rows, turn, k, l):
    """Return distances from the starts of two rows to where their normals are opposite, if they are."""
    h, g = rows[k + 1].start - rows[k].start, rows[l + 1].start - rows[l].start
    s, t, size = 0.5 * h, 0.5 * g, h + g
    for _ in range(PAIR_STEPS):
        x, y, dx, dy, ex, ey = curve_at(rows[k], s)
        ax, ay = place_of_a(turn, x, y)
        (tx, ty), (nx, ny), bend_a = (
            along_a(turn, dx, dy),
            along_a(turn, dy, -dx),
            dx * ey - dy * ex,
        )
        bx, by, ux, uy, ex, ey = curve_at(rows[l], t)
        bend_b, wx, wy = ux * ey - uy * ex, ax - bx, ay - by
        # n_b = (uy, -ux)
        across, off = -nx * ux - ny * uy, wx * ux + wy * uy
        g11, g12 = -bend_a * (tx * ux + ty * uy), bend_b * (nx * uy - ny * ux)
        g21, g22 = tx * ux + ty * uy, -1.0 - bend_b * (wx * uy - wy * ux)
        det = g11 * g22 - g12 * g21
        if not abs(det) * size > limits.LEAST_SINE:
            return 0.0, 0.0, False
        ds, dt = (g12 * off - g22 * across) / det, (g21 * across - g11 * off) / det
        new_s, new_t = min(max(s + ds, -h), 2.0 * h), min(max(t + dt, -g), 2.0 * g)
        step, s, t = abs(new_s - s) + abs(new_t - t), new_s, new_t
        if step <= ROUND_OFF * size:
            break
    room = limits.ROW_END
    inside = -room * h <= s <= (1.0 + room) * h and -room * g <= t <= (1.0 + room) * g
    return s, t, inside and step <= limits.ROW_END * size


@kernel
def add_smooth(pair, turn, at_a, at_b, count):
    """Add a point of two smooth places if the distance is least there; return the new count."""
    rows, (k, s), (l, t) = pair.hulls.outlines, at_a, at_b
    x, y, dx, dy, ex, ey = curve_at(rows[k], s)
    ax, ay = place_of_a(turn, x, y)
    nx, ny = along_a(turn, dy, -dx)
    bend_a = dx * ey - dy * ex
    bx, by, ux, uy, ex, ey = curve_at(rows[l], t)
    bend_b = ux * ey - uy * ex
    f = 1.0 / math.sqrt(ux * ux + uy * uy)
    mx, my = f * uy, -f * ux
    gap = mx * (ax - bx) + my * (ay - by)
    if mx * nx + my * ny >= 0.0 or not bend_a + bend_b + gap * bend_a * bend_b > 0.0:
        return count
    return add_point(pair, (at_a, at_b), (ax, ay, bx, by), (mx, my, gap), False, count)


@kernel
def in_cone(rows, k, x, y, slack):
    """Return whether a direction, in axes of the solid, is a normal of the corner that is row k."""
    c, d = rows[k].c, rows[k + 1].c
    if not c[1, 0] * d[1, 1] - c[1, 1] * d[1, 0] > 0.0:  # hollow
        return False
    # normals are tangents turned back by a quarter: n x direction = t . direction
    return (
        c[1, 0] * x + c[1, 1] * y >= -slack
        and d[1, 0] * x + d[1, 1] * y <= slack
        and (c[1, 1] + d[1, 1]) * x - (c[1, 0] + d[1, 0]) * y > 0.0
    )


@kernel
def beside_straight(solid, rows, k):
    """Return whether a corner has a straight side."""
    after = k + 1 if k + 1 < solid.last else solid.first
    before = rows[k].start - rows[k - 1].start
    return is_straight(rows[k - 1], before) or is_straight(
        rows[after], rows[after + 1].start - rows[after].start
    )


@kernel
def add_corner_of_a(pair, turn, k, l, count):
    """Add a corner of A at a row of B; return the new count."""
    rows = pair.hulls.outlines
    ax, ay = place_of_a(turn, rows[k].c[0, 0], rows[k].c[0, 1])
    if not is_peak(rows, l, ax, ay, -1.0, 0.0):
        return count
    g = rows[l + 1].start - rows[l].start
    t = peak_in_row(rows[l], g, ax, ay, -1.0)
    bx, by, ux, uy, _, _ = curve_at(rows[l], t)
    f = 1.0 / math.sqrt(ux * ux + uy * uy)
    mx, my = f * uy, -f * ux
    flat = is_straight(rows[l], g) and beside_straight(pair.a, rows, k)
    x, y = place_in_a(turn, turn[3] - mx, turn[4] - my)
    if not in_cone(rows, k, x, y, limits.NEARLY_FLAT if flat else 0.0):
        return count
    gap = mx * (ax - bx) + my * (ay - by)
    return add_point(pair, ((k, 0.0), (l, t)), (ax, ay, bx, by), (mx, my, gap), flat, count)


@kernel
def add_corner_of_b(pair, turn, k, l, count):
    """Add a corner of B at a row of A; return the new count."""
    rows = pair.hulls.outlines
    bx, by = rows[l].c[0, 0], rows[l].c[0, 1]
    x, y = place_in_a(turn, bx, by)
    if not is_peak(rows, k, x, y, -1.0, 0.0):
        return count
    h = rows[k + 1].start - rows[k].start
    s = peak_in_row(rows[k], h, x, y, -1.0)
    x, y, dx, dy, _, _ = curve_at(rows[k], s)
    ax, ay = place_of_a(turn, x, y)
    f = -1.0 / math.sqrt(dx * dx + dy * dy)
    mx, my = along_a(turn, f * dy, -f * dx)
    flat = is_straight(rows[k], h) and beside_straight(pair.b, rows, l)
    if not in_cone(rows, l, mx, my, limits.NEARLY_FLAT if flat else 0.0):
        return count
    gap = mx * (ax - bx) + my * (ay - by)
    return add_point(pair, ((k, s), (l, 0.0)), (ax, ay, bx, by), (mx, my, gap), flat, count)


@kernel
def add_corners(pair, turn, k, l, count):
    """Add a corner of A at a corner of B, outside each other; return the new count."""
    rows = pair.hulls.outlines
    ax, ay = place_of_a(turn, rows[k].c[0, 0], rows[k].c[0, 1])
    bx, by = rows[l].c[0, 0], rows[l].c[0, 1]
    mx, my = ax - bx, ay - by
    gap = math.sqrt(mx * mx + my * my)
    if not gap > ROUND_OFF * pair.b.extent:
        return count
    mx, my = mx / gap, my / gap
    x, y = place_in_a(turn, turn[3] - mx, turn[4] - my)
    if not (in_cone(rows, l, mx, my, 0.0) and in_cone(rows, k, x, y, 0.0)):
        return count
    flat = beside_straight(pair.a, rows, k) or beside_straight(pair.b, rows, l)
    return add_point(pair, ((k, 0.0), (l, 0.0)), (ax, ay, bx, by), (mx, my, gap), flat, count)


@kernel
def has_nearer(solid, rows, x, y, d):
    """Return whether the curve of a solid has a place nearer to (x, y) than d."""
    near = d * limits.NEARER
    for start in range(solid.first, solid.last, ROWS_TOGETHER):
        end, at, arc = block_at(rows, start, solid.last)
        dx, dy = rows[at].c[0, 0] - x, rows[at].c[0, 1] - y
        if dx * dx + dy * dy > (near + arc) ** 2:
            continue
        for k in range(start, end):
            h = rows[k + 1].start - rows[k].start
            dx, dy = rows[k].c[0, 0] - x, rows[k].c[0, 1] - y
            if dx * dx + dy * dy > (near + limits.CHORD * h) ** 2:
                continue
            if dx * dx + dy * dy < near * near:
                return True
            if h > 0.0 and is_peak(rows, k, x, y, -1.0, 0.0):
                px, py, _, _, _, _ = curve_at(rows[k], peak_in_row(rows[k], h, x, y, -1.0))
                if (px - x) ** 2 + (py - y) ** 2 < near * near:
                    return True
    return False


@kernel
def is_shallowest(pair, at_b, ends, depth):
    """Return whether two places in each other are nearest: from a corner of B to A, else from A to B.

    From within a corner its sides are nearer than its tip.
    """
    rows, (k, _), (ax, ay, bx, by) = pair.hulls.outlines, at_b, ends
    if rows[k + 1].start == rows[k].start:
        x, y = place_in_a(turn_of_a(pair.state), bx, by)
        return not has_nearer(pair.a, rows, x, y, depth)
    return not has_nearer(pair.b, rows, ax, ay, depth)


@kernel
def name_of(solid, hulls, place, flat):
    """Return the name of a place of a curve: its corner beside straight lines, else its stretch."""
    k, t = place
    if flat and hulls.outlines[k + 1].start == hulls.outlines[k].start:
        return CORNER | ((k - solid.first) & (CORNER - 1))
    return stretch(solid, hulls, hulls.outlines[k].start + t, math.inf) & (CORNER - 1)


@kernel
def add_point(pair, places, ends, normal, flat, count):
    """Add a point unless it is there already, or on far sides; return the new count.

    `places` are rows and distances from their starts, `ends` both points, `normal` that of B, and the gap.
    """
    a, b, found, (at_a, at_b) = pair.a, pair.b, pair.found, places
    (ax, ay, bx, by), (mx, my, gap) = ends, normal
    if count >= len(found) // 2:
        return count
    room = limits.SAME_PLACE * min(a.extent, b.extent)
    for k in range(count):
        p, q = found[k].on_a, found[k].on_b
        if abs(p[0] - ax) + abs(p[1] - ay) + abs(q[0] - bx) + abs(q[1] - by) < room:
            return count
    if gap < -room and not is_shallowest(pair, at_b, ends, -gap):
        return count
    name = (name_of(a, pair.hulls, at_a, flat) << 30) | name_of(b, pair.hulls, at_b, flat)
    put(found[count], gap, (mx, my, 0.0), (ax, ay, 0.0), (bx, by, 0.0), (2 << 60) | name)
    of_a = part_of_place(a, pair.hulls, at_a[0], at_a[1])
    put_parts(found[count], NOBODY, of_a, part_of_place(b, pair.hulls, at_b[0], at_b[1]))
    return count + 1


@kernel
def put_crossing(pair, turn, depth):
    """Write a point of curves that cross, of which no place is known: they overlap more than by `depth`."""
    rows, (k, l) = pair.hulls.outlines, (pair.state.count[0], pair.state.count[1])
    if k < 0:  # any places
        l = nearest_block(pair.b, rows, turn[3], turn[4])
        x, y = place_in_a(turn, rows[l].c[0, 0], rows[l].c[0, 1])
        k = nearest_block(pair.a, rows, x, y)
    bx, by, mx, my = rows[l].c[0, 0], rows[l].c[0, 1], rows[l].c[1, 1], -rows[l].c[1, 0]
    gap = -depth
    ax, ay = bx + gap * mx, by + gap * my
    put(pair.found[0], gap, (mx, my, 0.0), (ax, ay, 0.0), (bx, by, 0.0), (2 << 60) | (1 << 28))
    of_a = part_of_place(pair.a, pair.hulls, k, 0.0)
    put_parts(pair.found[0], NOBODY, of_a, part_of_place(pair.b, pair.hulls, l, 0.0))
    return 1


@kernel
def keep_least(found, count, reach, most):
    """Keep the points with the least gaps, up to `reach` above the first, at most `most`; return how many."""
    kept = min(count, most)
    for i in range(kept):
        best = i
        for k in range(i + 1, count):
            if found[k].gap < found[best].gap:
                best = k
        if best != i:
            swap(found, i, best)
        if found[i].gap > found[0].gap + reach:
            return i
    return kept


@kernel
def places_of(pair, turn, reach):
    """Find all places up to `reach` above the least distance, of curves that cross up to `OVERLAP`.

    Return their number. Rows of gears are short, so that the time goes with the square of the reach.
    """
    s, whole = pair.state, limits.OVERLAP * min(pair.a.extent, pair.b.extent)
    count = recall(pair, reach)
    if count >= 0:
        return count
    near, _ = each_block(pair, turn, far_bound(pair, turn), False)
    s.count[0] = -1  # a row of A that crosses one of B
    _, count = each_block(pair, turn, near + reach, True)
    if reach < whole and (count == 0 or s.count[0] >= 0):
        reach, s.count[0] = whole, -1
        _, count = each_block(pair, turn, near + reach, True)
    remember(pair, reach, count)
    return count


@kernel
def two_profiles(pair, reach):
    """Find the points of two profiles; return their number. Beyond a thickness the gap is along the axis."""
    s, a, b, found = pair.state, pair.a, pair.b, pair.found
    zero = (0.0, 0.0, 0.0)
    if not abs(s.R[2, 2]) > limits.PARALLEL:  # they have no sections: the run must end
        put(found[0], math.nan, (0.0, 0.0, 1.0), zero, zero, 2 << 60)
        return 1
    low, high = max(-b.half[2], s.p[2] - a.half[2]), min(b.half[2], s.p[2] + a.half[2])
    if not low < high:
        up, whole = math.copysign(1.0, s.p[2]), a.half[2] + b.half[2]
        gap = max(abs(s.p[2]) - whole, 0.0) + whole
        on_a = (s.p[0], s.p[1], s.p[2] - up * a.half[2])
        put(found[0], gap, (0.0, 0.0, up), on_a, (on_a[0], on_a[1], on_a[2] - up * gap), 2 << 60)
        put_parts(found[0], OF_B, OF_SUPPORT, face_part(0))
        return 1
    turn, size = turn_of_a(s), min(a.extent, b.extent)
    count = places_of(pair, turn, min(reach, limits.OVERLAP * size) + ROUND_OFF * size)
    least = math.inf
    for k in range(count):
        least = min(least, found[k].gap)
    if count == 0 or (s.count[0] >= 0 and least > -ROUND_OFF * size):
        count = put_crossing(pair, turn, limits.OVERLAP * size)
    room = ROUND_OFF * size
    count = keep_least(found, count, min(reach, limits.OVERLAP * size) + room, MOST_POINTS // 2)
    for k in range(count):
        p, q, n, row = found[k].on_a, found[k].on_b, found[k].normal, found[count + k]
        here, there = (p[0], p[1], high), (q[0], q[1], high)
        put(row, found[k].gap, (n[0], n[1], 0.0), here, there, found[k].feature | (1 << 29))
        put_parts(row, found[k].owner, found[k].parts[0], found[k].parts[1])
        p[2], q[2] = low, low
    return 2 * count
