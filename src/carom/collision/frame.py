"""Transform a pair of solids to the axes of B, and its contact points back to the world.

Only the difference of the two origins is computed from world coordinates, so a pair far from the origin of the
world is as exact as one near it.
"""

from __future__ import annotations

from carom._compiled.decorators import entry, inlined, kernel
from carom.geometry.rotation import matrix, multiply, rotate


@kernel
def enter(s, placed_a, placed_b):
    """Write the pose of A in axes of B, and the pose of B, to the workspace `s`."""
    p, q, x, o = placed_a.Q, placed_b.Q, placed_a.x, placed_b.x
    a = matrix(p)
    b = matrix(q)
    dx, dy, dz = x[0] - o[0], x[1] - o[1], x[2] - o[2]
    for i in range(3):
        u, v, w = b[i], b[3 + i], b[6 + i]  # column i of B
        s.p[i] = u * dx + v * dy + w * dz
        s.world[0, i], s.world[1, i], s.world[2, i] = u, v, w
        s.origin[i], s.shift[i] = o[i], 0.0
        for j in range(3):
            s.R[i, j] = u * a[j] + v * a[3 + j] + w * a[6 + j]


@entry
def place(solid, x, q, out_x, out_q):
    """Write the world pose of a solid whose body has the pose x, q."""
    p, o = solid.x, solid.Q
    u, v, w = rotate(q, p)
    out_x[0], out_x[1], out_x[2] = x[0] + u, x[1] + v, x[2] + w
    out_q[0], out_q[1], out_q[2], out_q[3] = multiply(q, o)


@inlined
def _times(r, x, y, z):
    """Return the product of a matrix and a vector."""
    return (
        r[0, 0] * x + r[0, 1] * y + r[0, 2] * z,
        r[1, 0] * x + r[1, 1] * y + r[1, 2] * z,
        r[2, 0] * x + r[2, 1] * y + r[2, 2] * z,
    )


@inlined
def from_a(s, x, y, z):
    """Transform a vector from axes of A to axes of B."""
    return _times(s.R, x, y, z)


@inlined
def point_of_a(s, x, y, z):
    """Transform a point of A, which may be moved, from its axes to axes of B."""
    x, y, z = _times(s.R, x, y, z)
    return x + s.p[0] + s.shift[0], y + s.p[1] + s.shift[1], z + s.p[2] + s.shift[2]


@inlined
def to_world(s, x, y, z):
    """Transform a vector from axes of B to world axes."""
    return _times(s.world, x, y, z)


@inlined
def to_a(s, x, y, z):
    """Transform a vector from axes of B to axes of A."""
    r = s.R
    return (
        r[0, 0] * x + r[1, 0] * y + r[2, 0] * z,
        r[0, 1] * x + r[1, 1] * y + r[2, 1] * z,
        r[0, 2] * x + r[1, 2] * y + r[2, 2] * z,
    )
