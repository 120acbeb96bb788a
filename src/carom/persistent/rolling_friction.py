"""Rolling and pivoting friction: torques against the relative rotation of two bodies in persistent contact.

    |M_t| <= d_r N    against the tangential part of the relative angular velocity (rolling),
    |M_n| <= d_p N    against its normal part (pivoting).

Each torque is a separate closed point in the contact problem; its rows are those of the rotation times a length
l of the body. It is a Coulomb contact of friction 1 whose "normal" row is coupled to nothing else, so that its
normal impulse is the bound d N/l, with the N of the last round.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.law.turning import arm_of_torque
from carom.model.workspace import MOTION_ROLL
from carom.persistent.memory import is_torque


@kernel
def bound_turning(system, k, group):
    """Write the bounds of torques from the normal impulses (or forces) in `p`; return their relative change."""
    change, largest = 0.0, 0.0
    for i in range(k):
        closed_point = group.closed[i]
        if not is_torque(closed_point):
            continue
        q, W = 3 * i, group.problem.W
        d = arm_of_torque(system.laws, system.contacts[closed_point.contact], closed_point.motion)
        bound = d / group.points[0][i].length * max(0.0, group.p[3 * closed_point.parent])
        W[q, q] = 0.5 * (W[q + 1, q + 1] + W[q + 2, q + 2])
        change = max(change, abs(group.problem.c[q] + W[q, q] * bound))
        largest = max(largest, W[q, q] * bound)
        group.problem.c[q] = -W[q, q] * bound
    return change / largest if largest > 0.0 else 0.0


@kernel
def take_torque(active_point, i, group):
    """Write the torque of the closed point i, of rolling or of pivoting, to its active point."""
    p, length = group.p, group.points[0][i].length
    if group.closed[i].motion == MOTION_ROLL:
        active_point.torque[1] = length * p[3 * i + 1]
        active_point.torque[2] = length * p[3 * i + 2]
    else:
        active_point.torque[0] = length * p[3 * i + 1]
