"""The equations of a large group by the motion of its bodies, six unknowns each, in place of a matrix of rows.

With the rows R of the forces x and the motions Y of the bodies that unit forces cause, W = R Y, springs with
compliances eps S (`carom.persistent.springs`) and Newton's method for discs (`carom.persistent.coulomb_stage`)
have the form

    (J + D R Y) x = r,    y = Y x:    (1 + Y J^-1 D R) y = Y J^-1 r,    x = J^-1 (r - D R y),

for which no matrix of the rows is formed, W neither. J and D have blocks for an entry; the friction of a disc
follows the normal force that bounds it. A brick of a wall has sixteen points, 48 rows. The matrix of the
motions has blocks for bodies that touch, and is factored on their graph, so that walls and rows have a price
in proportion to their bodies. It is for bodies without joints: a force moves no others.
"""

from __future__ import annotations

from carom._compiled.decorators import by_reference, kernel
from carom._compiled.units import unit
from carom.dynamics.contact_impulse import acts, alone, spread
from carom.dynamics.delassus import still_all
from carom.friction.blocks import begin_blocks, factor_blocks, substitute_blocks
from carom.friction.graph import find_order, of_present_size
from carom.geometry.rotation import unit_vector
from carom.impact.workspace import LEAST_POINTS
from carom.model.workspace import MOTION_PIVOT, MOTION_POINT

FACTORED = 1  # place of the work of factors in `Equations.iterations`: a point has three rows
PASS = 9  # entries of a matrix: to write or to multiply so many takes the time of one unit of that work


@kernel
def note_arms(system, data, count, k, state):
    """Write the arms of all rows of k points of a group of `count` bodies, if it may be solved by bodies."""
    group, work = data.group, data.work
    group.equations.bodies[0] = 0  # W is known, until arms are
    if not may_know_arms(system, k, group):
        return
    for m in range(count):
        group.bodies.place[group.bodies.member[m]] = m
    write_arms(system, k, state, work, group)
    if find_order(count, k, group.equations.graph, group.equations.tree):
        group.equations.bodies[0] = count
        write_own(k, group)


@kernel
def may_know_arms(system, k, group):
    """Return whether k points are many, and none is of joined bodies."""
    for i in range(k):
        point, parent = group.points[0][i], group.closed[i].parent
        if point.motion > MOTION_PIVOT or not alone(system, point):
            return False
        if point.motion != MOTION_POINT:
            bound = group.points[0][parent]
            if bound.a != point.a or bound.b != point.b:
                return False
    return k >= LEAST_POINTS


@unit
def write_arms(system, k, state, work, group):
    """Write bodies, rows and motions of unit forces of k points."""
    for i in range(k):
        point, link = group.points[0][i], group.equations.tree.link[i]
        link.body[0] = group.bodies.place[point.a]
        link.body[1] = group.bodies.place[point.b] if point.b >= 0 else -1
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
def write_own(k, group):
    """Write the blocks of W of each point, which are symmetric."""
    for i in range(k):
        for a in range(3):
            for b in range(a + 1):
                one, other = group.equations.arms[3 * i + a], group.equations.arms[3 * i + b]
                group.own[3 * i + a, b] = group.own[3 * i + b, a] = rate_by_unit_force(one, other)


@kernel
def rate_by_unit_force(one, other):
    """Return the rate of one row of a point by a unit force in another row of it."""
    total = 0.0
    for side in range(2 if one.body[1] >= 0 else 1):
        for j in range(6):
            total += one.row[side, j] * other.motion[side, j]
    return total


@kernel
def knows_arms(equations):
    """Return whether the equations of the group may be solved by bodies."""
    return equations.bodies[0] > 0


@kernel
def set_alone(equations, row, compliance):
    """Write the equation of a force that follows no other: its rate, with a compliance in the factor."""
    arm = equations.arms[row]
    arm.other, arm.leader = row, row
    arm.rate[0], arm.rate[1], arm.own[0], arm.own[1], arm.bound = 1.0, 0.0, 0.0, 0.0, 0.0
    arm.inverse[0], arm.inverse[1], arm.follow = 1.0 / compliance, 0.0, 0.0
    for side in range(2):
        for j in range(6):
            arm.push[side, j] = arm.motion[side, j]
            arm.lead[side, j] = arm.row[side, j] / compliance


