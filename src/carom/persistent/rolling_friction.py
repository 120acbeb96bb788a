"""Rolling and pivoting friction: torques against the relative rotation of two that stay on each other.

    |M_t| <= d_r N    against the tangential part of the relative angular velocity (rolling),
    |M_n| <= d_p N    against its normal part (pivoting).

Each is a seat of its own in the contact problem, its rows those of the rotation times a length l of the body: a
Coulomb contact of friction 1 whose "normal" row sees nothing but itself, so that its impulse is the bound
d N/l, from the N of the last round.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.impact.workspace import C, P


@kernel
def bound_turning(system, k, cluster):
    """Write the bounds of torques from the normal impulses (or forces) in P; return their change, relative."""
    change, largest = 0.0, 0.0
    for i in range(k):
        seat = cluster.seats[i]
        if seat.turns == 0:
            continue
        q, W = 3 * i, cluster.m[0]
        d = system.contacts[seat.contact].turning[seat.turns - 1]
        bound = d / cluster.points[0][i].length * max(0.0, cluster.v[P][3 * seat.parent])
        W[q, q] = 0.5 * (W[q + 1, q + 1] + W[q + 2, q + 2])
        change = max(change, abs(cluster.v[C][q] + W[q, q] * bound))
        largest = max(largest, W[q, q] * bound)
        cluster.v[C][q] = -W[q, q] * bound
    return change / largest if largest > 0.0 else 0.0


@kernel
def take_torque(hold, i, cluster):
    """Put the torque of the seat i, of rolling or of pivoting, into the list."""
    p, length = cluster.v[P], cluster.points[0][i].length
    if cluster.seats[i].turns == 1:
        hold.torque[1], hold.torque[2] = length * p[3 * i + 1], length * p[3 * i + 2]
    else:
        hold.torque[0] = length * p[3 * i + 1]


@kernel
def first_torque(system, hold, i, h, cluster):
    """Write the last torque of seat i, over a step h, as the first guess."""
    seat, length = cluster.seats[i], cluster.points[0][i].length
    d, p = system.contacts[hold.contact].turning[seat.turns - 1], cluster.v[P]
    p[3 * i] = h * d / length * hold.force[0]
    p[3 * i + 1] = h / length * (hold.torque[1] if seat.turns == 1 else hold.torque[0])
    p[3 * i + 2] = h / length * hold.torque[2] if seat.turns == 1 else 0.0
