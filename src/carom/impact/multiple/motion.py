"""Velocities and forces of the layers of a group: udot = W lambda, ddot = -u_n, Pdot = lambda (§2.1)."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.impact.multiple.lanes import blocks
from carom.impact.multiple.law import force
from carom.impact.multiple.layout import LANES, MASS, NOW_P, NOW_U, U0


@kernel
def add_velocity(n, W, impulse, u):
    """Add W times `impulse` to `u` (W is symmetric: its columns are its rows)."""
    for j in range(n):
        q, column = impulse[j], W[j]
        if q != 0.0:
            for i in range(n):
                u[i] += q * column[i]


@kernel
def set_velocity(k, work):
    """Write u = u0 + W P, so that momentum is exact at every step."""
    u, u0 = work.vector[NOW_U], work.vector[U0]
    for i in range(3 * k):
        u[i] = u0[i]
    add_velocity(3 * k, work.matrix[MASS], work.vector[NOW_P], u)


@kernel
def into_lanes(k, work):
    """Copy W of the group, column by column, in the form for the series."""
    W, columns = work.matrix[MASS], work.columns
    width = columns.shape[1] // 3
    for j in range(3 * k):
        for b in range(blocks(k)):
            for r in range(3):
                for l in range(LANES):
                    i = LANES * b + l
                    columns[j, r * width + b, l] = W[j, 3 * i + r] if i < k else 0.0


@kernel
def normal_forces(k, work, d, p, out):
    """Write (N, 0, 0) of each contact at depths `d`."""
    for i in range(k):
        n = 3 * i
        out[n] = force(work.contact[i], d[i], p)
        out[n + 1] = 0.0
        out[n + 2] = 0.0