@kernel
def set_on_disc(equations, row, compliances):
    """Write J^-1 and J^-1 D of friction on its disc, with compliances of both rows, and what it follows."""
    a = equations.arms[row]
    b, (ca, cb) = equations.arms[a.other], compliances
    if a.other == row:
        a.inverse[0], a.inverse[1] = 1.0 / (a.own[0] + ca), 0.0
    else:
        det = (a.own[0] + ca) * (b.own[0] + cb) - a.own[1] * b.own[1]
        a.inverse[0], a.inverse[1] = (b.own[0] + cb) / det, -a.own[1] / det
    a.follow = -(a.inverse[0] * a.bound + (a.inverse[1] * b.bound if a.other != row else 0.0))
    leader = equations.arms[a.leader]
    # (J^-1 D) in the rows of both
    first = a.inverse[0] * a.rate[0] + a.inverse[1] * b.rate[1]
    second = a.inverse[0] * a.rate[1] + a.inverse[1] * b.rate[0]
    for side in range(2):
        for j in range(6 if a.body[side] >= 0 else 0):
            a.push[side, j] = a.motion[side, j]
            a.lead[side, j] = first * a.row[side, j] + second * b.row[side, j]
            if a.leader != row:
                leader.push[side, j] += a.follow * a.motion[side, j]


