"""Contacts that stick: the friction that keeps them at rest, linear in all other forces.

W_ZZ T = -a has many solutions where contacts are redundant (four corners of a box: rank 3 of 8); all act alike.
Taken is the one that loads each contact in the measure of mu N: the least |D^-1 T|, D = diag(mu N), so that
discs are left only about when no solution fits in them.
"""

from __future__ import annotations

import math

from carom.impact.corner.law import OPEN
from carom.impact.corner.layout import (
    FACTOR,
    HOLDING,
    LEFT,
    MASS,
    MIDDLE,
    S_P,
    SCALE,
    STICK_T,
    STUCK,
    D,
    P,
    U,
)
from carom.impact.corner.motion import set_velocity
from carom.impact.corner.series import likely_force, stick
from carom.jit import kernel

_EMPTY = 1e-11  # pivots below this part of the largest: directions that are redundant
_SAMPLES = 5


@kernel
def gather_stuck(k, work):
    """List the closed contacts that stick; return how many. Write what holds them to ``work.matrix[HOLDING]``."""
    z = 0
    for i in range(k):
        c = work.contact[i]
        if c.mode == OPEN:
            c.sticks = 0
        elif c.sticks == 1 and c.mu > 0.0:
            work.index[STUCK, z] = i
            z += 1
    if z > 0:
        _holding(z, work)
    return z


@kernel
def _holding(z, work):
    """Write D (D W_ZZ D)^+ D, by Cholesky's factors with pivots: B = L L^T, B^+ = L (L^T L)^-2 L^T."""
    n, slot, vector, W = 2 * z, work.index[STUCK], work.vector, work.matrix[MASS]
    L, M, hold = work.matrix[FACTOR], work.matrix[MIDDLE], work.matrix[HOLDING]
    scale, left, column = vector[SCALE], vector[LEFT], vector[STICK_T]
    most = 0.0
    for a in range(z):
        c = work.contact[slot[a]]
        weight = c.mu * likely_force(c, vector[D, slot[a]], vector[U, 3 * slot[a]])
        scale[a] = max(0.0, weight)
        most = max(most, scale[a])
    for a in range(z):
        scale[a] = max(scale[a] / most, 1e-6) if most > 0.0 else 1.0
    largest = 0.0
    for a in range(n):
        i = 3 * slot[a // 2] + 1 + a % 2
        left[a] = W[i, i] * scale[a // 2] * scale[a // 2]
        largest = max(largest, left[a])
    rank = 0
    while rank < n:
        top = 0
        for a in range(n):
            if left[a] > left[top]:
                top = a
        if not left[top] > _EMPTY * largest:
            break
        pivot = math.sqrt(left[top])
        row = W[3 * slot[top // 2] + 1 + top % 2]
        f = scale[top // 2]
        for a in range(n):
            s = row[3 * slot[a // 2] + 1 + a % 2] * f * scale[a // 2]
            for b in range(rank):
                s -= L[top, b] * L[a, b]
            column[a] = s / pivot
        for a in range(n):
            L[a, rank] = column[a]
            left[a] -= column[a] * column[a]
        left[top] = 0.0
        rank += 1
    for a in range(rank):
        for b in range(rank):
            s = 0.0
            for c_ in range(n):
                s += L[c_, a] * L[c_, b]
            M[a, b] = s
    _cholesky(rank, M)
    # rows of L -> rows of L M^-1, M = L^T L; then B^+ = (L M^-1) (L M^-1)^T
    for a in range(n):
        _solve(rank, M, L[a])
    for a in range(n):
        for b in range(n):
            s = 0.0
            for c_ in range(rank):
                s += L[a, c_] * L[b, c_]
            hold[a, b] = s * scale[a // 2] * scale[b // 2]


@kernel
def _cholesky(n, M):
    """Factor M in place, the lower triangle."""
    for i in range(n):
        for j in range(i + 1):
            s = M[i, j]
            for c in range(j):
                s -= M[i, c] * M[j, c]
            M[i, j] = math.sqrt(s) if i == j else s / M[j, j]


@kernel
def _solve(n, M, x):
    """Solve with the factors, in place."""
    for i in range(n):
        s = x[i]
        for j in range(i):
            s -= M[i, j] * x[j]
        x[i] = s / M[i, i]
    for i in range(n - 1, -1, -1):
        s = x[i]
        for j in range(i + 1, n):
            s -= M[j, i] * x[j]
        x[i] = s / M[i, i]


@kernel
def halt(k, z, work):
    """Bring the sticking contacts to rest: what is left of their velocity is taken by an impulse."""
    stick(k, z, work, work.vector[P], work.vector[U])
    set_velocity(k, work)
    for b in range(z):
        n = 3 * work.index[STUCK, b]
        work.vector[U, n + 1], work.vector[U, n + 2] = 0.0, 0.0


@kernel
def excess(c, i, impulse, degree, x):
    """Return |T|^2 - (mu N)^2 of a sticking contact, from the derivative of its impulse at `x`."""
    n, t1, t2 = 0.0, 0.0, 0.0
    for j in range(degree, 0, -1):
        n = n * x + j * impulse[j, 3 * i]
        t1 = t1 * x + j * impulse[j, 3 * i + 1]
        t2 = t2 * x + j * impulse[j, 3 * i + 2]
    room = c.mu * max(0.0, n)
    return t1 * t1 + t2 * t2 - room * room * (1.0 + 1e-9) - 1e-20


@kernel
def first_slip(z, work, degree, end):
    """Return the first x in [0, end] where a contact can no longer stick, or 2 end."""
    first, impulse = 2.0 * end, work.series[S_P]
    for b in range(z):
        i = work.index[STUCK, b]
        c = work.contact[i]
        low = 0.0
        for s in range(_SAMPLES):
            high = end * ((s + 1) / _SAMPLES)
            if excess(c, i, impulse, degree, high) > 0.0:
                for _ in range(50):
                    x = 0.5 * (low + high)
                    if excess(c, i, impulse, degree, x) > 0.0:
                        high = x
                    else:
                        low = x
                    if high - low <= 1e-12 * end:
                        break
                first = min(first, low)
                end = min(end, max(low, 1e-300))
                break
            low = high
    return first
