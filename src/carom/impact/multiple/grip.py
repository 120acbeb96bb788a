"""Contacts that stick: the friction that keeps them at rest is linear in all other forces.

W_ZZ T = -a has many solutions if contacts are redundant (four corners of a box: rank 3 of 8); all have the same
effect. The solution of least |D^-1 T| is used, D = diag(mu N) a moment ahead. It loads contacts according to
mu N, so that a contact leaves its disc only about when no solution fits in the discs.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction.lu import factor, substitute
from carom.impact.multiple.law import OPEN
from carom.impact.multiple.layout import (
    FACTOR,
    HOLDING,
    LANES,
    LEFT,
    MASS,
    MIDDLE,
    NOW_P,
    NOW_U,
    PIVOTS,
    S_P,
    S_P1,
    S_P2,
    SCALE,
    STICK_T,
    STUCK,
    D,
)
from carom.impact.multiple.motion import set_velocity
from carom.impact.multiple.series import stick

_EMPTY = 1e-11  # directions with pivots below this part of the largest are redundant
_LOADED = (
    1e-3  # part of the greatest mu N from which a contact takes part in any motion that it can stop
)
_UNLOADED = (
    0.1  # of the greatest mu N, added to all where the loaded contacts alone cannot stop all motion
)
_GRIP_SAMPLES = 5
_MOMENT = 0.3  # the moment ahead, in units of the time of the fastest contact


@kernel
def gather_stuck(k, work):
    """List the closed contacts that stick and write the matrix of their friction; return their number."""
    z = 0
    for i in range(k):
        c = work.contact[i]
        if c.mode == OPEN:
            c.sticks = 0
        elif c.sticks == 1 and c.mu > 0.0:
            work.index[STUCK, z] = i
            z += 1
    if z > 0:
        find_holding(z, work)
    return z


@kernel
def _bearing(z, work, weight):
    """Write D = mu N of the sticking contacts a moment ahead, relative to the greatest; return the least."""
    d, u, slot = work.vector[D], work.vector[NOW_U], work.index[STUCK]
    moment = _MOMENT
    for a in range(z):
        i = slot[a]
        c = work.contact[i]
        if u[3 * i] > 0.0:
            moment = min(moment, max(0.0, (d[i] - c.rest) / u[3 * i]))
    for turn in range(2):
        most, now = 0.0, 0.0
        for a in range(z):
            i = slot[a]
            c = work.contact[i]
            force = c.mu * max(0.0, c.slope * (d[i] - c.rest - moment * u[3 * i]))
            weight[a] = force * force
            most = max(most, weight[a])
            now = max(now, c.mu * c.slope * (d[i] - c.rest))
        if most > 1e-8 * now * now or turn == 1:
            break
        moment = 0.0  # all open at the same time: use the present forces
    least = 1.0
    for a in range(z):
        weight[a] = math.sqrt(weight[a] / most) if most > 0.0 else 1.0
        least = min(least, weight[a])
    return least


@unit
def find_holding(z, work):
    """Write H in T = -H a: H = D (D W_ZZ D)^+ D = R R^T, R = D L (L^T L)^-1, by L L^T = D W_ZZ D."""
    n, vector = 2 * z, work.vector
    L, M, hold = work.matrix[FACTOR], work.matrix[MIDDLE], work.matrix[HOLDING]
    weight, pivot = vector[SCALE], work.index[PIVOTS]
    full = 0
    if not _bearing(z, work, weight) > _LOADED:
        for a in range(z):
            weight[a] = 1.0
        full = _factor(z, work, L)
        _bearing(z, work, weight)
    rank = _factor(z, work, L)
    if rank < full:  # the loaded contacts alone cannot stop all motion
        for a in range(z):
            weight[a] += _UNLOADED
        rank = _factor(z, work, L)
    for p in range(rank):
        for q in range(rank):
            s = 0.0
            for a in range(n):
                s += L[a, p] * L[a, q]
            M[p, q] = s
    factor(M, rank, pivot, 0.0)
    for a in range(n):
        for q in range(rank):
            L[a, q] *= weight[a // 2]
        substitute(M, rank, pivot, L[a])
    for a in range(n):
        for b in range(a + 1):
            s = 0.0
            for q in range(rank):
                s += L[a, q] * L[b, q]
            hold[a, b] = hold[b, a] = s


@kernel
def _factor(z, work, L):
    """Write L in D W_ZZ D = L L^T, by Cholesky with pivots; return its rank."""
    slot, W, weight = work.index[STUCK], work.matrix[MASS], work.vector[SCALE]
    left, column = work.vector[LEFT], work.vector[STICK_T]
    n, largest, rank = 2 * z, 0.0, 0
    for a in range(n):
        i = 3 * slot[a // 2] + 1 + a % 2
        left[a] = weight[a // 2] * weight[a // 2] * W[i, i]
        largest = max(largest, left[a])
    while rank < n:
        top = 0
        for a in range(n):
            if left[a] > left[top]:
                top = a
        if not left[top] > _EMPTY * largest:
            break
        pivot = math.sqrt(left[top])
        row, d = W[3 * slot[top // 2] + 1 + top % 2], weight[top // 2]
        for a in range(n):
            s = d * weight[a // 2] * row[3 * slot[a // 2] + 1 + a % 2]
            for b in range(rank):
                s -= L[top, b] * L[a, b]
            column[a] = s / pivot
        for a in range(n):
            L[a, rank] = column[a]
            left[a] -= column[a] * column[a]
        left[top] = 0.0
        rank += 1
    return rank


@kernel
def halt(k, z, work):
    """Bring the sticking contacts to rest: an impulse removes the rest of their velocity."""
    stick(k, z, work, work.vector[NOW_P], work.vector[NOW_U])
    set_velocity(k, work)
    for b in range(z):
        n = 3 * work.index[STUCK, b]
        work.vector[NOW_U, n + 1], work.vector[NOW_U, n + 2] = 0.0, 0.0


@kernel
def excess(c, i, S, degree, x):
    """Return |T|^2 - (mu N)^2 of a sticking contact, from the derivative of its impulse at `x`."""
    n, t1, t2 = 0.0, 0.0, 0.0
    b, l = i // LANES, i % LANES
    for j in range(degree, 0, -1):
        n = n * x + j * S[S_P, j, b, l]
        t1 = t1 * x + j * S[S_P1, j, b, l]
        t2 = t2 * x + j * S[S_P2, j, b, l]
    room = c.mu * max(0.0, n)
    return t1 * t1 + t2 * t2 - room * room * (1.0 + 1e-9) - 1e-20


@kernel
def _last_hold(c, i, S, degree, low, high, tolerance):
    """Return the last x between `low` and `high` where a contact still sticks, by bisection."""
    for _ in range(50):
        x = 0.5 * (low + high)
        if excess(c, i, S, degree, x) > 0.0:
            high = x
        else:
            low = x
        if high - low <= tolerance:
            break
    return low


@kernel
def first_slip(z, work, degree, end):
    """Return the first x in [0, end] where a contact can no longer stick, or 2 end."""
    first, S = 2.0 * end, work.series
    for b in range(z):
        i = work.index[STUCK, b]
        c = work.contact[i]
        low = 0.0
        for s in range(_GRIP_SAMPLES):
            high = end * ((s + 1) / _GRIP_SAMPLES)
            if excess(c, i, S, degree, high) > 0.0:
                low = _last_hold(c, i, S, degree, low, high, 1e-12 * end)
                first = min(first, low)
                end = min(end, max(low, 1e-300))
                break
            low = high
    return first
