"""Friction for given normal forces: min_T T.A T/2 + T.c with |T_i| <= rho_i (mathematics page, §2.3).

A = W_tt is positive semidefinite, and singular if contacts are redundant: then w = A T + c at the minimum is
unique, but T is not. The problem is convex and always has a solution, so there is no jam. It is solved by
Gauss-Seidel with exact discs, and a semi-smooth Newton iteration on T = project(T - s w), s_i = 2 / trace A_ii.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction.lu import factor, substitute
from carom.impact.multiple.layout import (
    DISC_C,
    DISC_F,
    DISC_STEP,
    DISC_T,
    DISC_TRY,
    DISC_W,
    PIVOTS,
    RADIUS,
)

_EMPTY = 1e-13  # relative to the square of the trace: a smaller determinant of a block is singular
_PROXIMAL = 1e-10  # regularises the Newton matrix where A is singular
_NEWTON = 12
_SWEEPS = 100


@kernel
def in_disc(a11, a12, a22, b1, b2, rho):
    """Return the T in the disc of radius `rho` that minimizes T.A T/2 + T.b, A 2x2."""
    trace = a11 + a22
    if not (rho > 0.0 and trace > 0.0):
        return 0.0, 0.0
    size = math.sqrt(b1 * b1 + b2 * b2)
    if not size > 0.0:
        return 0.0, 0.0
    det = a11 * a22 - a12 * a12
    if det > _EMPTY * trace * trace:
        x, y = (a12 * b2 - a22 * b1) / det, (a12 * b1 - a11 * b2) / det
        if x * x + y * y <= rho * rho:
            return x, y
    # T = -(A + alpha)^-1 b with |T| = rho; Newton on 1/|T| rises to the root and never passes it.
    half = 0.5 * (a11 - a22)
    largest = 0.5 * trace + math.sqrt(half * half + a12 * a12)
    alpha = max(size / rho - largest, 1e-15 * (size / rho + largest))
    x, y = -b1 / size * rho, -b2 / size * rho
    for _ in range(60):
        m11, m22 = a11 + alpha, a22 + alpha
        det = m11 * m22 - a12 * a12
        x, y = (a12 * b2 - m22 * b1) / det, (a12 * b1 - m11 * b2) / det
        norm2 = x * x + y * y
        slope = (m22 * x * x - 2.0 * a12 * x * y + m11 * y * y) / det
        norm = math.sqrt(norm2)
        change = (norm / rho - 1.0) * norm2 / slope
        alpha += change
        if not change > 1e-15 * alpha:
            break
    norm = math.sqrt(x * x + y * y)
    if norm > rho:
        x, y = x * rho / norm, y * rho / norm
    return x, y


@kernel
def sweep(m, A, radius, t, w):
    """Make one sweep of block Gauss-Seidel; update w too."""
    for i in range(m):
        a, b = 2 * i, 2 * i + 1
        a11, a12, a22 = A[a, a], A[a, b], A[b, b]
        b1 = w[a] - a11 * t[a] - a12 * t[b]
        b2 = w[b] - a12 * t[a] - a22 * t[b]
        x, y = in_disc(a11, a12, a22, b1, b2, radius[i])
        dx, dy = x - t[a], y - t[b]
        if dx != 0.0 or dy != 0.0:
            t[a], t[b] = x, y
            ra, rb = A[a], A[b]
            for j in range(2 * m):
                w[j] += dx * ra[j] + dy * rb[j]


@kernel
def velocity(m, A, c, t, w):
    """Write w = A t + c."""
    for i in range(2 * m):
        w[i] = c[i]
    for j in range(2 * m):
        q, row = t[j], A[j]
        if q != 0.0:
            for i in range(2 * m):
                w[i] += q * row[i]


@kernel
def mismatch(m, A, radius, t, w, f):
    """Write f = t - project(t - s w); return the greatest |f_i| / s_i, the error in w."""
    worst = 0.0
    for i in range(m):
        a, b = 2 * i, 2 * i + 1
        trace = A[a, a] + A[b, b]
        s = 2.0 / trace if trace > 0.0 else 0.0
        x, y = t[a] - s * w[a], t[b] - s * w[b]
        norm, rho = math.sqrt(x * x + y * y), radius[i]
        if norm > rho:
            x, y = x * rho / norm, y * rho / norm
        f[a], f[b] = t[a] - x, t[b] - y
        error = math.sqrt(f[a] * f[a] + f[b] * f[b]) * 0.5 * trace
        if not error <= worst and worst == worst:
            worst = error
    return worst


@kernel
def _newton_step(m, A, J, vector, index):
    """Write the solution of (I - M + s M (A + eps)) step = -f, M the derivative of the projection."""
    n, pivot, radius, step = 2 * m, index[PIVOTS], vector[RADIUS], vector[DISC_STEP]
    t, w, f = vector[DISC_T], vector[DISC_W], vector[DISC_F]
    for i in range(m):
        a, b = 2 * i, 2 * i + 1
        trace = A[a, a] + A[b, b]
        s = 2.0 / trace if trace > 0.0 else 0.0
        x, y = t[a] - s * w[a], t[b] - s * w[b]
        norm, rho = math.sqrt(x * x + y * y), radius[i]
        m11, m12, m22 = 1.0, 0.0, 1.0
        if norm > rho:
            r, cx, cy = rho / norm, x / norm, y / norm
            m11, m12, m22 = r * cy * cy, -r * cx * cy, r * cx * cx
        ja, jb, ra, rb = J[a], J[b], A[a], A[b]
        s1, s2, s3 = s * m11, s * m12, s * m22
        for j in range(n):
            ja[j] = s1 * ra[j] + s2 * rb[j]
            jb[j] = s2 * ra[j] + s3 * rb[j]
        keep = 1.0 - _PROXIMAL
        ja[a] += 1.0 - keep * m11
        ja[b] -= keep * m12
        jb[a] -= keep * m12
        jb[b] += 1.0 - keep * m22
        step[a], step[b] = -f[a], -f[b]
    factor(J, n, pivot, 1e-14)
    substitute(J, n, pivot, step)


@kernel
def solve_discs(m, A, J, vector, index, tolerance):
    """Solve for T of `m` discs, from the T given as first guess; return (error in w, iterations).

    `J` is space for Newton's matrix; rows of `vector` and `index` are as in `layout`.
    """
    n, radius, c = 2 * m, vector[RADIUS], vector[DISC_C]
    t, w, f = vector[DISC_T], vector[DISC_W], vector[DISC_F]
    step, trial = vector[DISC_STEP], vector[DISC_TRY]
    for i in range(m):
        a, b = 2 * i, 2 * i + 1
        size, rho = math.sqrt(t[a] * t[a] + t[b] * t[b]), radius[i]
        if size > rho:
            t[a], t[b] = t[a] * rho / size, t[b] * rho / size
        if not size < math.inf:
            t[a], t[b] = 0.0, 0.0
    velocity(m, A, c, t, w)
    error = mismatch(m, A, radius, t, w, f)
    count = 0
    while error > tolerance and count < _SWEEPS:
        if count > 0 or m == 1:
            for _ in range(1 if m == 1 else 2 if count < 40 else 20):
                sweep(m, A, radius, t, w)
                count += 1
            error = mismatch(m, A, radius, t, w, f)
            if error <= tolerance or m == 1:
                break
        for _ in range(_NEWTON):
            _newton_step(m, A, J, vector, index)
            count += 1
            length, better = 1.0, False
            while length > 0.1:
                for i in range(n):
                    trial[i] = t[i] + length * step[i]
                _project(m, radius, trial)
                velocity(m, A, c, trial, w)
                new = mismatch(m, A, radius, trial, w, f)
                if new < (1.0 - 0.1 * length) * error:
                    better = True
                    break
                length *= 0.5
            if not better:
                break
            for i in range(n):
                t[i] = trial[i]
            error = new
            if error <= tolerance:
                return error, count
        velocity(m, A, c, t, w)
        mismatch(m, A, radius, t, w, f)
    velocity(m, A, c, t, w)
    error = mismatch(m, A, radius, t, w, f)
    return error, count


@kernel
def _project(m, radius, t):
    for i in range(m):
        a, b = 2 * i, 2 * i + 1
        size, rho = math.sqrt(t[a] * t[a] + t[b] * t[b]), radius[i]
        if size > rho:
            r = rho / size
            t[a], t[b] = r * t[a], r * t[b]


@unit
def friction(m, A, J, vector, index, tolerance):
    """Solve for the friction of `m` discs as `solve_discs` does; this unit is compiled separately."""
    solve_discs(m, A, J, vector, index, tolerance)
