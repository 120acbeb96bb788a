"""One pair in the axes of B, and back to the world.

Nothing is computed from world coordinates but the difference of the two origins: a pair far from the
world's origin is as exact as one near it.
"""

from __future__ import annotations

from carom._compiled.decorators import entry, inlined, kernel
from carom.geometry.rotation import matrix, multiply, rotate


@kernel
def enter(s, xa, qa, xb, qb):
    """Write the pose of A in axes of B, and the pose of B, to the scratch `s`."""
    a = matrix(qa[0], qa[1], qa[2], qa[3])
    b = matrix(qb[0], qb[1], qb[2], qb[3])
    dx, dy, dz = xa[0] - xb[0], xa[1] - xb[1], xa[2] - xb[2]
    for i in range(3):
        u, v, w = b[i], b[3 + i], b[6 + i]  # column i of B
        s.p[i] = u * dx + v * dy + w * dz
        s.world[0, i], s.world[1, i], s.world[2, i] = u, v, w
        s.origin[i], s.shift[i] = xb[i], 0.0
        for j in range(3):
            s.R[i, j] = u * a[j] + v * a[3 + j] + w * a[6 + j]


@entry
def place(solid, x, q, out_x, out_q):
    """Write the world pose of a solid that has its place in a body with the pose x, q."""
    p, o = solid.x, solid.Q
    u, v, w = rotate(q[0], q[1], q[2], q[3], p[0], p[1], p[2])
    out_x[0], out_x[1], out_x[2] = x[0] + u, x[1] + v, x[2] + w
    out_q[0], out_q[1], out_q[2], out_q[3] = multiply(
        q[0], q[1], q[2], q[3], o[0], o[1], o[2], o[3]
    )


@inlined
def from_a(s, x, y, z):
    """Return a vector of axes of A in axes of B."""
    r = s.R
    return (
        r[0, 0] * x + r[0, 1] * y + r[0, 2] * z,
        r[1, 0] * x + r[1, 1] * y + r[1, 2] * z,
        r[2, 0] * x + r[2, 1] * y + r[2, 2] * z,
    )


@inlined
def to_a(s, x, y, z):
    """Return a vector of axes of B in axes of A."""
    r = s.R
    return (
        r[0, 0] * x + r[1, 0] * y + r[2, 0] * z,
        r[0, 1] * x + r[1, 1] * y + r[2, 1] * z,
        r[0, 2] * x + r[1, 2] * y + r[2, 2] * z,
    )


@inlined
def to_world(s, x, y, z):
    """Return a vector of axes of B in world axes."""
    r = s.world
    return (
        r[0, 0] * x + r[0, 1] * y + r[0, 2] * z,
        r[1, 0] * x + r[1, 1] * y + r[1, 2] * z,
        r[2, 0] * x + r[2, 1] * y + r[2, 2] * z,
    )
