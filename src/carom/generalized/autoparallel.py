"""Autoparallels of the metric's affinities, and the return map along them.

    q'' + Gamma(q', q') = 0,   Exp_q(xi) = q(1) for q(0) = q, q'(0) = xi

(Mathematics page, §4.2; paper, Eqs. (1), (6), (10).)
"""

from __future__ import annotations

from carom._compiled.decorators import entry, kernel
from carom.generalized.layout import ALL_ROWS, N
from carom.generalized.linear import solve_metric
from carom.generalized.motion import (
    copy_row,
    factor_rows,
    find_contacts,
    find_metric,
    find_rows,
    react,
)

_STRAIGHT = 1e-4  # if Gamma(xi, xi)/2 is below this part of xi, two terms of the series suffice
_PARTS = 8  # steps of order 4 for longer arcs
_LONG_PARTS = 64  # the same for arcs of the return map that are longer than round-off


@kernel
def bend(system, t, x, work, out):
    """Write (v, -Gamma(v, v)) for x = (q, v) into `out`; return a status."""
    n = system.size[N]
    code = find_metric(system, t, x, work)
    if code == 0:
        for j in range(n):
            out[j], out[n + j] = x[n + j], -work.c[j]
        solve_metric(work.L, out[n:], n)
    return code


@kernel
def bend_carried(system, t, x, w, work, out, carried):
    """Do as `bend`, and write -Gamma(v, w) into `carried` (n,), by Gamma(v+w, v+w) - Gamma(v-w, v-w)."""
    n = system.size[N]
    y = work.arc[7]
    for j in range(n):
        y[j], y[n + j], carried[j] = x[j], x[n + j] + w[j], 0.0
    for sign in range(2):
        code = find_metric(system, t, y, work)
        if code != 0:
            return code
        for j in range(n):
            carried[j] += (0.25 if sign == 1 else -0.25) * work.c[j]
            y[n + j] = x[n + j] - w[j]
    solve_metric(work.L, carried, n)
    return bend(system, t, x, work, out)


@kernel
def follow(system, t, x, w, transport, parts, work):
    """Move x = (q, v) to the end of the autoparallel of v, in `parts` RK4 steps; return a status.

    If `transport` is set, w (n,) is transported with it.
    """
    n, h = system.size[N], 1.0 / parts
    y, k, total = work.arc[0], work.arc[1], work.arc[2]
    wy, wk, wt = work.arc[3], work.arc[4], work.arc[5]
    for _ in range(parts):
        for j in range(2 * n):
            y[j], total[j] = x[j], 0.0
        for j in range(n):
            wy[j], wt[j], wk[j] = w[j], 0.0, 0.0
        for s in range(4):
            if transport:
                code = bend_carried(system, t, y, wy[:n], work, k, wk[:n])
            else:
                code = bend(system, t, y, work, k)
            if code != 0:
                return code
            ahead = 0.5 * h if s < 2 else h
            share = h / 6.0 if s == 0 or s == 3 else h / 3.0
            for j in range(2 * n):
                total[j] += share * k[j]
                y[j] = x[j] + ahead * k[j]
            for j in range(n):
                wt[j] += share * wk[j]
                wy[j] = w[j] + ahead * wk[j]
        for j in range(2 * n):
            x[j] += total[j]
        for j in range(n):
            w[j] += wt[j]
    return 0


@entry
def run_along(system, t, x, parts, work):
    """Do the same as `follow`, for Python."""
    return follow(system, t, x, work.a, False, parts, work)


@kernel
def correct(system, t, x, xi, work):
    """Replace the coordinates in `x` by Exp_q(xi), xi (n,), not the velocities; return a status."""
    n, y, k = system.size[N], work.arc[6], work.arc[1]
    largest, curved = 0.0, 0.0
    for j in range(n):
        y[j], y[n + j] = x[j], xi[j]
    code = bend(system, t, y, work, k)
    if code != 0:
        return code
    for j in range(n):
        largest, curved = max(largest, abs(xi[j])), max(curved, 0.5 * abs(k[n + j]))
    if curved <= _STRAIGHT * largest:
        for j in range(n):
            x[j] += xi[j] + 0.5 * k[n + j]
        return 0
    code = follow(system, t, y, xi, False, _PARTS, work)
    for j in range(n):
        x[j] = y[j]
    return code


@kernel
def normal(system, active, t, x, c, work, out):
    """Write P G_n^T at `x` into `out` (n,), P within the constraints; return (W_nn, status)."""
    n, m = system.size[N], system.size[ALL_ROWS]
    find_contacts(system, t, x, work)
    code = find_metric(system, t, x, work)
    if code != 0:
        return 0.0, code
    copy_row(work.G[c, 0], out, n)
    solve_metric(work.L, out, n)
    if m > 0:
        find_rows(system, active, t, x, work)
        for r in range(m):
            copy_row(work.A[r], work.R[r], n)
            copy_row(work.A[r], work.D[r], n)
            work.rhs[r] = 0.0
        factor_rows(system, m, work)
        react(system, m, out, work)
    w = 0.0
    for j in range(n):
        w += work.G[c, 0, j] * out[j]
    return w, 0


@entry
def return_map(system, active, t, x, c, tolerance, work):
    """Bring the coordinates in `x` to gap c = 0 along an autoparallel normal to it; (iterations or -1, status).

    xi is kappa P G_n^T(q_e), transported back along the arc to q, where q_e = Exp_q(xi) and gap(q_e) = 0. On a
    curved manifold the normal at the end is not that at the start, so it needs parallel transport. The arc may
    leave the constraints; the caller returns to them.
    """
    n, kappa = system.size[N], 0.0
    q, e, nu, xi = work.trial, work.best, work.end, work.stages[0]
    copy_row(x, q, n)
    copy_row(x, e, n)
    parts = 1
    for j in range(n):
        xi[j] = 0.0
    for iteration in range(100):
        w, code = normal(system, active, t, e, c, work, nu)
        rho = work.gap[c]
        if code != 0:
            return -1, code
        if iteration == 0:
            if abs(rho) <= tolerance:
                return 0, 0
            parts = 1 if abs(rho) <= 1e-9 * work.gap_scale[c] else _LONG_PARTS
        if not w > 0.0:
            return -1, 0
        kappa -= rho / w
        for j in range(n):
            nu[j] *= kappa
            e[n + j] = -e[n + j]  # back along the same arc
        if iteration > 0:
            code = follow(system, t, e, nu, True, parts, work)
        change, size = 0.0, 0.0
        for j in range(n):
            change, size = max(change, abs(nu[j] - xi[j])), max(size, abs(nu[j]))
        if abs(rho) <= tolerance and change <= 1e-12 * size:
            for j in range(n):
                x[j] = work.arc[6, j]
            return iteration, code
        for j in range(n):
            xi[j] = nu[j]
            e[j], e[n + j] = q[j], xi[j]
        code = max(code, follow(system, t, e, nu, False, parts, work))
        if code != 0:
            return -1, code
        copy_row(e, work.arc[6], n)
    return -1, 0
