"""Two segments: their nearest points, and the ends of the line along which parallel ones touch.

The segments join corners i, j of the face of A and k, l of that of B, in the scratch of the pair.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.collision.features import of_edges, of_vertex_a, of_vertex_b
from carom.collision.found import known, put

PARALLEL = 1e-14  # square of the sine below which two segments count as parallel
TOUCHING = 1e-9  # distance relative to the lengths below which it has no direction
BESIDE = 0.99  # cosine of the normals of an end and of the nearest points


@kernel
def _line(s, side, i, j):
    """Return first corner, direction and length of a segment; length 0 has no direction."""
    p, q = s.corner[side, i], s.corner[side, j]
    x, y, z = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    d = math.sqrt(x * x + y * y + z * z)
    f = 1.0 / d if d > 0.0 else 0.0
    return p[0], p[1], p[2], f * x, f * y, f * z, d


@kernel
def nearest(dx, dy, dz, ux, uy, uz, g, wx, wy, wz, h):
    """Return t in [0, g] and z in [0, h] that bring d + t u and z w nearest; u, w unit vectors or zero.

    The square of the distance is convex: its free minimum in t, then z and t brought into their
    intervals in turn (Ericson, *Real-Time Collision Detection*, 2005, 5.1.9). Parallel segments are
    nearest all along their overlap: then one end of it.
    """
    c = ux * wx + uy * wy + uz * wz
    nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    across = nx * nx + ny * ny + nz * nz
    du = dx * ux + dy * uy + dz * uz
    dw = dx * wx + dy * wy + dz * wz
    if across > PARALLEL:
        t = (c * dw - du) / across
    else:
        t = h - dw if c > 0.0 else dw  # where z is at an end: z = dw + c t
    t = max(0.0, min(g, t))
    z = max(0.0, min(h, dw + c * t))
    t = max(0.0, min(g, c * z - du))
    return t, max(0.0, min(h, dw + c * t))


@kernel
def edge_on_edge(s, i, j, k, l, radii, found):
    """Write the nearest points of two segments as the first point; return its gap."""
    px, py, pz, ux, uy, uz, g = _line(s, 0, i, j)
    qx, qy, qz, wx, wy, wz, h = _line(s, 1, k, l)
    t, z = nearest(px - qx, py - qy, pz - qz, ux, uy, uz, g, wx, wy, wz, h)
    ax, ay, az = px + t * ux, py + t * uy, pz + t * uz
    bx, by, bz = qx + z * wx, qy + z * wy, qz + z * wz
    nx, ny, nz = ax - bx, ay - by, az - bz
    d = math.sqrt(nx * nx + ny * ny + nz * nz)
    if d > 0.0:
        nx, ny, nz = nx / d, ny / d, nz / d
    else:  # they cross: along their common normal, which has two senses
        nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
        f = math.sqrt(nx * nx + ny * ny + nz * nz)
        if f > 0.0:
            nx, ny, nz = nx / f, ny / f, nz / f
        else:
            nx, ny, nz = 0.0, 0.0, 1.0
    feature = of_edges(s.number[0, i], s.number[0, j], s.number[1, k], s.number[1, l])
    if t == 0.0 or t == g:
        feature = of_vertex_a(s.number[0, i] if t == 0.0 else s.number[0, j])
    elif z == 0.0 or z == h:
        feature = of_vertex_b(s.number[1, k] if z == 0.0 else s.number[1, l])
    put(found, 0, d - radii, nx, ny, nz, ax, ay, az, bx, by, bz, feature)
    return d - radii


@kernel
def ends_of_line(s, i, j, k, l, radii, least, most, found, count):
    """Add the ends of each segment that lie beside the inside of the other, with gaps up to `most`.

    They carry a contact along a line. Each has its own distance and normal, which must be near that of
    the first point found: an end that overhangs another edge is no contact. Return the new count.
    """
    px, py, pz, ux, uy, uz, g = _line(s, 0, i, j)
    qx, qy, qz, wx, wy, wz, h = _line(s, 1, k, l)
    du = (px - qx) * ux + (py - qy) * uy + (pz - qz) * uz
    dw = (px - qx) * wx + (py - qy) * wy + (pz - qz) * wz
    c = ux * wx + uy * wy + uz * wz
    n0 = found[0].normal
    for end in range(4):
        if end < 2:
            t = g * end
            z = dw + c * t
            inside = 0.0 < z < h
            feature = of_vertex_a(s.number[0, i] if end == 0 else s.number[0, j])
        else:
            z = h * (end - 2)
            t = c * z - du
            inside = 0.0 < t < g
            feature = of_vertex_b(s.number[1, k] if end == 2 else s.number[1, l])
        ax, ay, az = px + t * ux, py + t * uy, pz + t * uz
        bx, by, bz = qx + z * wx, qy + z * wy, qz + z * wz
        nx, ny, nz = ax - bx, ay - by, az - bz
        d = math.sqrt(nx * nx + ny * ny + nz * nz)
        if d > TOUCHING * (g + h):
            nx, ny, nz = nx / d, ny / d, nz / d
        else:  # sharp edges that touch: their distance has no direction
            nx, ny, nz = n0[0], n0[1], n0[2]
        gap = d - radii
        beside = nx * n0[0] + ny * n0[1] + nz * n0[2] > BESIDE
        inside = inside and beside and least <= gap <= most
        if inside and not known(found, count, feature):
            put(found, count, gap, nx, ny, nz, ax, ay, az, bx, by, bz, feature)
            count += 1
    return count
