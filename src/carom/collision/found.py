"""The points found for one pair, in axes of B, and the choice of those that are returned."""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom.collision.features import NOBODY, exchanged
from carom.collision.frame import to_world
from carom.collision.layout import MOST_POINTS


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
def known(found, count, feature):
    """Return True if one of the points has this feature."""
    there = False
    for k in range(count):
        there = there or found[k].feature == feature
    return there


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
def spread(found, count):
    """Move the points that are kept to the front; return their number.

    If there are too many, the point with the least gap is kept first, and then, again and again, the point
    farthest from all kept points. This keeps the corners of the polygon.
    """
    if count <= MOST_POINTS:
        return count
    least = 0
    for k in range(1, count):
        if found[k].gap < found[least].gap:
            least = k
    swap(found, 0, least)
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
    count = spread(found, count)
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
