"""Nearest points of a ball or a capsule and a box, in closed form, in axes of the box (B)."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision.features import (
    NOBODY,
    OF_B,
    OF_SUPPORT,
    edge_part,
    face_part,
    of_edges,
    of_vertex_a,
    of_vertex_b,
)
from carom.collision.found import put, put_parts
from carom.collision.frame import from_a
from carom.collision.thresholds import EDGE_GAIN, LEAST_SINE
from carom.geometry.thresholds import RESOLUTION


@inlined
def clamp(x, h):
    """Return x, brought into [-h, h]."""
    return max(-h, min(h, x))


@kernel
def point_box(pair):
    """Find the nearest points of a ball and a box; for a centre inside the box, those on the nearest face."""
    p, g = pair.state.p, pair.b.half
    px, py, pz = p[0], p[1], p[2]
    qx, qy, qz = clamp(px, g[0]), clamp(py, g[1]), clamp(pz, g[2])
    nx, ny, nz = px - qx, py - qy, pz - qz
    d = math.sqrt(nx * nx + ny * ny + nz * nz)
    if d > 0.0:
        nx, ny, nz = nx / d, ny / d, nz / d
    else:
        d, axis = -math.inf, 0
        for i in range(3):
            if abs(p[i]) - g[i] > d:
                d, axis = abs(p[i]) - g[i], i
        sense = 1.0 if p[axis] > 0.0 else -1.0
        nx, ny = sense if axis == 0 else 0.0, sense if axis == 1 else 0.0
        nz = sense if axis == 2 else 0.0
        qx, qy, qz = px - d * nx, py - d * ny, pz - d * nz
    gap = d - pair.a.radius - pair.b.radius
    put(pair.found[0], gap, (nx, ny, nz), (px, py, pz), (qx, qy, qz), of_vertex_a(0))
    part, owner = _part(nx, ny, nz)
    put_parts(pair.found[0], owner, OF_SUPPORT, part)


@kernel
def _part(nx, ny, nz):
    """Return the part of a box that has the normal n, and the owner of the normal."""
    corner, other, beyond = _corner(nx, ny, nz)
    if beyond == 1:
        axis = 0 if nx != 0.0 else 1 if ny != 0.0 else 2
        return face_part(2 * axis + (1 if corner > 0 else 0)), OF_B
    if beyond == 2:
        return edge_part(corner, other), NOBODY
    return OF_SUPPORT, NOBODY


@kernel
def _corner(nx, ny, nz):
    """Return the corner of a box towards n, the other end of an edge across n, and how many of n are not 0."""
    corner = 4 * (nx > 0.0) + 2 * (ny > 0.0) + (nz > 0.0)
    other = corner + (4 if nx == 0.0 else 2 if ny == 0.0 else 1)
    return corner, other, 1 * (nx != 0.0) + (ny != 0.0) + (nz != 0.0)


@kernel
def _slope(c, u, g, t):
    """Return the derivative in t of half the squared distance of c + t u from the box."""
    total = 0.0
    for i in range(3):
        x = c[i] + t * u[i]
        total += u[i] * (x - clamp(x, g[i]))
    return total


@kernel
def nearest_on_line(c, u, g, h):
    """Return t in [-h, h] where c + t u is nearest to the box of half sizes g.

    The squared distance is convex in t. Its derivative is linear between the values of t, at most six, at
    which the line crosses the plane of a face. These bracket the zero, which linear interpolation gives
    exactly.
    """
    low, high = -h, h
    f_low, f_high = _slope(c, u, g, low), _slope(c, u, g, high)
    if not f_low < 0.0:
        return low
    if not f_high > 0.0:
        return high
    for i in range(6):
        axis, side = i >> 1, 2.0 * (i & 1) - 1.0
        if abs(u[axis]) > 0.0:
            t = (side * g[axis] - c[axis]) / u[axis]
            if low < t < high:
                f = _slope(c, u, g, t)
                if f < 0.0:
                    low, f_low = t, f
                else:
                    high, f_high = t, f
    span = f_high - f_low
    return max(low, min(high, low - f_low * (high - low) / span)) if span > 0.0 else low


@kernel
def segment_box(pair):
    """Find the nearest points of a capsule and a box."""
    s, g, h = pair.state, pair.b.half, pair.a.half[2]
    c, u = s.p, s.w[0]  # u, the direction of the capsule, is stored in a row that is free here
    u[0], u[1], u[2] = from_a(s, 0.0, 0.0, 1.0)
    t = nearest_on_line(c, u, g, h)
    ax, ay, az = c[0] + t * u[0], c[1] + t * u[1], c[2] + t * u[2]
    bx, by, bz = clamp(ax, g[0]), clamp(ay, g[1]), clamp(az, g[2])
    nx, ny, nz = ax - bx, ay - by, az - bz
    d = math.sqrt(nx * nx + ny * ny + nz * nz)
    if not d > RESOLUTION * (h + g[0] + g[1] + g[2]):
        _through(pair, u)
        return
    n, gap = (nx / d, ny / d, nz / d), d - (pair.a.radius + pair.b.radius)
    put(pair.found[0], gap, n, (ax, ay, az), (bx, by, bz), _feature(nx, ny, nz, t, h))
    part, owner = _part(nx, ny, nz)
    put_parts(pair.found[0], owner, OF_SUPPORT if abs(t) == h else edge_part(0, 1), part)


@kernel
def _feature(nx, ny, nz, t, h):
    """Return the feature: an end of the segment, a vertex of the box, two edges, or 0 for a face of the box."""
    if abs(t) == h:
        return of_vertex_a(1 if t > 0.0 else 0)
    corner, other, beyond = _corner(nx, ny, nz)
    if beyond == 3:
        return of_vertex_b(corner)
    return of_edges(0, 1, corner, other) if beyond == 2 else 0


@kernel
def _through(pair, u):
    """Find the smallest displacement out of the box for a segment along u that touches or crosses it.

    Six separating axes are compared: the normals of the faces, and the cross products of u with the edges.
    """
    c, g, h = pair.state.p, pair.b.half, pair.a.half[2]
    best, axis, cross = -math.inf, 0, False
    for i in range(3):
        gap = abs(c[i]) - g[i] - h * abs(u[i])
        if gap > best:
            best, axis = gap, i
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        size = math.sqrt(u[j] * u[j] + u[k] * u[k])  # of e_i x u = u_j e_k - u_k e_j
        if size > LEAST_SINE:
            off = abs(u[j] * c[k] - u[k] * c[j]) - g[j] * abs(u[k]) - g[k] * abs(u[j])
            if off / size > best + EDGE_GAIN * (h + g[0] + g[1] + g[2]):
                best, axis, cross = off / size, i, True
    n = pair.found[0].normal
    n[0], n[1], n[2] = 0.0, 0.0, 0.0
    if cross:
        j, k = (axis + 1) % 3, (axis + 2) % 3
        sense = 1.0 if u[j] * c[k] - u[k] * c[j] > 0.0 else -1.0
        size = math.sqrt(u[j] * u[j] + u[k] * u[k])
        n[k], n[j] = sense * u[j] / size, -sense * u[k] / size
        # The segment crosses the edge at t: b = a - best n has the coordinates j and k of the edge.
        bj, bk = math.copysign(g[j], n[j]), math.copysign(g[k], n[k])
        t = u[j] * (bj + best * n[j] - c[j]) + u[k] * (bk + best * n[k] - c[k])
        t = clamp(t / (size * size), h)
    else:
        n[axis] = 1.0 if c[axis] > 0.0 else -1.0
        t = -h if u[axis] * n[axis] > 0.0 else h
    ax, ay, az = c[0] + t * u[0], c[1] + t * u[1], c[2] + t * u[2]
    gap = best - (pair.a.radius + pair.b.radius)
    on_b = (ax - best * n[0], ay - best * n[1], az - best * n[2])
    feature = 0 if cross else of_vertex_a(1 if t > 0.0 else 0)
    put(pair.found[0], gap, (n[0], n[1], n[2]), (ax, ay, az), on_b, feature)
    part, owner = _part(n[0], n[1], n[2])
    put_parts(pair.found[0], owner, edge_part(0, 1) if cross else OF_SUPPORT, part)