@kernel
def factor_by_bodies(n, rows, equations):
    """Write the factor of 1 + Y J^-1 D R for n rows."""
    count, arms = equations.bodies[0], equations.arms
    tree = by_reference(of_present_size(count, equations.graph, equations.tree))
    begin_blocks(tree)
    i = 0
    while i < n:
        row, whole = rows[i], is_whole(i, n, rows)
        corner = tree.link[row // 3].corner
        for side in range(4):
            a, b = side // 2, side % 2
            if corner[a, b] < 0:
                continue
            if whole:
                add_products(tree.block[corner[a, b]], arms, row, a, b)
            else:
                add_product(tree.block[corner[a, b]], arms[row].push[a], arms[row].lead[b])
        i += 3 if whole else 1
    factor_blocks(tree)
    count_products(144 * n + 216 * (tree.target.shape[0] + tree.block.shape[0]), equations)


@kernel
def count_products(count, equations):
    """Add products to the work of factors."""
    equations.iterations[FACTORED] += count // PASS


@kernel
def is_whole(i, n, rows):
    """Return whether all three rows of an entry are given from place i on: they are used together."""
    row = rows[i]
    return i + 2 < n and row % 3 == 0 and rows[i + 1] == row + 1 and rows[i + 2] == row + 2


@kernel
def add_products(block, arms, row, a, b):
    """Add the products of pushes of body a and leads of body b of three rows to their block."""
    p, q, r = arms[row].push[a], arms[row + 1].push[a], arms[row + 2].push[a]
    x, y, z = arms[row].lead[b], arms[row + 1].lead[b], arms[row + 2].lead[b]
    for i in range(6):
        for j in range(6):
            block[i, j] += p[i] * x[j] + q[i] * y[j] + r[i] * z[j]


@kernel
def add_product(block, push, lead):
    """Add the product of a push and a lead to the block of two bodies."""
    for i in range(6):
        for j in range(6):
            block[i, j] += push[i] * lead[j]


@kernel
def rest_bodies(equations):
    """Set the motion of all bodies to zero."""
    for b in range(equations.bodies[0]):
        for j in range(6):
            equations.tree.body[b].motion[j] = 0.0


@kernel
def move_bodies(arm, of, x, body):
    """Add a force x along a row to the motion of its bodies: `of` unit forces, its motions or pushes."""
    for side in range(2):
        if arm.body[side] >= 0:
            motion = body[arm.body[side]].motion
            for j in range(6):
                motion[j] += x * of[side, j]


@kernel
def rate_in(arm, along, body):
    """Return the rate along the row, or the lead, of an arm in the motion of its bodies.

    Four short sums do not wait for each other as one long sum does.
    """
    total = 0.0
    for side in range(2):
        if arm.body[side] >= 0:
            v, G = body[arm.body[side]].motion, along[side]
            linear = G[0] * v[0] + G[1] * v[1] + G[2] * v[2]
            total += linear + (G[3] * v[3] + G[4] * v[4] + G[5] * v[5])
    return total


@kernel
def rate_of_row(arm, equations):
    """Return the rate of a row in the present motion of the bodies."""
    return rate_in(arm, arm.row, equations.tree.body)


@kernel
def push_by_unknowns(n, rows, equations, part, x):
    """Add `part` times the forces x in n rows to the motion of the bodies."""
    arms = equations.arms
    for i in range(n):
        arms[rows[i]].force = x[i]
    for i in range(n):
        arm = arms[rows[i]]
        arm.alone = part * (x[i] - arm.follow * arms[arm.leader].force)
    push_alone(n, rows, equations)


@kernel
def push_alone(n, rows, equations):
    """Add the pushes of what the forces in n rows are beside those that follow others."""
    arms, body, i = equations.arms, equations.tree.body, 0
    while i < n:
        first, whole = arms[rows[i]], is_whole(i, n, rows)
        if whole:
            second, third = arms[rows[i] + 1], arms[rows[i] + 2]
            x, y, z = first.alone, second.alone, third.alone
            for side in range(2):
                if first.body[side] >= 0:
                    motion = body[first.body[side]].motion
                    p, q, r = first.push[side], second.push[side], third.push[side]
                    for j in range(6):
                        motion[j] += x * p[j] + y * q[j] + z * r[j]
        else:
            move_bodies(first, first.push, first.alone, body)
        i += 3 if whole else 1


@kernel
def push_by_forces(k, equations, p):
    """Write the motion of the bodies by the forces p in all rows of k points."""
    arms, body = equations.arms, equations.tree.body
    rest_bodies(equations)
    for row in range(0, 3 * k, 3):
        x, y, z = p[row], p[row + 1], p[row + 2]
        if x == 0.0 and y == 0.0 and z == 0.0:
            continue
        for side in range(2):
            if arms[row].body[side] >= 0:
                motion = body[arms[row].body[side]].motion
                a, b, c = (
                    arms[row].motion[side],
                    arms[row + 1].motion[side],
                    arms[row + 2].motion[side],
                )
                for j in range(6):
                    motion[j] += x * a[j] + y * b[j] + z * c[j]


@kernel
def multiply_by_bodies(n, rows, equations, z, q):
    """Write q = (J + D R Y) z."""
    count_products(24 * n, equations)
    arms = equations.arms
    rest_bodies(equations)
    push_by_unknowns(n, rows, equations, 1.0, z)
    for i in range(n):
        arms[rows[i]].gives = rate_of_row(arms[rows[i]], equations)
    for i in range(n):
        arm = arms[rows[i]]
        q[i] = arm.rate[0] * arm.gives
        if arm.own[0] != 0.0:
            other, leader = arms[arm.other], arms[arm.leader]
            q[i] += arm.rate[1] * other.gives + arm.own[0] * z[i] + arm.own[1] * other.force
            q[i] += arm.bound * leader.force


@kernel
def solve_by_bodies(n, rows, equations, x):
    """Replace x by the solution of (J + eps S + D R Y) x = x, with the present factor."""
    arms, body = equations.arms, equations.tree.body
    rest_bodies(equations)
    for i in range(n):
        arms[rows[i]].gives = x[i]
    for i in range(n):
        arm = arms[rows[i]]
        arm.alone = arm.inverse[0] * x[i] + arm.inverse[1] * arms[arm.other].gives
        arm.force = arm.alone + arm.follow * arms[arm.leader].force
    push_alone(n, rows, equations)
    tree = by_reference(of_present_size(equations.bodies[0], equations.graph, equations.tree))
    substitute_blocks(tree)
    count_products(24 * n + 36 * tree.block.shape[0], equations)
    for i in range(n):
        arm = arms[rows[i]]
        x[i] = arm.force
        arm.force = arm.follow * arms[arm.leader].force - rate_in(arm, arm.lead, body)
        x[i] += arm.force
