"""Rows of springs and dampers at a state, and the motions that a unit force of each gives: for reports."""

from __future__ import annotations

from carom._compiled.decorators import entry, kernel
from carom.dynamics.bushing import attitude
from carom.dynamics.contact_impulse import clear_wrenches
from carom.dynamics.solve import solve
from carom.dynamics.stiff import line_of
from carom.geometry.rotation import rotate, unit_vector
from carom.kinematics.coordinate import push, rate, value
from carom.kinematics.wrench import add_force, point
from carom.model.arrays import PUSHES, SPRINGS


@kernel
def unit_force(system, state, kind, number, axis, work):
    """Add the wrenches of a unit force; return the coordinate and its rate where it acts along one."""
    if kind == PUSHES:
        c = system.relations.coordinates[system.relations.pushes[number].coordinate]
        push(system, c, state, 1.0, work)
        return value(system, c, state), rate(system, c, state)
    if kind == SPRINGS:
        one = system.springs[number]
        ex, ey, ez, _, ax, ay, az, bx, by, bz = line_of(one, state)
        add_force(work, one.child, (bx, by, bz), (ex, ey, ez))
        add_force(work, one.parent, (ax, ay, az), (-ex, -ey, -ez))
        return 0.0, 0.0
    one = system.bushings[number]
    axes = attitude(state, one.parent, one.parent_frame)
    ex, ey, ez = rotate(axes, unit_vector(axis % 3))
    ax, ay, az, px, py, pz = point(state, one.parent, one.parent_anchor)
    bx, by, bz, qx, qy, qz = point(state, one.child, one.child_anchor)
    if axis < 3:  # both forces act at the child's anchor
        add_force(work, one.child, (bx, by, bz), (ex, ey, ez))
        add_force(work, one.parent, (ax + qx - px, ay + qy - py, az + qz - pz), (-ex, -ey, -ez))
        return 0.0, 0.0
    for side in range(2):
        b, s = (one.child, 1.0) if side == 0 else (one.parent, -1.0)
        if b >= 0:
            wrench = work.body[b].wrench
            wrench[3], wrench[4], wrench[5] = (
                wrench[3] + s * ex, wrench[4] + s * ey, wrench[5] + s * ez,
            )  # fmt: skip
    return 0.0, 0.0


@entry
def write_force_rows(system, state, chosen, work, rows, values):
    """Write rows J and M^-1 J^T beside the joints (2, n, N, 6), and coordinates with their rates (n, 2).

    `chosen` (n, 3) has kind, number, and axis of a mount.
    """
    for i in range(chosen.shape[0]):
        clear_wrenches(work)
        q, speed = unit_force(system, state, chosen[i, 0], chosen[i, 1], chosen[i, 2], work)
        values[i, 0], values[i, 1] = q, speed
        solve(system, state, False, work)
        for b in range(system.bodies.shape[0]):
            for k in range(6):
                rows[0, i, b, k] = work.body[b].wrench[k]
                rows[1, i, b, k] = work.body[b].motion[k]
