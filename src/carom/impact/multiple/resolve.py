"""An impact at a corner: several contacts closed while one or more of them strike (mathematics page, V)."""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.impact import laws
from carom.impact import layout as one
from carom.impact.multiple import equal_contacts
from carom.impact.multiple.at_once import solve_at_once, unsound
from carom.impact.multiple.layout import (
    AT_ONCE,
    BAD_INPUT,
    BY_NEWTON,
    CAPPED,
    CLASS,
    CLEAN,
    EXACT,
    FIRST,
    FRICTION,
    GROUP,
    MASS,
    MEMBER,
    NOT_RESOLVED,
    OK,
    REPELLED,
    SEQUENTIAL,
    SINGLE,
    SIZE,
    TRY,
    U0,
    P,
)
from carom.impact.multiple.one import resolve_single
from carom.impact.multiple.passage import pass_group
from carom.impact.multiple.sequential import blow_by_blow

_NOTHING = 1e-15  # impulses below this part of the greatest are none
_TOUCHES = 1e-13  # approach below this part of the greatest velocity is none


@entry
def resolve_corner(k, W, u, mu, e, law, kappa, settings, scratch, out):
    """Resolve an impact of `k` contacts as `resolve_contacts`, for calls from Python."""
    return resolve_contacts(k, W, u, mu, e, law, kappa, settings, scratch, out)


@kernel
def resolve_contacts(k, W, u, mu, e, law, kappa, settings, scratch, out):
    """Resolve an impact of `k` contacts; return OK or BAD_INPUT (nothing is written then).

    `W` (3K, 3K) symmetric inverse mass, often singular, and `u` (3K,) velocities before, rows (n, t1, t2) of
    each contact, approach negative; of contacts that touch or are held u_n = 0. `mu`, `e`, `law` and
    `kappa` (K,): friction, restitution, its law as in `carom.impact.laws`, stiffness (only ratios matter).
    `settings`: `CornerSettings`; `scratch` from `corner_arrays`, `out` from `new_corner_result`, for K >= k.
    """
    scale = _check(k, W, u, mu, e, law, kappa)
    if not scale >= 0.0:
        return BAD_INPUT
    result, index, clean = out.summary[0], scratch.work.index, scratch.work.matrix[CLEAN]
    result.energy_change, result.plastic_change = 0.0, 0.0
    result.error, result.miss = 0.0, 0.0
    result.steps, result.events, result.rounds, result.classes, result.marks = 0, 0, 0, 0, 0
    for i in range(k):
        out.compression[i], out.restitution[i], out.friction[i] = 0.0, 0.0, 0.0
        out.wedged[i] = 0
    for i in range(3 * k):
        out.impulse[i] = 0.0
        out.velocity[i] = u[i]
    approaches = False
    for i in range(k):
        approaches = approaches or u[3 * i] < -_TOUCHES * scale
    if not approaches:
        return OK
    friction, count = scratch.work.vector[FRICTION], 0
    if equal_contacts.nothing_slips(k, u, mu, scale):
        for i in range(k):
            friction[i] = 0.0
        largest = equal_contacts.clean(k, W, friction, clean)
        count = equal_contacts.find_classes(
            k, clean, u, friction, e, law, kappa, largest, scale, index
        )
        if not equal_contacts.friction_sleeps(k, W, mu, count, largest, index):
            count = 0
    if count == 0:
        for i in range(k):
            friction[i] = mu[i]
        largest = equal_contacts.clean(k, W, friction, clean)
        count = equal_contacts.find_classes(
            k, clean, u, friction, e, law, kappa, largest, scale, index
        )
    result.classes = count
    equal_contacts.find_pressed(k, clean, u, friction, _TOUCHES * scale, index)
    groups = equal_contacts.find_groups(k, count, clean, index)
    code = NOT_RESOLVED if settings.multiple == BY_NEWTON else OK
    for g in range(groups if code == OK else 0):
        one_code = _group(k, g, count, u, friction, e, law, kappa, scale, settings, scratch, out)
        code = max(code, one_code)
    if code == OK:
        _finish(k, W, u, scale, out)
    exact = (result.marks & EXACT) != 0  # that of one contact may gain energy, by Newton's law
    if code != OK or (not exact and unsound(k, u, scale, out)):
        result.marks, result.miss, result.plastic_change = AT_ONCE, 0.0, 0.0
        solve_at_once(k, u, mu, e, scratch, out)
        _finish(k, W, u, scale, out)
    return OK


