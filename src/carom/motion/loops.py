"""Back end for closed loops: block-sparse Cholesky of A M^-1 A^T, dependent pivots dropped.

The same solve as in `carom.motion.tree`, through the multipliers: A M^-1 A^T lam = target - A M^-1 wrench,
motion = M^-1 (wrench + A^T lam). Bodies are eliminated first (that is A M^-1 A^T), then the joints in
an order of low fill that was chosen when the scene was compiled. A pivot below `drop` times
its own diagonal belongs to a row that depends on earlier ones and is left out: redundant
constraints and singular positions need no help. `augment` > 0 adds that part of each diagonal instead: one pass of
the augmented Lagrangian, repeated by the caller (the paper's way, and the way to reactions of minimal norm).
"""

from __future__ import annotations

from carom.jit import kernel
from carom.motion.rows import build_rows, row_targets, times_inverse_mass


@kernel
def factor(system, x, Q, augment):
    """Factor A M^-1 A^T + augment * diag in the position (x, Q)."""
    solver, joints = system.solver, system.joints
    build_rows(system, x, Q)
    solver.block[:] = 0.0
    for t in range(solver.term.shape[0]):
        i, j = solver.term[t, 1], solver.term[t, 3]
        add_product(
            solver.block[solver.term[t, 0]], solver.scaled[i, solver.term[t, 2]],
            solver.rows[j, solver.term[t, 4]], joints.rows[i], joints.rows[j],
        )  # fmt: skip
    for j in range(joints.kind.size):
        for r in range(joints.rows[j]):
            d = solver.block[j, r, r]
            solver.diagonal[j, r] = d
            solver.block[j, r, r] = d * (1.0 + augment)
    drop = solver.drop if augment == 0.0 else 0.0
    for place in range(solver.order.size):
        k = solver.order[place]
        n = joints.rows[k]
        factor_diagonal(solver.block[k], solver.pivot[k], solver.diagonal[k], n, drop)
        for s in range(solver.column[place], solver.column[place + 1]):
            divide(solver.block[joints.kind.size + s], solver.block[k], solver.pivot[k],
                   joints.rows[solver.row[s]], n)  # fmt: skip
        for t in range(solver.update[place], solver.update[place + 1]):
            i, j = solver.triple[t, 0], solver.triple[t, 1]
            subtract_product(
                solver.block[solver.triple[t, 2]], solver.block[joints.kind.size + i],
                solver.block[joints.kind.size + j], solver.pivot[k],
                joints.rows[solver.row[i]], joints.rows[solver.row[j]], n,
            )  # fmt: skip


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
def factor_diagonal(S, pivot, diagonal, n, drop):
    """Factor S = L D L^T in place (unit L below the diagonal); pivot = 1/D, or 0 where dropped."""
    for k in range(n):
        d = S[k, k]
        for s in range(k):
            if pivot[s] != 0.0:
                d -= S[k, s] * S[k, s] / pivot[s]
        pivot[k] = 1.0 / d if d > drop * diagonal[k] else 0.0
        for i in range(k + 1, n):
            t = S[i, k]
            for s in range(k):
                if pivot[s] != 0.0:
                    t -= S[i, s] * S[k, s] / pivot[s]
            S[i, k] = t * pivot[k]


@kernel
def divide(X, L, pivot, m, n):
    """X <- X L^-T D^-1 for a block below the diagonal block L, so that it holds entries of unit L."""
    for i in range(m):
        for k in range(n):
            t = X[i, k]
            for s in range(k):
                if pivot[s] != 0.0:
                    t -= X[i, s] * L[k, s] / pivot[s]
            X[i, k] = t * pivot[k]


@kernel
def subtract_product(S, X, Y, pivot, m, n, q):
    """S <- S - X D Y^T."""
    for s in range(q):
        if pivot[s] == 0.0:
            continue
        d = 1.0 / pivot[s]
        for i in range(m):
            t = d * X[i, s]
            for j in range(n):
                S[i, j] -= t * Y[j, s]


@kernel
def substitute(system, rhs):
    """Solve with the factor: rhs (J, 6) becomes the multipliers."""
    solver, rows = system.solver, system.joints.rows
    first = rows.size
    for place in range(solver.order.size):
        k = solver.order[place]
        L, y = solver.block[k], rhs[k]
        for i in range(rows[k]):
            for s in range(i):
                y[i] -= L[i, s] * y[s]
        for t in range(solver.column[place], solver.column[place + 1]):
            i = solver.row[t]
            X, z = solver.block[first + t], rhs[i]
            for r in range(rows[i]):
                for s in range(rows[k]):
                    z[r] -= X[r, s] * y[s]
    for k in range(rows.size):
        for r in range(rows[k]):
            rhs[k, r] *= solver.pivot[k, r]
    for place in range(solver.order.size - 1, -1, -1):
        k = solver.order[place]
        L, y = solver.block[k], rhs[k]
        for t in range(solver.column[place], solver.column[place + 1]):
            i = solver.row[t]
            X, z = solver.block[first + t], rhs[i]
            for r in range(rows[i]):
                for s in range(rows[k]):
                    y[s] -= X[r, s] * z[r]
        for i in range(rows[k] - 1, -1, -1):
            for s in range(i + 1, rows[k]):
                y[i] -= L[s, i] * y[s]


@kernel
def free_motion(system, wrench, out):
    """Write out = M^-1 wrench."""
    inverse, mass = system.solver.inverse, system.bodies.mass
    for b in range(wrench.shape[0]):
        f = wrench[b]
        y = times_inverse_mass(mass, inverse, b, f[0], f[1], f[2], f[3], f[4], f[5])
        for k in range(6):
            out[b, k] = y[k]


@kernel
def subtract_rows(system, motion, rhs):
    """rhs <- rhs - A motion."""
    joints, A = system.joints, system.solver.rows
    for j in range(joints.kind.size):
        for side in range(2):
            b = joints.child[j] if side == 0 else joints.parent[j]
            if b < 0:
                continue
            for r in range(joints.rows[j]):
                s = 0.0
                for k in range(6):
                    s += A[j, side, r, k] * motion[b, k]
                rhs[j, r] -= s


@kernel
def add_reactions(system, multiplier, out):
    """out <- out + M^-1 A^T multiplier."""
    joints, Y = system.joints, system.solver.scaled
    for j in range(joints.kind.size):
        for side in range(2):
            b = joints.child[j] if side == 0 else joints.parent[j]
            if b < 0:
                continue
            for r in range(joints.rows[j]):
                for k in range(6):
                    out[b, k] += Y[j, side, r, k] * multiplier[j, r]


@kernel
def solve_factored(system, x, Q, wrench, bias, out):
    """Write the motion into `out`; the multipliers stay in the solver's rhs."""
    rhs = system.solver.rhs
    free_motion(system, wrench, out)
    row_targets(system, x, Q, bias, rhs)
    subtract_rows(system, out, rhs)
    substitute(system, rhs)
    add_reactions(system, rhs, out)
