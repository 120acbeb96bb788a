"""Tangential restitution of several contacts: one further impulse returns slip to those that end in stick.

It has the rows n of all contacts with an impulse, and the rows t of those that opened without slip, and is

    dP_t = K^+ (-e_t u_t^-),   K = W_tt - W_tn W_nn^+ W_nt,   dP_n = -W_nn^+ W_nt dP_t,

so u_n stays as the laws made it. K is singular if contacts are redundant (four corners of a box): where
they cannot all have their slip, the result is the nearest, and shares are in proportion to P_n. As for one
contact (`carom.impact.tangential`), only the part s <= 1 is applied with which all impulses are in their cones,
no contact without an impulse is driven into the other body, and no more energy returns than friction has taken
and the impact has lost.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.friction.dense import add_product
from carom.impact.multiple import layout as o
from carom.impact.multiple.friction import decompose, invert
from carom.impact.multiple.layer import set_velocity
from carom.impact.tangential import greatest_part
from carom.impact.thresholds import GROUP_ERROR, VELOCITY_LEFT


@unit
def return_slips(k, work, passage):
    """Add to the impulses of a group of `k` contacts that of tangential restitution."""
    n, m = _gather(k, work, passage.laws)
    if m == 0:
        return
    W, Y, hold = work.W, work.stick.coupling, work.stick.H
    pressed, stuck, wish = work.closed, work.stuck, work.stick.T
    more, change = work.more_impulse, work.more_velocity
    _weigh(n, pressed, work)
    _invert_normal(n, work)
    for a in range(n):
        for b in range(2 * m):
            row, total = 3 * stuck[b // 2] + 1 + b % 2, 0.0
            for c in range(n):
                total += hold[a, c] * W[3 * pressed[c], row]
            Y[a, b] = total
    _weigh(m, stuck, work)
    _invert_tangential(n, m, work)
    for a in range(3 * k):
        more[a], change[a] = 0.0, 0.0
    for b in range(2 * m):
        impulse = 0.0
        for c in range(2 * m):
            impulse += hold[b, c] * wish[c]
        more[3 * stuck[b // 2] + 1 + b % 2] = impulse
        for a in range(n):
            more[3 * pressed[a]] -= Y[a, b] * impulse
    add_product(3 * k, W, more, change)
    s = _part_allowed(k, work)
    for a in range(3 * k):
        work.now.impulse[a] += s * more[a]
    set_velocity(k, work)


@kernel
def _gather(k, work, laws):
    """List the contacts with an impulse, and those that stick with the change of slip; return their numbers."""
    P, u, wish = work.now.impulse, work.before, work.stick.T
    n, m, most, size = 0, 0, 0.0, 0.0
    for i in range(k):
        most = max(most, P[3 * i])
        if work.contact[i].wedged != 0:
            return 0, 0
    for i in range(k):
        c = work.contact[i]
        if P[3 * i] > GROUP_ERROR * most:
            work.closed[n] = i
            n += 1
            if c.sticks & o.HAS_STUCK != 0 and c.mu > 0.0:
                work.stuck[m] = i
                e_t = laws.table[c.law].tangential_restitution
                for r in range(2):
                    wish[2 * m + r] = -e_t * u[3 * i + 1 + r]
                    size = max(size, abs(wish[2 * m + r]))
                m += 1
    return n, m if size > 0.0 else 0


@kernel
def _weigh(n, slot, work):
    """Write the weights of contacts, the roots of their normal impulses."""
    P, weight, most = work.now.impulse, work.stick.weight, 0.0
    for a in range(n):
        most = max(most, P[3 * slot[a]])
    for a in range(n):
        weight[a] = math.sqrt(P[3 * slot[a]] / most)


@kernel
def _invert_normal(n, work):
    """Write W_nn^+ of `n` contacts."""
    L, W, slot, weight = work.stick.L, work.W, work.closed, work.stick.weight
    largest = 0.0
    for a in range(n):
        for b in range(a + 1):
            L[a, b] = weight[a] * weight[b] * W[3 * slot[a], 3 * slot[b]]
        largest = max(largest, L[a, a])
    invert(n, decompose(n, largest, work.stick.order, L), 1, work)


@kernel
def _invert_tangential(n, m, work):
    """Write K^+ of `m` contacts that stick, from Y = W_nn^+ W_nt with `n` contacts."""
    L, W, Y, weight = work.stick.L, work.W, work.stick.coupling, work.stick.weight
    pressed, stuck, largest = work.closed, work.stuck, 0.0
    for a in range(2 * m):
        row, scale = W[3 * stuck[a // 2] + 1 + a % 2], weight[a // 2]
        for b in range(a + 1):
            at = 3 * stuck[b // 2] + 1 + b % 2
            total = row[at]
            if a == b:
                largest = max(largest, scale * scale * total)
            for c in range(n):
                total -= row[3 * pressed[c]] * Y[c, b]
            L[a, b] = scale * weight[b // 2] * total
    invert(2 * m, decompose(2 * m, largest, work.stick.order, L), 2, work)


@kernel
def _part_allowed(k, work):
    """Return the part s of the impulse that cones, open contacts and the energy that friction took allow."""
    P, u, before = work.now.impulse, work.now.velocity, work.before
    more, change = work.more_impulse, work.more_velocity
    s, drawn, back, lost, pressure = 1.0, 0.0, 0.0, 0.0, 0.0
    for i in range(k):
        c, a = work.contact[i], 3 * i
        pressure += c.returned - c.absorbed
        for b in range(a, a + 3):
            drawn += more[b] * u[b]
            back += 0.5 * more[b] * change[b]
            lost -= 0.5 * P[b] * (before[b] + u[b])
        slip = math.hypot(P[a + 1], P[a + 2])
        if more[a + 1] != 0.0 or more[a + 2] != 0.0:  # |P_t + s dP_t|^2 = mu^2 (P_n + s dP_n)^2
            square = c.mu * c.mu
            s = min(s, greatest_part(
                more[a + 1] ** 2 + more[a + 2] ** 2 - square * more[a] ** 2,
                P[a + 1] * more[a + 1] + P[a + 2] * more[a + 2] - square * P[a] * more[a],
                square * P[a] ** 2 - slip * slip,
            ))  # fmt: skip
        elif more[a] < -GROUP_ERROR * abs(P[a]):
            room = P[a] - slip / c.mu if c.mu > 0.0 else P[a]
            s = min(s, max(0.0, room) / -more[a])
        if change[a] < -VELOCITY_LEFT:
            s = min(s, max(0.0, u[a]) / -change[a])
    # Newton's law may have added the energy that friction took
    return min(s, greatest_part(back, 0.5 * drawn, max(0.0, lost + min(0.0, pressure))))