@kernel
def _check(k, W, u, mu, e, law, kappa):
    """Return the greatest velocity, or NaN where the input is unsound."""
    total, scale = 0.0, 0.0
    for a in range(3 * k):
        row = W[a]
        scale = max(scale, abs(u[a]))
        total += u[a]
        for b in range(3 * k):
            total += row[b]
    for i in range(k):
        total += mu[i] + e[i] + kappa[i]
        sound = mu[i] >= 0.0 and 0.0 <= e[i] <= 1.0 and kappa[i] > 0.0 and 0 <= law[i] < laws.COUNT
        if not (sound and W[3 * i, 3 * i] >= 0.0):
            return math.nan
    return scale if math.isfinite(total) else math.nan


@kernel
def _group(k, g, count, u, mu, e, law, kappa, scale, settings, scratch, out):
    """Resolve the classes of group `g`; write impulses and works of their contacts."""
    work = scratch.work
    index, mass_matrix = work.index, work.matrix[MASS]
    n, strikes = 0, False
    for q in range(count):
        if index[GROUP, q] == g:
            index[MEMBER, n] = q
            n += 1
            strikes = strikes or u[3 * index[FIRST, q]] < -_TOUCHES * scale
    if not strikes:
        return OK
    for a in range(n):
        p = index[MEMBER, a]
        for b in range(n):
            q = index[MEMBER, b]
            for r in range(3):
                for s in range(3):
                    mass_matrix[3 * a + r, 3 * b + s] = equal_contacts.class_coupling(
                        k, work.matrix[CLEAN], index, p, q, r, s
                    )
    if n == 1:
        i = index[FIRST, index[MEMBER, 0]]
        parts = equal_contacts.parts_others(k, work.matrix[CLEAN], i, index)
        gives = e[i] > 0.0 or not parts  # several that give nothing back are one plastic event
        if gives and _exactly(k, i, parts, u, mu, e, law, scale, work, out) == OK:
            return OK
    mass, speed, rate = _fill(n, u, mu, e, law, kappa, scale, settings.exponent, work)
    if not (mass > 0.0 and rate > 0.0):
        return NOT_RESOLVED
    summary = out.summary[0]
    plastic, error = summary.plastic_change, summary.error
    summary.plastic_change, summary.error = 0.0, 0.0
    if settings.multiple == SEQUENTIAL:
        blow_by_blow(n, work, scratch.cones, settings, summary)
    else:
        pass_group(n, work, scratch.cones, settings, summary)
    energy = speed * speed / mass
    for a in range(n):
        q = index[MEMBER, a]
        share = 1.0 / index[SIZE, q]
        c = work.contact[a]
        for i in range(k):
            if index[CLASS, i] == q:
                for r in range(3):
                    out.impulse[3 * i + r] = work.vector[P, 3 * a + r] * share * speed / mass
                out.compression[i] = -max(0.0, c.absorbed) * share * energy
                out.restitution[i] = max(0.0, c.returned) * share * energy
                out.friction[i] = max(0.0, c.loss) * share * energy
                out.wedged[i] = c.wedged
    summary.plastic_change = plastic + energy * summary.plastic_change
    summary.error = max(error, speed * summary.error)
    return OK


@kernel
def _fill(n, u, mu, e, law, kappa, scale, exponent, work):
    """Scale the group and fill in its contacts; return the scales of W and u, and a positive rate."""
    index, W = work.index, work.matrix[MASS]
    mass, speed, most, stiff = 0.0, 0.0, 0.0, 0.0
    for a in range(n):
        i = index[FIRST, index[MEMBER, a]]
        mass = max(mass, W[3 * a, 3 * a])
        speed = max(speed, -u[3 * i])
        for r in range(3 if mu[i] > 0.0 else 1):
            most = max(most, abs(u[3 * i + r]))
        stiff = max(stiff, kappa[i] * index[SIZE, index[MEMBER, a]] * W[3 * a, 3 * a])
    if not (mass > 0.0 and stiff > 0.0):
        return 0.0, 0.0, 0.0
    speed = max(speed, 1e-3 * most)
    for a in range(3 * n):
        row = W[a]
        for b in range(3 * n):
            row[b] /= mass
    for a in range(n):
        q = index[MEMBER, a]
        i = index[FIRST, q]
        c = work.contact[a]
        c.mu, c.restitution, c.law, c.members = mu[i], e[i], law[i], index[SIZE, q]
        c.root = (kappa[i] * index[SIZE, q] * mass / stiff) ** (1.0 / exponent)
        c.e = e[i]
        c.grip = mu[i] * (W[3 * a + 1, 3 * a + 1] + W[3 * a + 2, 3 * a + 2])
        for r in range(3):
            work.vector[U0, 3 * a + r] = u[3 * i + r] / speed if r == 0 or mu[i] > 0.0 else 0.0
        u_n = u[3 * i]
        if abs(u_n) <= _TOUCHES * scale:
            work.vector[U0, 3 * a] = 0.0
        c.approach = max(0.0, -work.vector[U0, 3 * a])
    return mass, speed, stiff


