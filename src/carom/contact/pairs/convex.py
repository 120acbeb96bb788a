"""Nearest points of any two convex solids: the distance of the cores, or how deep they overlap.

The normal n is the maximum of the separation sigma(n) = min_A a.n - max_B b.n over unit vectors. Apart,
the distance of the cores gives it. Where they touch or overlap slightly, A is moved out along the best n
so far until it is clear, and the normal of that distance is the next n: the proximal point method for
sigma on the sphere, for moving by d adds d n.n0 = d - d |n - n0|^2 / 2. Each step raises sigma. No
margin stays in the result.
"""

from __future__ import annotations

import math

from carom.contact.pairs.faces import load_face
from carom.contact.pairs.features import of_edges, of_vertex_a, of_vertex_b
from carom.contact.pairs.found import put
from carom.contact.pairs.gjk import distance, points_of
from carom.contact.pairs.layout import CYLINDER
from carom.contact.pairs.polish import polish
from carom.contact.pairs.support import separation
from carom.jit import kernel

CLEAR = 1e-3  # distance of the cores, relative to the smaller, that gives a direction to round-off
ROUNDS = 30
FACE = 1e-12  # relative to the size: by so much a face's normal may be worse and is taken


@kernel
def closest(s, a, b, hulls, found):
    """Write the nearest points of two convex solids as the first point; return its gap.

    Overlap must be slight, less than about half of either core: deeper, the way out may not be the least.
    """
    size = min(a.extent, b.extent)
    clear = CLEAR * size
    p = s.p
    x, y, z = p[0], p[1], p[2]
    if x * x + y * y + z * z == 0.0:
        z = 1.0
    d, nx, ny, nz = distance(s, a, b, hulls, x, y, z)
    if d > 0.0:
        nx, ny, nz = nx / d, ny / d, nz / d
    best = d
    if not d > clear:
        if d == 0.0:
            nx, ny, nz = _way_out(s, a, b, hulls)
        best, nx, ny, nz = _climb(s, a, b, hulls, nx, ny, nz, clear)
    _, _, _, bx, by, bz = points_of(s)
    s.shift[0], s.shift[1], s.shift[2] = 0.0, 0.0, 0.0
    feature = _feature(s)
    if a.kind >= CYLINDER or b.kind >= CYLINDER:
        best, nx, ny, nz, done = polish(s, a, b, hulls, best, nx, ny, nz)
        if done == 1:
            q = s.on_b[4]
            bx, by, bz = q[0], q[1], q[2]
    # A face's own normal is exact; it is taken where it is as good.
    aligned = load_face(s, 1, b, hulls, nx, ny, nz)
    for side in (1, 0):
        if side == 0:
            aligned = load_face(s, 0, a, hulls, -nx, -ny, -nz)
        if aligned > 0.9:
            n = s.normal[side]
            f = 1.0 if side == 1 else -1.0
            if f * (n[0] * nx + n[1] * ny + n[2] * nz) > 1.0 - 1e-6:
                value = separation(s, a, b, hulls, f * n[0], f * n[1], f * n[2])
                if value >= best - FACE * size:
                    best, nx, ny, nz = value, f * n[0], f * n[1], f * n[2]
                    break
    # The two points are `best` apart along n; what else they differ by is rounding along a face.
    e = b.inner
    bx, by, bz = bx + e * nx, by + e * ny, bz + e * nz
    core = best - a.inner - b.inner
    ax, ay, az = bx + core * nx, by + core * ny, bz + core * nz
    gap = core - a.radius - b.radius
    put(found, 0, gap, nx, ny, nz, ax, ay, az, bx, by, bz, feature)
    return gap


@kernel
def _way_out(s, a, b, hulls):
    """Return the direction of greatest separation among the line of centres and the axes of both."""
    p = s.p
    d = math.sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])
    nx, ny, nz, best = 0.0, 0.0, 1.0, -math.inf
    for k in range(7):
        i = (k - 1) % 3
        if k == 0:
            f = 1.0 / d if d > 0.0 else 0.0
            x, y, z = f * p[0], f * p[1], f * p[2]
        elif k < 4:
            x = 1.0 if i == 0 else 0.0
            y = 1.0 if i == 1 else 0.0
            z = 1.0 if i == 2 else 0.0
        else:
            x, y, z = s.R[0, i], s.R[1, i], s.R[2, i]
        if x * x + y * y + z * z > 0.0:
            if x * p[0] + y * p[1] + z * p[2] < 0.0:
                x, y, z = -x, -y, -z
            value = separation(s, a, b, hulls, x, y, z)
            if value > best:
                best, nx, ny, nz = value, x, y, z
    return nx, ny, nz


@kernel
def _climb(s, a, b, hulls, nx, ny, nz, clear):
    """Return the greatest separation near a direction, and its direction; the simplex is that of the end."""
    best = separation(s, a, b, hulls, nx, ny, nz)
    for _ in range(ROUNDS):
        move = clear - best
        s.shift[0], s.shift[1], s.shift[2] = move * nx, move * ny, move * nz
        d, x, y, z = distance(s, a, b, hulls, nx, ny, nz)
        if not d > 0.0:
            break
        x, y, z = x / d, y / d, z / d
        value = separation(s, a, b, hulls, x, y, z) - move * (nx * x + ny * y + nz * z)
        if not value > best:
            break
        last, best = best, value
        nx, ny, nz = x, y, z
        if not best - last > 1e-14 * clear:
            break
    return best, nx, ny, nz


@kernel
def _feature(s):
    """Return the feature of the nearest points: by how many vertices of each make the simplex."""
    ids = s.ids
    a2, b2, more_a, more_b = ids[0, 0], ids[0, 1], False, False
    for k in range(1, s.points):
        i, j = ids[k, 0], ids[k, 1]
        if i != ids[0, 0]:
            more_a = more_a or a2 not in (ids[0, 0], i)
            a2 = i
        if j != ids[0, 1]:
            more_b = more_b or b2 not in (ids[0, 1], j)
            b2 = j
    if a2 == ids[0, 0] and not more_a:
        return of_vertex_a(a2)
    if b2 == ids[0, 1] and not more_b:
        return of_vertex_b(b2)
    if not more_a and not more_b:
        return of_edges(ids[0, 0], a2, ids[0, 1], b2)
    return 0
