"""The points found for one pair, in axes of B, and the choice of those that are returned."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision.features import NOBODY, exchanged
from carom.collision.frame import to_world
from carom.collision.layout import MOST_POINTS
from carom.geometry.thresholds import ROUND_OFF
from carom.geometry.vectors import dot, minus


@inlined
def put(row, gap, n, on_a, on_b, feature):
    """Write a point: its gap, the normal from B to A, the points of the two cores, the feature."""
    row.gap, row.feature = gap, feature
    row.normal[0], row.normal[1], row.normal[2] = n
    row.on_a[0], row.on_a[1], row.on_a[2] = on_a
    row.on_b[0], row.on_b[1], row.on_b[2] = on_b


@inlined
def put_parts(row, owner, part_a, part_b):
    """Write the owner of the normal of a point, and the parts on which it lies."""
    row.owner, row.parts[0], row.parts[1] = owner, part_a, part_b


@kernel
def swap(found, i, j):
    """Exchange two points."""
    a, b = found[i], found[j]
    a.gap, b.gap = b.gap, a.gap
    a.feature, b.feature = b.feature, a.feature
    a.owner, b.owner = b.owner, a.owner
    for c in range(2):
        a.parts[c], b.parts[c] = b.parts[c], a.parts[c]
    for c in range(3):
        a.normal[c], b.normal[c] = b.normal[c], a.normal[c]
        a.on_a[c], b.on_a[c] = b.on_a[c], a.on_a[c]
        a.on_b[c], b.on_b[c] = b.on_b[c], a.on_b[c]


@inlined
def _apart(found, i, j):
    """Return the square of the distance of two points."""
    a, b = found[i].on_b, found[j].on_b
    x, y, z = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return x * x + y * y + z * z


@kernel
def keep_new(found, count, near, exact):
    """Keep the point in row `count` unless it is there already; return the new number of points.

    It is there if a point has its feature, or lies within `near` of it with its normal: ends of two equal lines
    side by side. Of two names the smaller number stays (corners of A, of B, edges), so that round-off does not
    choose it. A corner that passes an edge has two normals, which are two points. If the new point is `exact`,
    it replaces the first one with its feature.
    """
    new = found[count]
    for k in range(count):
        if found[k].feature == new.feature:
            if exact and k == 0:
                swap(found, 0, count)
            return count
    for k in range(count):
        named = found[k].feature != 0  # points without a name may have no place yet
        alike = dot(found[k].normal, new.normal) > 1.0 - ROUND_OFF
        if named and alike and _apart(found, k, count) <= near * near:
            if new.feature < found[k].feature:
                swap(found, k, count)
            return count
    return count + 1


@kernel
def spread(found, count, tiny):
    """Move the points that are kept to the front; return their number.

    If there are too many, the point with the least gap is kept first, and then, again and again, the point
    farthest from all kept points. This keeps the corners of the polygon. Of gaps that are equal to `tiny`, that
    of the point farthest from the mean is the least: so eight of sixteen places where two rims cross are
    those of every second one, and round-off chooses only between alike halves.
    """
    if count <= MOST_POINTS:
        return count
    least, x, y, z = math.inf, 0.0, 0.0, 0.0
    for k in range(count):
        p = found[k].on_b
        least, x, y, z = min(least, found[k].gap), x + p[0], y + p[1], z + p[2]
    first, most = 0, -1.0
    for k in range(count):
        d = minus(found[k].on_b, (x / count, y / count, z / count))
        if found[k].gap <= least + tiny and dot(d, d) > most:
            first, most = k, dot(d, d)
    swap(found, 0, first)
    for kept in range(1, MOST_POINTS):
        best, where = -1.0, kept
        for k in range(kept, count):
            near = _apart(found, k, 0)
            for i in range(1, kept):
                near = min(near, _apart(found, k, i))
            if near > best:
                best, where = near, k
        swap(found, kept, where)
    return MOST_POINTS


@kernel
def hand_on(pair, count, flip, out):
    """Write the points found to `out`, in world axes and on the surfaces; with `flip` A and B are exchanged."""
    s, found = pair.state, pair.found
    count = spread(found, count, ROUND_OFF * min(pair.a.extent, pair.b.extent))
    for k in range(count):
        row, point = found[k], out[k]
        n = row.normal
        nx, ny, nz = to_world(s, n[0], n[1], n[2])
        p, r = row.on_a, pair.a.radius
        ax, ay, az = to_world(s, p[0] - r * n[0], p[1] - r * n[1], p[2] - r * n[2])
        p, r = row.on_b, pair.b.radius
        bx, by, bz = to_world(s, p[0] + r * n[0], p[1] + r * n[1], p[2] + r * n[2])
        o, parts = s.origin, row.parts
        a, b = (ax + o[0], ay + o[1], az + o[2]), (bx + o[0], by + o[1], bz + o[2])
        if flip:
            put(point, row.gap, (-nx, -ny, -nz), b, a, exchanged(row.feature))
            owner = row.owner if row.owner == NOBODY else 3 - row.owner
            put_parts(point, owner, parts[1], parts[0])
        else:
            put(point, row.gap, (nx, ny, nz), a, b, row.feature)
            put_parts(point, row.owner, parts[0], parts[1])
    return count
