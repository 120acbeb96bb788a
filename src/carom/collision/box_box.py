"""Separating axes of two boxes; they give the exact distance if a face or two edges are nearest."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.collision.features import NOBODY, OF_A, OF_B, OF_SUPPORT, edge_part, of_edges
from carom.collision.found import put, put_parts
from carom.collision.thresholds import LEAST_SINE
from carom.geometry.thresholds import RESOLUTION, ROUND_OFF


@inlined
def _sense(x):
    return 1.0 if x > 0.0 else -1.0


@kernel
def best_axis(pair):
    """Return the greatest separation of two boxes over the fifteen axes, and the number of the axis.

    Axes 0-2 are normals of faces of B, 3-5 of faces of A, 6 + 3 i + j is the cross product of edges i of B and
    j of A. The separation never exceeds the distance of the cores; a negative separation is minus the depth.
    """
    R, p, g, h = pair.state.R, pair.state.p, pair.b.half, pair.a.half
    size = g[0] + g[1] + g[2] + h[0] + h[1] + h[2]
    best, axis = -math.inf, 0
    for i in range(3):
        reach = abs(R[i, 0]) * h[0] + abs(R[i, 1]) * h[1] + abs(R[i, 2]) * h[2]
        gap = abs(p[i]) - g[i] - reach
        if gap > best + ROUND_OFF * size:
            best, axis = gap, i
    for j in range(3):
        reach = abs(R[0, j]) * g[0] + abs(R[1, j]) * g[1] + abs(R[2, j]) * g[2]
        along = R[0, j] * p[0] + R[1, j] * p[1] + R[2, j] * p[2]
        gap = abs(along) - h[j] - reach
        if gap > best + ROUND_OFF * size:
            best, axis = gap, 3 + j
    for i in range(3):
        i1, i2 = (i + 1) % 3, (i + 2) % 3
        for j in range(3):
            m1, m2 = -R[i2, j], R[i1, j]  # components of e_i x a_j along axes i1, i2
            sine = math.sqrt(m1 * m1 + m2 * m2)
            if sine > LEAST_SINE:
                j1, j2 = (j + 1) % 3, (j + 2) % 3
                reach = g[i1] * abs(m1) + g[i2] * abs(m2)
                reach += h[j1] * abs(R[i, j2]) + h[j2] * abs(R[i, j1])
                gap = (abs(m1 * p[i1] + m2 * p[i2]) - reach) / sine
                if gap > best + ROUND_OFF * size:
                    best, axis = gap, 6 + 3 * i + j
    return best, axis


@kernel
def edge_pair(pair, best, axis):
    """Write the nearest points of the lines of two edges; return True if both points lie on the edges.

    Each box takes part with the edge that is nearest to the other box along the common normal.
    """
    s = pair.state
    R, p, g, h = s.R, s.p, pair.b.half, pair.a.half
    i, j = (axis - 6) // 3, (axis - 6) % 3
    i1, i2 = (i + 1) % 3, (i + 2) % 3
    n = pair.found[0].normal
    sine = math.sqrt(R[i1, j] * R[i1, j] + R[i2, j] * R[i2, j])
    n[i], n[i1], n[i2] = 0.0, -R[i2, j] / sine, R[i1, j] / sine
    if not n[i1] * p[i1] + n[i2] * p[i2] > 0.0:
        n[i1], n[i2] = -n[i1], -n[i2]
    # On the edge of B, coordinates i1 and i2 are at their bounds along n; on that of A, j1 and j2 against n.
    j1, j2 = (j + 1) % 3, (j + 2) % 3
    s1 = -_sense(n[0] * R[0, j1] + n[1] * R[1, j1] + n[2] * R[2, j1])
    s2 = -_sense(n[0] * R[0, j2] + n[1] * R[1, j2] + n[2] * R[2, j2])
    b1, b2 = _sense(n[i1]) * g[i1], _sense(n[i2]) * g[i2]
    q = s.w[0]
    for k in range(3):
        q[k] = p[k] + s1 * h[j1] * R[k, j1] + s2 * h[j2] * R[k, j2]
    # q + t a_j meets the line of B after this line is moved by the separation along n.
    u1, u2 = R[i1, j], R[i2, j]
    d1, d2 = b1 + best * n[i1] - q[i1], b2 + best * n[i2] - q[i2]
    t = (d1 * u1 + d2 * u2) / (sine * sine)
    z = q[i] + t * R[i, j]
    slack = RESOLUTION * (h[j] + g[i])
    inside = abs(t) <= h[j] + slack and abs(z) <= g[i] + slack
    t = max(-h[j], min(h[j], t))
    ax, ay, az = q[0] + t * R[0, j], q[1] + t * R[1, j], q[2] + t * R[2, j]
    corner_b = (4 >> i1) * (n[i1] > 0.0) + (4 >> i2) * (n[i2] > 0.0)
    corner_a = (4 >> j1) * (s1 > 0.0) + (4 >> j2) * (s2 > 0.0)
    feature = of_edges(corner_a, corner_a + (4 >> j), corner_b, corner_b + (4 >> i))
    gap = best - (pair.a.radius + pair.b.radius)
    on_b = (ax - best * n[0], ay - best * n[1], az - best * n[2])
    put(pair.found[0], gap, (n[0], n[1], n[2]), (ax, ay, az), on_b, feature)
    part_a = edge_part(corner_a, corner_a + (4 >> j))
    part_b = edge_part(corner_b, corner_b + (4 >> i))
    put_parts(pair.found[0], NOBODY, part_a, part_b)
    return inside


@kernel
def face_or_edges(pair):
    """Write the separation along the best axis as the first point; return False if it is not the distance.

    For a face only the gap and the normal are written, with the feature 0: `clip.overlap` finds the points.
    """
    R, p = pair.state.R, pair.state.p
    best, axis = best_axis(pair)
    if axis >= 6:
        return edge_pair(pair, best, axis)
    if axis < 3:
        x, y, z = 1.0 * (axis == 0), 1.0 * (axis == 1), 1.0 * (axis == 2)
    else:
        x, y, z = R[0, axis - 3], R[1, axis - 3], R[2, axis - 3]
    if not x * p[0] + y * p[1] + z * p[2] > 0.0:
        x, y, z = -x, -y, -z
    nowhere = (0.0, 0.0, 0.0)
    put(pair.found[0], best - (pair.a.radius + pair.b.radius), (x, y, z), nowhere, nowhere, 0)
    put_parts(pair.found[0], OF_B if axis < 3 else OF_A, OF_SUPPORT, OF_SUPPORT)
    return True
