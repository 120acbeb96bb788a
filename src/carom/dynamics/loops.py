"""Back end for closed loops: block-sparse Cholesky of A M^-1 A^T, dependent pivots dropped.

The same solve as in `carom.dynamics.tree`, through the multipliers: A M^-1 A^T lam = target - A M^-1 wrench,
motion = M^-1 (wrench + A^T lam). Bodies are eliminated first (that is A M^-1 A^T), then the joints in
an order with low fill, which was chosen when the scene was compiled. A pivot below `drop` times
its own diagonal belongs to a row that depends on earlier ones and is left out: redundant
constraints and singular positions need no special treatment. `augment` > 0 adds this fraction of each diagonal
instead: one pass of the augmented Lagrangian, which the caller repeats (the method of the paper, which gives
reactions of minimal norm).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.dynamics.element_operations import build_rows, row_target
from carom.friction import ldl
from carom.kinematics.rows import times_inverse_mass
from carom.model.arrays import LOOPS


@kernel
def factor(system, state, augment, work):
    """Factor A M^-1 A^T + augment * diag in the position of `state`."""
    solver, joints = system.solver, system.joints
    forget_pose(solver)
    build_rows(system, state, work)
    gather(system)
    for j in range(joints.shape[0]):
        for r in range(joints[j].rows):
            d = solver.block[j, r, r]
            solver.rows[j].weight[r] = d
            solver.block[j, r, r] = d * (1.0 + augment) + solver.rows[j].compliance[r]
    eliminate(system, solver.drop if augment == 0.0 else 0.0)


@kernel
def forget_pose(solver):
    """Forget the pose of the last factor; the caller may store that of the next one."""
    for b in range(solver.pose.shape[0]):
        solver.pose[b, 0] = math.nan


@kernel
def gather(system):
    """Write the blocks of A Y^T."""
    solver, joints, block = system.solver, system.joints, system.solver.block
    for k in range(block.shape[0]):
        clear(block[k])
    for t in range(solver.term.shape[0]):
        one, two = solver.sides[solver.term[t, 1]], solver.sides[solver.term[t, 2]]
        add_product(
            block[solver.term[t, 0]],
            one.Y,
            two.A,
            joints[one.element].rows,
            joints[two.element].rows,
        )


@kernel
def eliminate(system, drop):
    """Factor the blocks in place; pivots are compared with the diagonals in `weight`.

    A diagonal block has L below its diagonal and D on it, and `pivot` 1/D, or 0 for a row that is left out.
    """
    solver, joints, block = system.solver, system.joints, system.solver.block
    for place in range(joints.shape[0]):
        k = solver.order[place]
        n, row = joints[k].rows, solver.rows[k]
        for r in range(n):
            ldl.eliminate(n, r, math.inf if row.ignored == 1 else drop * row.weight[r], block[k])
            row.pivot[r] = 1.0 / block[k, r, r] if block[k, r, r] > 0.0 else 0.0
        for s in range(solver.column[place], solver.column[place + 1]):
            divide(block[joints.shape[0] + s], block[k], row.pivot, joints[solver.row[s]].rows, n)
        for t in range(solver.update[place], solver.update[place + 1]):
            update_block(system, t, k)


@kernel
def clear(S):
    """Zero a block."""
    for i in range(6):
        for j in range(6):
            S[i, j] = 0.0


@kernel
def add_product(S, Y, A, m, n):
    """Add Y A^T, m rows of Y and n rows of A, six columns, to S."""
    for i in range(m):
        for j in range(n):
            S[i, j] += (
                Y[i, 0] * A[j, 0] + Y[i, 1] * A[j, 1] + Y[i, 2] * A[j, 2]
                + Y[i, 3] * A[j, 3] + Y[i, 4] * A[j, 4] + Y[i, 5] * A[j, 5]
            )  # fmt: skip


@kernel
def divide(X, L, pivot, m, n):
    """X <- X L^-T D^-1 for a block below the diagonal block L, so that it contains entries of unit L."""
    for i in range(m):
        for k in range(n):
            for s in range(k):
                X[i, k] -= X[i, s] * L[k, s]
        for k in range(n):
            X[i, k] *= pivot[k]


@kernel
def update_block(system, t, k):
    """Subtract a product of two blocks of the column of element k from its block: S <- S - X D Y^T."""
    solver, joints, block = system.solver, system.joints, system.solver.block
    count, i, j = joints.shape[0], solver.triple[t, 0], solver.triple[t, 1]
    S, X, Y = block[solver.triple[t, 2]], block[count + i], block[count + j]
    for s in range(joints[k].rows):
        for a in range(joints[solver.row[i]].rows):
            x = block[k, s, s] * X[a, s]
            for b in range(joints[solver.row[j]].rows):
                S[a, b] -= x * Y[b, s]


@kernel
def substitute(system):
    """Solve with the factor: rhs of all rows becomes the multipliers."""
    solver, joints = system.solver, system.joints
    count = joints.shape[0]
    for place in range(count):
        k = solver.order[place]
        L, y = solver.block[k], solver.rows[k].rhs
        for i in range(joints[k].rows):
            for s in range(i):
                y[i] -= L[i, s] * y[s]
        for t in range(solver.column[place], solver.column[place + 1]):
            i = solver.row[t]
            X, z = solver.block[count + t], solver.rows[i].rhs
            for r in range(joints[i].rows):
                for s in range(joints[k].rows):
                    z[r] -= X[r, s] * y[s]
    for k in range(count):
        for r in range(joints[k].rows):
            solver.rows[k].rhs[r] *= solver.rows[k].pivot[r]
    for place in range(count - 1, -1, -1):
        k = solver.order[place]
        L, y = solver.block[k], solver.rows[k].rhs
        for t in range(solver.column[place], solver.column[place + 1]):
            i = solver.row[t]
            X, z = solver.block[count + t], solver.rows[i].rhs
            for r in range(joints[i].rows):
                for s in range(joints[k].rows):
                    y[s] -= X[r, s] * z[r]
        for i in range(joints[k].rows - 1, -1, -1):
            for s in range(i + 1, joints[k].rows):
                y[i] -= L[s, i] * y[s]


@kernel
def free_motion(system, work):
    """Write motion = M^-1 wrench of each body."""
    for b in range(system.bodies.shape[0]):
        body = work.body[b]
        times_inverse_mass(system.bodies[b].mass, body.inverse, body.wrench, body.motion)


@kernel
def subtract_rows(system, work):
    """Rhs <- rhs - A motion."""
    for i in range(system.solver.sides.shape[0]):
        side = system.solver.sides[i]
        A, motion, rhs = side.A, work.body[side.body].motion, system.solver.rows[side.element].rhs
        for r in range(system.joints[side.element].rows):
            s = 0.0
            for k in range(6):
                s += A[r, k] * motion[k]
            rhs[r] -= s


@kernel
def add_reactions(system, work):
    """Motion <- motion + M^-1 A^T multipliers, where rhs contains the multipliers."""
    for i in range(system.solver.sides.shape[0]):
        side = system.solver.sides[i]
        Y, motion = side.Y, work.body[side.body].motion
        multiplier = system.solver.rows[side.element].rhs
        for r in range(system.joints[side.element].rows):
            for k in range(6):
                motion[k] += Y[r, k] * multiplier[r]


@kernel
def solve_factored(system, state, biased, work):
    """Write the motion of all bodies; the multipliers stay in rhs."""
    free_motion(system, work)
    for j in range(system.joints.shape[0]):
        rhs = system.solver.rows[j].rhs
        if biased:
            row_target(system, j, state, work.joint[j].bias, rhs)
        else:
            for r in range(6):
                rhs[r] = 0.0
    subtract_rows(system, work)
    substitute(system)
    add_reactions(system, work)


@kernel
def _dropped_rows(system, part):
    """Return how many rows the last factor left out, or kept with a pivot below `part` of their diagonal."""
    count = 0
    for j in range(system.joints.shape[0]):
        row = system.solver.rows[j]
        for r in range(system.joints[j].rows):
            if row.pivot[r] == 0.0 or part * row.weight[r] * row.pivot[r] > 1.0:
                count += 1
    return count


@inlined
def dropped_rows(system, part):
    """Return how many rows the last solve left out or nearly left out; only the solve of loops does so."""
    return _dropped_rows(system, part) if system.solver.kind == LOOPS else 0
