"""Rows of springs and dampers at a state, and the motions that a unit force of each gives: for reports."""

from __future__ import annotations

from carom._compiled.decorators import entry
from carom.dynamics.applied import unit_force
from carom.dynamics.contact_impulse import clear_wrenches
from carom.dynamics.solve import solve


@entry
def write_force_rows(system, state, chosen, work, rows, values):
    """Write rows J and M^-1 J^T beside the joints (2, n, N, 6), and coordinates with their rates (n, 2).

    `chosen` (n, 3) has kind, number, and axis of a mount.
    """
    for i in range(chosen.shape[0]):
        clear_wrenches(work)
        q, speed = unit_force(chosen[i, 0], system, chosen[i, 1], chosen[i, 2], state, work)
        values[i, 0], values[i, 1] = q, speed
        solve(system, state, False, work)
        for b in range(system.bodies.shape[0]):
            for k in range(6):
                rows[0, i, b, k] = work.body[b].wrench[k]
                rows[1, i, b, k] = work.body[b].motion[k]
