"""Closed loops of bodies whose masses and moments differ by more than `MASS_RATIO`.

A M^-1 A^T is the sum of the compliances of all bodies. Light bodies have large compliances. If a light body is
between two heavy ones, the compliance of the heavy ones is a small difference of large numbers, a fraction
(light mass)/(heavy mass) of them. So there are two differences from `carom.dynamics.loops`.

Whether rows depend on others is a question of geometry. It is decided for bodies of equal mass, with moments
equal to the squares of their sizes: by A D^-1 A^T, whose pivots do not depend on masses.

The remaining rows are solved with 31 digits (`carom.dynamics.double_double`). All products of entries of
U = A M^-1/2, in principal axes, are exact, and

    U U^T = L L^T,    L L^T lam = target - U y0,   y = y0 + U^T lam,    y0 = M^-1/2 wrench, motion = M^-1/2 y.

Only U is rounded, by 1e-16 of each entry: this is a relative change of the joints by as much, for any masses.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.double_double import add, add_product, inverse_root, multiply, subtract_product
from carom.dynamics.element_operations import build_rows, row_target
from carom.dynamics.loops import eliminate, forget_pose, gather
from carom.dynamics.thresholds import LAST_PIVOT
from carom.geometry.rotation import rotate, rotate_back


@kernel
def geometric_rows(system):
    """Turn Y of all sides into A D^-1: equal masses, moments that are the squares of the sizes."""
    for i in range(system.solver.sides.shape[0]):
        side = system.solver.sides[i]
        extent = system.bodies[side.body].extent
        turn = 1.0 / (extent * extent)
        for r in range(system.joints[side.element].rows):
            for k in range(3):
                side.Y[r, k], side.Y[r, 3 + k] = side.A[r, k], turn * side.A[r, 3 + k]


@kernel
def geometric_motion(system, work):
    """Write motion = D^-1 wrench of each body."""
    for b in range(system.bodies.shape[0]):
        f, out, extent = work.body[b].wrench, work.body[b].motion, system.bodies[b].extent
        for k in range(3):
            out[k], out[3 + k] = f[k], f[3 + k] / (extent * extent)


@kernel
def factor_geometry(system, state, augment, work):
    """Factor A D^-1 A^T: its pivots are 0 for rows that depend on others."""
    solver, joints = system.solver, system.joints
    forget_pose(solver)
    build_rows(system, state, work)
    geometric_rows(system)
    gather(system)
    for j in range(joints.shape[0]):
        for r in range(joints[j].rows):
            d = solver.block[j, r, r]
            solver.rows[j].weight[r] = d
            # a row with a compliance of its own depends on no other row
            yields = augment if augment > 0.0 or solver.rows[j].compliance[r] == 0.0 else 1.0
            solver.block[j, r, r] = d * (1.0 + yields)
    eliminate(system, solver.drop if augment == 0.0 else 0.0)


@kernel
def factor_light(system, state, work):
    """Find the independent rows, and factor U U^T of these."""
    factor_geometry(system, state, 0.0, work)
    scaled_rows(system, state)
    solver, joints, count = system.solver, system.joints, system.joints.shape[0]
    high, low = solver.fine[0], solver.fine[1]
    gather_products(system, high, low)
    for place in range(count):
        k = solver.order[place]
        n, root, rest = joints[k].rows, solver.digits[k, 0], solver.digits[k, 1]
        factor_block(high[k], low[k], solver.rows[k], root, rest, n)
        for s in range(solver.column[place], solver.column[place + 1]):
            divide(solver, count + s, k, joints[solver.row[s]].rows, n)
        for t in range(solver.update[place], solver.update[place + 1]):
            update_block(solver, joints, t, n)


@kernel
def update_block(solver, joints, t, n):
    """Subtract a product of two blocks of a column n wide from its block of the factor: c -= a b^T."""
    high, low, count, triple = solver.fine[0], solver.fine[1], joints.shape[0], solver.triple[t]
    m, q = joints[solver.row[triple[0]]].rows, joints[solver.row[triple[1]]].rows
    a, b, c = count + triple[0], count + triple[1], triple[2]
    for i in range(m):
        for j in range(q):
            x, y = high[c, i, j], low[c, i, j]
            for s in range(n):
                x, y = subtract_product(
                    x, y, high[a, i, s], low[a, i, s], high[b, j, s], low[b, j, s]
                )
            high[c, i, j], low[c, i, j] = x, y


@kernel
def scaled_rows(system, state):
    """Turn Y of all sides into U: rows in principal axes, over roots of masses and moments; store the axes."""
    for b in range(system.bodies.shape[0]):
        for k in range(4):
            system.solver.scaled[b, 2, k] = state[b].Q[k]
    for i in range(system.solver.sides.shape[0]):
        side = system.solver.sides[i]
        body, q, A, U = system.bodies[side.body], state[side.body].Q, side.A, side.Y
        root = 1.0 / math.sqrt(body.mass)
        for r in range(system.joints[side.element].rows):
            t = rotate_back(q, A[r, 3:])
            for k in range(3):
                U[r, k], U[r, 3 + k] = root * A[r, k], t[k] / math.sqrt(body.inertia[k])


@kernel
def gather_products(system, high, low):
    """Write the blocks of U U^T, and compliances."""
    solver, joints = system.solver, system.joints
    for c in range(high.shape[0]):
        for i in range(6):
            for j in range(6):
                high[c, i, j], low[c, i, j] = 0.0, 0.0
    for t in range(solver.term.shape[0]):
        c = solver.term[t, 0]
        one, two = solver.sides[solver.term[t, 1]], solver.sides[solver.term[t, 2]]
        for i in range(joints[one.element].rows):
            for j in range(joints[two.element].rows):
                x, y = high[c, i, j], low[c, i, j]
                for k in range(6):
                    x, y = add_product(x, y, one.Y[i, k], two.Y[j, k])
                high[c, i, j], low[c, i, j] = x, y
    for j in range(joints.shape[0]):
        for r in range(joints[j].rows):
            x, y = high[j, r, r], low[j, r, r]
            high[j, r, r], low[j, r, r] = add(x, y, solver.rows[j].compliance[r], 0.0)


@kernel
def factor_block(high, low, row, root, rest, n):
    """Factor a diagonal block in place, L below the diagonal; root + rest = 1/L_kk, 0 for a row left out.

    The result is NaN if a pivot is only round-off: the rows are independent in geometry, but not with the
    masses.
    """
    for k in range(n):
        d, e = high[k, k], low[k, k]
        least = LAST_PIVOT * d
        for s in range(k):
            d, e = subtract_product(d, e, high[k, s], low[k, s], high[k, s], low[k, s])
        root[k], rest[k] = 0.0, 0.0
        if row.pivot[k] != 0.0:
            root[k], rest[k] = inverse_root(d, e) if d > least else (math.nan, math.nan)
        for i in range(k + 1, n):
            x, y = high[i, k], low[i, k]
            for s in range(k):
                x, y = subtract_product(x, y, high[i, s], low[i, s], high[k, s], low[k, s])
            high[i, k], low[i, k] = multiply(x, y, root[k], rest[k])


@kernel
def divide(solver, c, k, m, n):
    """X <- X L^-T for a block c, (m, n), below the diagonal block k."""
    high, low, root, rest = solver.fine[0], solver.fine[1], solver.digits[k, 0], solver.digits[k, 1]
    for i in range(m):
        for j in range(n):
            x, y = high[c, i, j], low[c, i, j]
            for s in range(j):
                x, y = subtract_product(
                    x, y, high[c, i, s], low[c, i, s], high[k, j, s], low[k, j, s]
                )
            high[c, i, j], low[c, i, j] = multiply(x, y, root[j], rest[j])


@kernel
def substitute_light(system):
    """Turn the right-hand sides into multipliers, high and low parts."""
    solver, joints = system.solver, system.joints
    count, high, low, digits = joints.shape[0], solver.fine[0], solver.fine[1], solver.digits
    for place in range(count):
        k = solver.order[place]
        n, root, rest, h, e = joints[k].rows, digits[k, 0], digits[k, 1], digits[k, 2], digits[k, 3]
        for i in range(n):
            x, y = h[i], e[i]
            for s in range(i):
                x, y = subtract_product(x, y, high[k, i, s], low[k, i, s], h[s], e[s])
            h[i], e[i] = multiply(x, y, root[i], rest[i])
        for t in range(solver.column[place], solver.column[place + 1]):
            i = solver.row[t]
            for r in range(joints[i].rows):
                x, y = digits[i, 2, r], digits[i, 3, r]
                for s in range(n):
                    a, b = high[count + t, r, s], low[count + t, r, s]
                    x, y = subtract_product(x, y, a, b, h[s], e[s])
                digits[i, 2, r], digits[i, 3, r] = x, y
    for place in range(count - 1, -1, -1):
        k = solver.order[place]
        n, root, rest, h, e = joints[k].rows, digits[k, 0], digits[k, 1], digits[k, 2], digits[k, 3]
        for t in range(solver.column[place], solver.column[place + 1]):
            i = solver.row[t]
            for r in range(joints[i].rows):
                for s in range(n):
                    a, b = high[count + t, r, s], low[count + t, r, s]
                    h[s], e[s] = subtract_product(
                        h[s], e[s], a, b, digits[i, 2, r], digits[i, 3, r]
                    )
        for i in range(n - 1, -1, -1):
            x, y = h[i], e[i]
            for s in range(i + 1, n):
                x, y = subtract_product(x, y, high[k, s, i], low[k, s, i], h[s], e[s])
            h[i], e[i] = multiply(x, y, root[i], rest[i])
    for k in range(count):
        for r in range(joints[k].rows):
            solver.rows[k].rhs[r] = digits[k, 2, r]


@kernel
def solve_light(system, state, biased, work):
    """Write the motion of all bodies in the position that was last factored; the multipliers stay in rhs."""
    solver, joints, digits = system.solver, system.joints, system.solver.digits
    y = solver.scaled
    for b in range(system.bodies.shape[0]):
        body, f, q = system.bodies[b], work.body[b].wrench, y[b, 2]
        t = rotate_back(q, f[3:])
        for k in range(3):
            y[b, 0, k] = f[k] / math.sqrt(body.mass)
            y[b, 0, 3 + k] = t[k] / math.sqrt(body.inertia[k])
            y[b, 1, k], y[b, 1, 3 + k] = 0.0, 0.0
    for j in range(joints.shape[0]):
        rhs = solver.rows[j].rhs
        if biased:
            row_target(system, j, state, work.joint[j].bias, rhs)
        for r in range(joints[j].rows):
            digits[j, 2, r], digits[j, 3, r] = rhs[r] if biased else 0.0, 0.0
    for i in range(solver.sides.shape[0]):
        side = solver.sides[i]
        U, out, own = side.Y, digits[side.element], y[side.body, 0]
        for r in range(joints[side.element].rows):
            for k in range(6):
                out[2, r], out[3, r] = add_product(out[2, r], out[3, r], -U[r, k], own[k])
    substitute_light(system)
    for i in range(solver.sides.shape[0]):
        side = solver.sides[i]
        U, given, own = side.Y, digits[side.element], y[side.body]
        for r in range(joints[side.element].rows):
            for k in range(6):
                own[0, k], own[1, k] = subtract_product(
                    own[0, k], own[1, k], -U[r, k], 0.0, given[2, r], given[3, r]
                )
    for b in range(system.bodies.shape[0]):
        body, out, q = system.bodies[b], work.body[b].motion, y[b, 2]
        J, a = body.inertia, y[b, 0]
        t = (a[3] / math.sqrt(J[0]), a[4] / math.sqrt(J[1]), a[5] / math.sqrt(J[2]))
        t = rotate(q, t)
        for k in range(3):
            out[k], out[3 + k] = a[k] / math.sqrt(body.mass), t[k]
