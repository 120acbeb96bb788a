"""The springs of a large group by the motion of its bodies, six unknowns each, in place of a matrix of rows.

With the rows R of the forces, the motions Y = P F^T of the bodies that unit forces cause, and compliances
D = eps S (`carom.persistent.springs`),

    (R Y + D) lam = r,    y = Y lam:    (1 + Y D^-1 R) y = Y D^-1 r,    lam = D^-1 (r - R y),

for which no matrix of the rows is formed. A brick of a wall has sixteen points, 48 rows. The matrix of the
motions has blocks for bodies that touch: zeros are left out of its factor, so that walls and rows have a
price in proportion to their bodies. It is for bodies without joints: a force moves no others.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.contact_impulse import acts, alone, spread
from carom.dynamics.delassus import still_all
from carom.friction import lu
from carom.geometry.rotation import unit_vector
from carom.model.workspace import MOTION_PIVOT, MOTION_POINT

# places in `Equations.bodies`: number of bodies of the arms, and of the present factor
KNOWN, FACTORED_BY = 0, 1
LEAST_POINTS = 24  # least number of points of a group whose springs are solved by bodies


@kernel
def note_arms(system, data, count, k):
    """Write the arms of all rows of k points of a group of `count` bodies, if its springs may go by bodies."""
    group, work = data.group, data.work
    forget_arms(group)
    if k < LEAST_POINTS:
        return
    for i in range(k):
        point, parent = group.points[0][i], group.closed[i].parent
        if point.motion > MOTION_PIVOT or not alone(system, point):
            return
        if point.motion != MOTION_POINT:
            bound = group.points[0][parent]
            if bound.a != point.a or bound.b != point.b:
                return
    group.equations.bodies[KNOWN] = count
    for m in range(count):
        group.bodies.place[group.bodies.member[m]] = m
    write_arms(system, k, work.stage, work, group)


@kernel
def forget_arms(group):
    """Note that W alone is known of the rows of a group."""
    group.equations.bodies[KNOWN], group.equations.bodies[FACTORED_BY] = 0, 0


@unit
def write_arms(system, k, state, work, group):
    """Write rows and motions of unit forces of the bodies of k points."""
    for i in range(k):
        point = group.points[0][i]
        for r in range(3):
            arm = group.equations.arms[3 * i + r]
            if acts(point.motion, r):
                spread(system, point, state, unit_vector(r), work)
            write_side(arm, 0, point.a, acts(point.motion, r), (work, group))
            write_side(arm, 1, point.b, acts(point.motion, r), (work, group))
    still_all(k, group.points[0], work)


@kernel
def write_side(arm, side, b, moves, where):
    """Write row and motion of one body of a row, -1 if there is none."""
    work, group = where
    arm.body[side] = group.bodies.place[b] if b >= 0 else -1
    for j in range(6 if b >= 0 else 0):
        arm.row[side, j] = work.body[b].wrench[j] if moves else 0.0
        arm.motion[side, j] = work.body[b].motion[j] if moves else 0.0


@kernel
def goes_by_bodies(n, equations):
    """Return whether the springs of n rows are solved by bodies: less than six rows for each are not."""
    count = equations.bodies[KNOWN]
    return count > 0 and n >= 6 * count


@kernel
def is_factored_by_bodies(equations):
    """Return whether the present factor is that of the motion of bodies."""
    return equations.bodies[FACTORED_BY] > 0


@kernel
def factor_by_bodies(n, equations):
    """Write the factor of 1 + Y D^-1 R for n rows with the stiffness D^-1; return the work of it."""
    count, H = equations.bodies[KNOWN], equations.factor
    equations.bodies[FACTORED_BY] = count
    size = 6 * count
    for i in range(size):
        for j in range(size):
            H[i, j] = 0.0
        H[i, i] = 1.0
    for i in range(n):
        arm = equations.arms[equations.rows[i]]
        for side in range(4):
            a, b = arm.body[side // 2], arm.body[side % 2]
            if a >= 0 and b >= 0:
                add_block(H, (a, b), arm.push[side // 2], arm.row[side % 2], arm.stiffness)
    _, products = lu.factor(H, size, equations.pivot, 0.0)
    return products + 144 * n + size * size


@kernel
def add_block(H, bodies, push, row, stiffness):
    """Add the product of a push, a stiffness and a row to the block of two bodies."""
    a, b = 6 * bodies[0], 6 * bodies[1]
    for i in range(6):
        part, line = stiffness * push[i], H[a + i]
        for j in range(6):
            line[b + j] += part * row[j]


@kernel
def rest_bodies(equations):
    """Set the motion of all bodies to zero."""
    for i in range(6 * equations.bodies[KNOWN]):
        equations.motion[i] = 0.0


@kernel
def move_bodies(arm, of, x, motion):
    """Add a force x along a row to the motion of its bodies: `of` unit forces, its motions or pushes."""
    for side in range(2):
        b = 6 * arm.body[side]
        for j in range(6 if b >= 0 else 0):
            motion[b + j] += x * of[side, j]


@kernel
def rate_of_row(arm, motion):
    """Return the rate of a row in the motion of its bodies."""
    total = 0.0
    for side in range(2):
        b = 6 * arm.body[side]
        for j in range(6 if b >= 0 else 0):
            total += arm.row[side, j] * motion[b + j]
    return total


@kernel
def push_by_unknowns(n, equations, part, x):
    """Add `part` times the forces x of the n unknowns, with their friction, to the motion of the bodies."""
    for i in range(n):
        arm = equations.arms[equations.rows[i]]
        move_bodies(arm, arm.push, part * x[i], equations.motion)


@kernel
def push_by_forces(k, equations, p):
    """Write the motion of the bodies by the forces p in all rows of k points."""
    rest_bodies(equations)
    for row in range(3 * k):
        if p[row] != 0.0:
            arm = equations.arms[row]
            move_bodies(arm, arm.motion, p[row], equations.motion)


@kernel
def multiply_by_bodies(n, equations, z, q):
    """Write q = R Y z."""
    rest_bodies(equations)
    push_by_unknowns(n, equations, 1.0, z)
    for i in range(n):
        q[i] = rate_of_row(equations.arms[equations.rows[i]], equations.motion)


@kernel
def solve_by_bodies(n, equations, x):
    """Replace x by the solution of (R Y + D) x = x, with the present factor."""
    arms, rows, motion = equations.arms, equations.rows, equations.motion
    rest_bodies(equations)
    for i in range(n):
        x[i] *= arms[rows[i]].stiffness
    push_by_unknowns(n, equations, 1.0, x)
    lu.substitute(equations.factor, 6 * equations.bodies[KNOWN], equations.pivot, motion)
    for i in range(n):
        x[i] -= arms[rows[i]].stiffness * rate_of_row(arms[rows[i]], motion)