@kernel
def _exactly(k, i, parts, u, mu, e, law, scale, work, out):
    """Resolve a group that is one contact, number `i` and those like it; NOT_RESOLVED if nothing stops it.

    If it `parts` others, it gives back no more than it took, as each of several contacts.
    """
    index, W, before = work.index, work.matrix[SINGLE], work.vector[TRY]
    q = index[CLASS, i]
    for r in range(3):
        before[r] = u[3 * i + r] if r == 0 or mu[i] > 0.0 else 0.0
        for s in range(3):
            W[r, s] = work.matrix[MASS, r, s]
    single = work.single
    clock = work.clock
    single[one.STILL] = _TOUCHES * scale
    resolve_single(clock, W, before, mu[i], e[i], law[i], single)
    if parts and clock[0].code == one.OK and single[one.WORK_R] > -single[one.WORK_C]:
        resolve_single(clock, W, before, mu[i], 1.0, laws.STRONGE, single)
        out.summary[0].marks |= CAPPED
    if clock[0].code != one.OK:
        return NOT_RESOLVED
    share = 1.0 / index[SIZE, q]
    for j in range(k):
        if index[CLASS, j] == q:
            for r in range(3):
                out.impulse[3 * j + r] = single[one.IMPULSE + r] * share
            out.compression[j] = single[one.WORK_C] * share
            out.restitution[j] = single[one.WORK_R] * share
            out.friction[j] = single[one.FRICTION_LOSS] * share
            out.wedged[j] = 1 if int(single[one.PHASES]) & one.WEDGED != 0 else 0
    if not parts:
        out.summary[0].marks |= EXACT
    out.summary[0].steps += int(single[one.STEPS])
    return OK


@kernel
def _finish(k, W, u, scale, out):
    """Write u+ = u + W P and the energy; take back what round-off added to it."""
    n, result = 3 * k, out.summary[0]
    P_, after = out.impulse, out.velocity
    most = 0.0
    for i in range(k):
        most = max(most, P_[3 * i])
    for i in range(k):
        if not P_[3 * i] > _NOTHING * most:
            P_[3 * i], P_[3 * i + 1], P_[3 * i + 2] = 0.0, 0.0, 0.0
    capped = (result.marks & EXACT) == 0
    for turn in range(2):
        energy, gain = 0.0, 0.0
        for a in range(n):
            row, total = W[a], u[a]
            for b in range(n):
                total += row[b] * P_[b]
            after[a] = total
            energy += 0.5 * P_[a] * (u[a] + total)
            gain += P_[a] * total
        result.energy_change = energy
        if turn == 1 or not capped or not energy > 0.0 or not gain > 2.0 * energy:
            break
        for a in range(n):
            P_[a] *= 1.0 - energy / gain
        result.marks |= REPELLED
    close_ledger(k, out)


@kernel
def close_ledger(k, out):
    """Make the works of all contacts add up to the change of energy.

    Friction has what the normal forces have not; where that is nothing (a plastic event has no path, and
    tangential impulses may add to the energy there), the work of compression takes it.
    """
    loaded, work, loss = 0.0, 0.0, 0.0
    for i in range(k):
        loaded += out.compression[i]
        work += out.compression[i] + out.restitution[i]
        loss += out.friction[i]
    exact = work - out.summary[0].energy_change
    for i in range(k):
        if loss > 0.0 and exact > 0.0:
            out.friction[i] *= exact / loss
        elif not exact > 0.0:
            out.friction[i] = 0.0
            if loaded < 0.0:
                out.compression[i] *= 1.0 - exact / loaded
