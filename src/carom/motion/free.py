"""Free flight of one body: exact translation; rotation exact (equal moments) or of order 4.

A body on which only gravity acts keeps its spatial angular momentum L and its energy of rotation T.
With equal moments w is constant and the rotation is exp(h w). Otherwise the attitude alone is integrated,

    dQ/dt = 1/2 Q (0, W),   W = J^-1 R(Q)^T L,

by the classical Runge-Kutta method; L is then exact, and a last small turn restores T: along a body turn th,
dT = th . (W x l) with l = R^T L, so th = -(T - T0) (W x l)/|W x l|^2. Both invariants hold to round-off
for any number of steps. A turn beyond what the method can have missed, (|W| h)^5 |W x l|/2T, would come from
round-off of T, divided by next to nothing where moments are nearly equal or the axis is nearly principal.
"""

from __future__ import annotations

import math

from carom.geometry.rotation import (
    cross,
    exp,
    multiply,
    normalize,
    renormalize,
    rotate,
    rotate_back,
)
from carom.jit import inlined, kernel


@inlined
def free_flight(body, g, h, start, end, memory):
    """Write into the record `end` the state of a body a time h after the record `start`."""
    x0, v0, w0, q0 = start.x, start.v, start.w, start.Q
    x1, v1, w1, q1 = end.x, end.v, end.w, end.Q
    for k in range(3):
        x1[k] = x0[k] + h * (v0[k] + 0.5 * h * g[k])
        v1[k] = v0[k] + h * g[k]
    if body.isotropic == 1:
        r = exp(h * w0[0], h * w0[1], h * w0[2])
        q = multiply(r[0], r[1], r[2], r[3], q0[0], q0[1], q0[2], q0[3])
        w = (w0[0], w0[1], w0[2])
    else:
        q, w = tumble(body.inertia, h, q0, w0, memory)
    q1[0], q1[1], q1[2], q1[3] = renormalize(q[0], q[1], q[2], q[3])
    w1[0], w1[1], w1[2] = w


@kernel
def turning(i, q, l):
    """Return dQ/dt = 1/2 Q (0, W) for spatial momentum l, W = J^-1 R^T l, with i = 1/J."""
    a = rotate_back(q[0], q[1], q[2], q[3], l[0], l[1], l[2])
    return multiply(
        q[0], q[1], q[2], q[3], 0.0, 0.5 * a[0] * i[0], 0.5 * a[1] * i[1], 0.5 * a[2] * i[2]
    )


@kernel
def along(q, h, k):
    """Return q + h k divided by its length, as a series in d = |q + h k|^2 - 1, which is (h |W|)^2/4 at most.

    What is left of the length tilts what it rotates: to be of no account it has to be of high order in h.
    """
    w, x, y, z = q[0] + h * k[0], q[1] + h * k[1], q[2] + h * k[2], q[3] + h * k[3]
    d = w * w + x * x + y * y + z * z - 1.0
    s = 1.0 - d * (0.5 - d * (0.375 - d * (0.3125 - d * 0.2734375)))
    return s * w, s * x, s * y, s * z


@kernel
def invariants(J, q, w, memory):
    """Put spatial momentum and (twice) energy into `memory`, unless they are those of this flight already.

    Taken anew from Q and w at each step they would drift by the round-off of each step, all of one sign:
    2e-11 of the energy in 10^5 steps.
    """
    spin, l = memory.spin, memory.momentum
    if spin[0] == w[0] and spin[1] == w[1] and spin[2] == w[2]:
        return
    W = rotate_back(q[0], q[1], q[2], q[3], w[0], w[1], w[2])
    m = (J[0] * W[0], J[1] * W[1], J[2] * W[2])
    memory.energy = m[0] * W[0] + m[1] * W[1] + m[2] * W[2]
    l[0], l[1], l[2] = rotate(q[0], q[1], q[2], q[3], m[0], m[1], m[2])


@kernel
def tumble(J, h, q0, w0, memory):
    """Return attitude and angular velocity (world) after a time h; momentum and energy are kept."""
    i = (1.0 / J[0], 1.0 / J[1], 1.0 / J[2])
    invariants(J, q0, w0, memory)
    energy = memory.energy
    l = (memory.momentum[0], memory.momentum[1], memory.momentum[2])
    q = (q0[0], q0[1], q0[2], q0[3])
    k1 = turning(i, q, l)
    k2 = turning(i, along(q, 0.5 * h, k1), l)
    k3 = turning(i, along(q, 0.5 * h, k2), l)
    k4 = turning(i, along(q, h, k3), l)
    s = h / 6.0
    q = normalize(
        q[0] + s * (k1[0] + 2.0 * (k2[0] + k3[0]) + k4[0]),
        q[1] + s * (k1[1] + 2.0 * (k2[1] + k3[1]) + k4[1]),
        q[2] + s * (k1[2] + 2.0 * (k2[2] + k3[2]) + k4[2]),
        q[3] + s * (k1[3] + 2.0 * (k2[3] + k3[3]) + k4[3]),
    )
    m = rotate_back(q[0], q[1], q[2], q[3], l[0], l[1], l[2])
    for _ in range(3):
        W = (m[0] * i[0], m[1] * i[1], m[2] * i[2])
        excess = m[0] * W[0] + m[1] * W[1] + m[2] * W[2] - energy
        d = cross(W[0], W[1], W[2], m[0], m[1], m[2])
        size = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
        # near a principal axis T is at an extremum and cannot drift: nothing to restore
        if not (abs(excess) > 5e-16 * energy and size > 1e-14 * energy * energy):
            break
        turned = h * h * (W[0] * W[0] + W[1] * W[1] + W[2] * W[2])
        missed = turned * turned * math.sqrt(turned * size) / energy + 1e-15
        if not 0.5 * abs(excess) <= missed * math.sqrt(size):
            break
        f = -0.5 * excess / size
        r = exp(f * d[0], f * d[1], f * d[2])
        q = multiply(q[0], q[1], q[2], q[3], r[0], r[1], r[2], r[3])
        m = rotate_back(q[0], q[1], q[2], q[3], l[0], l[1], l[2])
    q = renormalize(q[0], q[1], q[2], q[3])
    w = rotate(q[0], q[1], q[2], q[3], m[0] * i[0], m[1] * i[1], m[2] * i[2])
    memory.spin[0], memory.spin[1], memory.spin[2] = w
    return q, w
