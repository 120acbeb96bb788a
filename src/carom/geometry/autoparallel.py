"""Autoparallel arcs of N bodies on (R^3 x SO(3))^N: kernels that write into `out`.

A tangent vector xi (N, 6) has the velocity components of the left-invariant frame: three along the
world axes [m], then three along the body axes [rad] (mathematics page, *Connection and
autoparallels*). An output array may be one of the input arrays.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry
from carom.geometry import rotation, tangent


@entry
def exp(x, Q, xi, out_x, out_Q):
    """Write the end point (x + xi_x, R exp(hat xi_theta)) of the arc xi from (x, Q)."""
    for i in range(x.shape[0]):
        ew, ex, ey, ez = rotation.exp(xi[i, 3], xi[i, 4], xi[i, 5])
        w, a, b, c = rotation.multiply(Q[i, 0], Q[i, 1], Q[i, 2], Q[i, 3], ew, ex, ey, ez)
        out_Q[i, 0], out_Q[i, 1], out_Q[i, 2], out_Q[i, 3] = rotation.normalize(w, a, b, c)
        for j in range(3):
            out_x[i, j] = x[i, j] + xi[i, j]


@entry
def log(x0, Q0, x1, Q1, out):
    """Write the arc from (x0, Q0) to (x1, Q1) that turns each body by an angle in [0, pi]."""
    for i in range(x0.shape[0]):
        w, a, b, c = rotation.multiply(
            Q0[i, 0], -Q0[i, 1], -Q0[i, 2], -Q0[i, 3], Q1[i, 0], Q1[i, 1], Q1[i, 2], Q1[i, 3]
        )
        out[i, 3], out[i, 4], out[i, 5] = rotation.log(w, a, b, c)
        for j in range(3):
            out[i, j] = x1[i, j] - x0[i, j]


@entry
def transport_vector(xi, vector, out):
    """Write `vector` (N, 6) after parallel transport along the arc xi: exp(-hat xi_theta) for the rotations.

    The components along the world axes do not change: a vector that is parallel along an arc is fixed in space.
    """
    for i in range(xi.shape[0]):
        ew, ex, ey, ez = rotation.exp(xi[i, 3], xi[i, 4], xi[i, 5])
        for j in range(3):
            out[i, j] = vector[i, j]
        out[i, 3], out[i, 4], out[i, 5] = rotation.rotate_back(
            ew, ex, ey, ez, vector[i, 3], vector[i, 4], vector[i, 5]
        )


@entry
def transport_covector(xi, covector, out):
    """Write `covector` (N, 6) after parallel transport along the arc xi, which preserves <p, w>.

    This is the inverse transpose of `transport_vector`; for a rotation it is the rotation itself.
    """
    transport_vector(xi, covector, out)


@entry
def differential(xi, rate, out):
    """Write the velocity (N, 6) of the arc's end point when xi changes at `rate` (N, 6)."""
    for i in range(xi.shape[0]):
        for j in range(3):
            out[i, j] = rate[i, j]
        out[i, 3], out[i, 4], out[i, 5] = tangent.apply(
            xi[i, 3], xi[i, 4], xi[i, 5], rate[i, 3], rate[i, 4], rate[i, 5]
        )


@entry
def differential_inverse(xi, velocity, out):
    """Write the rate of xi at which the arc's end point has `velocity` (N, 6); angles < 2 pi."""
    for i in range(xi.shape[0]):
        for j in range(3):
            out[i, j] = velocity[i, j]
        out[i, 3], out[i, 4], out[i, 5] = tangent.apply_inverse(
            xi[i, 3], xi[i, 4], xi[i, 5], velocity[i, 3], velocity[i, 4], velocity[i, 5]
        )


@entry
def length(m, J, xi):
    """Return the length sqrt(xi . M xi) [sqrt(kg) m] of the arc; m (N,), principal J (N, 3)."""
    total = 0.0
    for i in range(xi.shape[0]):
        for j in range(3):
            total += m[i] * xi[i, j] * xi[i, j] + J[i, j] * xi[i, 3 + j] * xi[i, 3 + j]
    return math.sqrt(total)
