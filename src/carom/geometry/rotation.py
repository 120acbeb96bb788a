"""Rotations as unit quaternions (w, x, y, z) and 3x3 matrices, in scalars: kernels.

`R(Q)` transforms body components to world components. A quaternion, and the vector that it rotates, is an
array or a tuple; results are tuples of scalars.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, inlined, kernel
from carom.geometry.thresholds import HALF_DIGITS


@kernel
def cross(ax, ay, az, bx, by, bz):
    """Return a x b."""
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@kernel
def unit_vector(k):
    """Return the unit vector along axis k."""
    return 1.0 if k == 0 else 0.0, 1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0


@inlined
def multiply(p, q):
    """Return the quaternion product p q (first q, then p)."""
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )


@inlined
def conjugate(q):
    """Return the inverse of a unit quaternion."""
    return q[0], -q[1], -q[2], -q[3]


@kernel
def normalize(q):
    """Return the quaternion divided by its length."""
    s = 1.0 / math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return s * q[0], s * q[1], s * q[2], s * q[3]


@inlined
def renormalize(q):
    """Return a quaternion that is nearly of unit length, normalised by one step of Newton's method."""
    s = 1.5 - 0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return s * q[0], s * q[1], s * q[2], s * q[3]


@kernel
def matrix(q):
    """Return the nine entries, row by row, of the rotation matrix of a unit quaternion."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    xx, yy, zz = x * x, y * y, z * z
    xy, xz, yz = x * y, x * z, y * z
    wx, wy, wz = w * x, w * y, w * z
    return (
        1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy),
        2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wx),
        2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy),
    )  # fmt: skip


@inlined
def rotate(q, a):
    """Return R a: transform body components to world components."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    tx, ty = 2.0 * (y * a[2] - z * a[1]), 2.0 * (z * a[0] - x * a[2])
    tz = 2.0 * (x * a[1] - y * a[0])
    return (
        a[0] + w * tx + y * tz - z * ty,
        a[1] + w * ty + z * tx - x * tz,
        a[2] + w * tz + x * ty - y * tx,
    )


@inlined
def rotate_back(q, a):
    """Return R^T a: transform world components to body components."""
    return rotate(conjugate(q), a)


@entry
def exp(ax, ay, az):
    """Return the unit quaternion exp(a/2) of the rotation vector a; exact to round-off at any angle.

    With t = |a| it is (cos(t/2), sin(t/2)/t a). Below t = 0.25 a series in (t/2)^2 is used, whose next terms
    are below 1e-18: most steps are small, and sine and cosine cost more than the rest of a free step.
    """
    t2 = ax * ax + ay * ay + az * az
    if t2 < 0.0625:
        q = 0.25 * t2
        s = 0.5 * (
            1.0 - q * (1.0 / 6.0) * (1.0 - q * (1.0 / 20.0) * (1.0 - q * (1.0 / 42.0) * (
                1.0 - q * (1.0 / 72.0) * (1.0 - q * (1.0 / 110.0)))))
        )  # fmt: skip
        c = 1.0 - q * 0.5 * (1.0 - q * (1.0 / 12.0) * (1.0 - q * (1.0 / 30.0) * (
            1.0 - q * (1.0 / 56.0) * (1.0 - q * (1.0 / 90.0) * (1.0 - q * (1.0 / 132.0))))))  # fmt: skip
    else:
        t = math.sqrt(t2)
        s = math.sin(0.5 * t) / t
        c = math.cos(0.5 * t)
    return c, s * ax, s * ay, s * az


@inlined
def turn(Q, ax, ay, az):
    """Turn an attitude, (4,), by a rotation vector in world axes: Q <- exp(a) Q."""
    Q[0], Q[1], Q[2], Q[3] = renormalize(multiply(exp(ax, ay, az), Q))


@kernel
def norm(a):
    """Return the length of a vector (3,)."""
    return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


@entry
def log(q):
    """Return the rotation vector of a unit quaternion, its angle in [0, pi]; safe at 0 and pi."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    s2 = x * x + y * y + z * z
    s = math.sqrt(s2)
    if s < HALF_DIGITS:
        f = 2.0 / w * (1.0 - s2 / (3.0 * w * w))
    else:
        f = 2.0 * math.atan2(s, w) / s
    return f * x, f * y, f * z


@kernel
def spin_tensor(R, i):
    """Return the six entries xx, xy, xz, yy, yz, zz of R diag(i) R^T, with R as returned by `matrix`."""
    return (
        R[0] * R[0] * i[0] + R[1] * R[1] * i[1] + R[2] * R[2] * i[2],
        R[0] * R[3] * i[0] + R[1] * R[4] * i[1] + R[2] * R[5] * i[2],
        R[0] * R[6] * i[0] + R[1] * R[7] * i[1] + R[2] * R[8] * i[2],
        R[3] * R[3] * i[0] + R[4] * R[4] * i[1] + R[5] * R[5] * i[2],
        R[3] * R[6] * i[0] + R[4] * R[7] * i[1] + R[5] * R[8] * i[2],
        R[6] * R[6] * i[0] + R[7] * R[7] * i[1] + R[8] * R[8] * i[2],
    )
