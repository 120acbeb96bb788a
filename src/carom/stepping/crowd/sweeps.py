"""The contact problem by Gauss-Seidel sweeps: each contact is solved exactly with the others fixed.

A sweep costs 60 ns per contact. The first one begins with the impulses of the last step; sweeps are mixed
(`carom.stepping.crowd.mixing`).
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.friction.layout import BEST, ITERATE
from carom.friction.newton import copy
from carom.friction.operators import sweep
from carom.friction.residual import residual
from carom.law.turning import arm_of_torque
from carom.model.workspace import MOTION_POINT
from carom.stepping.crowd.mixing import extrapolate, forget, note_end, note_start

UNCHECKED_SWEEPS = 10  # sweeps between two checks of the residual


@kernel
def sweep_until(system, crowd, k, tolerance, most):
    """Sweep until the scaled residual is small; return it, its round-off, and the number of sweeps.

    Sweeps run forward and backward in turn. With friction they may diverge, above all if joints connect the
    points, so the best impulses found are the result.
    """
    work, mixing, done = crowd.problem, crowd.mixing, 0
    p, best = work.vector[ITERATE], work.vector[BEST]
    least, goal, _ = residual(work, k)
    copy(k, p, best)
    forget(mixing)
    while not least <= max(tolerance, goal) and done < most:
        bound_torques(system, crowd, k)
        for turn in range(0, UNCHECKED_SWEEPS, 2):
            if turn > 0 or done > 0:
                extrapolate(work, k, mixing)
            note_start(work, k, mixing)
            sweep(work, k, False)
            sweep(work, k, True)
            note_end(work, k, mixing)
        done += UNCHECKED_SWEEPS
        r, goal, _ = residual(work, k)
        if r < least:
            least = r
            copy(k, p, best)
    copy(k, best, p)
    return least, goal, done


@kernel
def bound_torques(system, crowd, k):
    """Write the bounds d N of rolling and pivoting friction from the present normal impulses."""
    row, q = crowd.problem.contact, crowd.problem.vector[ITERATE]
    for i in range(k):
        spot = crowd.closed[i]
        if spot.motion != MOTION_POINT:
            d = arm_of_torque(system.laws, system.contacts[spot.contact], spot.motion)
            parent = spot.parent
            most = d / crowd.points[0][i].length * row[parent].scale * q[3 * parent]
            row[i].h1 = max(0.0, most) / row[i].scale
