"""An impact at a corner: several contacts are closed, and one or more strike (mathematics page, part 2)."""

from __future__ import annotations

import math

from carom._compiled.decorators import by_reference, entry, kernel
from carom.impact import laws
from carom.impact import layout as one
from carom.impact.layout import BAD_INPUT, OK, PLASTIC
from carom.impact.multiple import equal_contacts
from carom.impact.multiple.at_once import unsound
from carom.impact.multiple.layout import (
    ACTING_MU,
    BLOW_FRICTION,
    BLOW_RESTITUTION,
    BLOW_STIFFNESS,
    BLOW_U,
    BY_NEWTON,
    CAPPED,
    CLASS,
    CLASS_SIZE,
    CLEAN,
    EXACT,
    FIRST_MEMBER,
    GROUP,
    MASS,
    MEMBER,
    MISSED,
    NOT_RESOLVED,
    NOW_P,
    REPELLED,
    SINGLE,
    TRY,
    U0,
    CornerContacts,
)
from carom.impact.multiple.one import resolve_single
from carom.impact.multiple.passage import at_once, pass_group
from carom.impact.multiple.sequential import choose, strikes_at_once, take

_NOTHING = 1e-15  # changes of velocity below this part of the greatest velocity are round-off
_TOUCHES = 1e-13  # speeds of approach below this part of the greatest velocity count as zero


@entry
def resolve_multiple(contacts, settings, workspace, out):
    """Resolve an impact as `resolve_contacts`, for calls from Python."""
    return resolve_contacts(contacts, settings, workspace, out)


@kernel
def resolve_contacts(contacts, settings, workspace, out):
    """Resolve an impact of `CornerContacts`; return OK, or BAD_INPUT without a result.

    Contacts of one pair strike together, those of different pairs one after another. `settings` are
    `MultipleSettings`, `workspace` and `out` from `new_multiple_workspace` and `new_multiple_result`, K >= k.
    """
    scale = _check(contacts)
    if not scale >= 0.0:
        return BAD_INPUT
    _clear(contacts, out)
    blow, count = workspace.blow, 0
    together = settings.multiple == BY_NEWTON or strikes_at_once(contacts)
    while True:
        ends = together or count >= settings.max_events * contacts.k
        m = choose(contacts, ends, _TOUCHES * scale, blow, out)
        if m == 0:
            break
        if ends and not together:  # the sequence does not end: the rest is plastic
            for a in range(m):
                blow.given[BLOW_RESTITUTION, a] = 0.0
        part = by_reference(
            CornerContacts(
                m, contacts.k - m, blow.W, blow.given[BLOW_U], blow.given[BLOW_FRICTION],
                blow.given[BLOW_RESTITUTION], blow.law[0], blow.given[BLOW_STIFFNESS], blow.law[1],
            )
        )  # fmt: skip
        _together(part, scale, settings, workspace, blow.result)
        take(contacts, m, blow, out)
        count += 1
        if ends or workspace.work.clock[0].left < 0:
            break
    if count > 1:
        out.summary[0].events += count
        out.summary[0].marks &= ~EXACT
    if not together:
        _finish(contacts, out)
    return OK


@kernel
def _together(contacts, scale, settings, workspace, out):
    """Resolve an impact of contacts that strike together; `scale` is the greatest velocity of all contacts."""
    k, still, result = contacts.k, _TOUCHES * scale, out.summary[0]
    _clear(contacts, out)
    work = workspace.work
    index, clean = work.index, work.matrix[CLEAN]
    acting = by_reference(
        CornerContacts(
            k, contacts.others, clean, contacts.u, work.vector[ACTING_MU],
            contacts.restitution, contacts.law, contacts.stiffness, contacts.pair,
        )
    )  # fmt: skip
    result.classes = equal_contacts.reduce(contacts, acting, scale, index)
    equal_contacts.find_pressed(acting, still, index)
    groups = equal_contacts.find_groups(k, result.classes, clean, index)
    by_newton = settings.multiple == BY_NEWTON
    while True:
        for g in range(groups):
            _group(g, acting, still, by_newton, settings, workspace, out)
            if work.clock[0].left < 0:
                return  # it was stopped: there is no result
        _finish(contacts, out)
        exact = (result.marks & EXACT) != 0  # a single contact may gain energy with Newton's law
        if by_newton or exact or not unsound(contacts, scale, out):
            break
        by_newton = True
        result.marks, result.miss, result.plastic_change = 0, 0.0, 0.0


@kernel
def _check(contacts):
    """Return the greatest velocity, or NaN if the input is invalid."""
    k, W, u, total, scale = contacts.k, contacts.W, contacts.u, 0.0, 0.0
    for a in range(3 * k):
        row = W[a]
        scale = max(scale, abs(u[a]))
        total += u[a]
        for b in range(3 * k):
            total += row[b]
    for i in range(k):
        mu, e, kappa = contacts.friction[i], contacts.restitution[i], contacts.stiffness[i]
        total += mu + e + kappa
        sound = mu >= 0.0 and 0.0 <= e <= 1.0 and kappa > 0.0 and 0 <= contacts.law[i] < laws.COUNT
        if not (sound and W[3 * i, 3 * i] >= 0.0):
            return math.nan
    return scale if math.isfinite(total) else math.nan


@kernel
def _clear(contacts, out):
    """Write the result for contacts none of which strikes."""
    result = out.summary[0]
    result.energy_change, result.plastic_change = 0.0, 0.0
    result.miss = 0.0
    result.steps, result.events, result.rounds, result.classes, result.marks = 0, 0, 0, 0, 0
    for i in range(contacts.k):
        out.compression[i], out.restitution[i], out.friction[i] = 0.0, 0.0, 0.0
        out.wedged[i] = 0
    for i in range(3 * contacts.k):
        out.impulse[i] = 0.0
        out.velocity[i] = contacts.u[i]


@kernel
def _group(g, contacts, still, by_newton, settings, workspace, out):
    """Resolve the classes of group `g`; write impulses and works of their contacts.

    `by_newton` says that they are one contact problem, without the passage of the layer.
    """
    work, summary = workspace.work, out.summary[0]
    n = _gather(g, contacts, still, summary.classes, work)
    if n == 0 or (n == 1 and not by_newton and _exactly(contacts, still, work, out) == OK):
        return
    mass, speed, rate = _fill(n, contacts, still, settings.exponent, work)
    if not (mass > 0.0 and rate > 0.0):
        return
    plastic = summary.plastic_change
    summary.plastic_change = 0.0
    if by_newton:
        at_once(n, work, summary)
    else:
        pass_group(n, work, settings, summary)
    energy, index = speed * speed / mass, work.index
    for i in range(contacts.k):
        for a in range(n):
            if index[CLASS, i] == index[MEMBER, a]:
                c, share = work.contact[a], 1.0 / index[CLASS_SIZE, index[MEMBER, a]]
                for r in range(3):
                    out.impulse[3 * i + r] = work.vector[NOW_P, 3 * a + r] * share * speed / mass
                out.compression[i] = -max(0.0, c.absorbed) * share * energy
                out.restitution[i] = max(0.0, c.returned) * share * energy
                out.friction[i] = max(0.0, c.loss) * share * energy
                out.wedged[i] = c.wedged
    summary.plastic_change = plastic + energy * summary.plastic_change


@kernel
def _gather(g, contacts, still, classes, work):
    """List the classes of group `g` and write W between them; return their number, 0 if none strikes."""
    index, n, strikes = work.index, 0, False
    for q in range(classes):
        if index[GROUP, q] == g:
            index[MEMBER, n] = q
            n += 1
            strikes = strikes or contacts.u[3 * index[FIRST_MEMBER, q]] < -still
    if not strikes:
        return 0
    for a in range(n):
        for b in range(n):
            p, q = index[MEMBER, a], index[MEMBER, b]
            for r in range(3):
                for s in range(3):
                    work.matrix[MASS, 3 * a + r, 3 * b + s] = equal_contacts.class_coupling(
                        contacts.k, contacts.W, index, p, q, r, s
                    )
    return n


@kernel
def _fill(n, contacts, still, exponent, work):
    """Scale the group and write its contacts; return the scales of W and u, and the scale of the rate."""
    u, mu, kappa = contacts.u, contacts.friction, contacts.stiffness
    index, W = work.index, work.matrix[MASS]
    mass, speed, most, stiff = 0.0, 0.0, 0.0, 0.0
    for a in range(n):
        i = index[FIRST_MEMBER, index[MEMBER, a]]
        mass = max(mass, W[3 * a, 3 * a])
        speed = max(speed, -u[3 * i])
        for r in range(3 if mu[i] > 0.0 else 1):
            most = max(most, abs(u[3 * i + r]))
        stiff = max(stiff, kappa[i] * index[CLASS_SIZE, index[MEMBER, a]] * W[3 * a, 3 * a])
    if not (mass > 0.0 and stiff > 0.0):
        return 0.0, 0.0, 0.0
    speed = max(speed, 1e-3 * most)
    for a in range(3 * n):
        row = W[a]
        for b in range(3 * n):
            row[b] /= mass
    for a in range(n):
        q = index[MEMBER, a]
        i = index[FIRST_MEMBER, q]
        c = work.contact[a]
        c.mu, c.restitution, c.law = mu[i], contacts.restitution[i], contacts.law[i]
        c.e, c.members = c.restitution, index[CLASS_SIZE, q]
        c.root = (kappa[i] * index[CLASS_SIZE, q] * mass / stiff) ** (1.0 / exponent)
        c.grip = mu[i] * (W[3 * a + 1, 3 * a + 1] + W[3 * a + 2, 3 * a + 2])
        for r in range(3):
            work.vector[U0, 3 * a + r] = u[3 * i + r] / speed if r == 0 or mu[i] > 0.0 else 0.0
        if abs(u[3 * i]) <= still:
            work.vector[U0, 3 * a] = 0.0
        c.approach = max(0.0, -work.vector[U0, 3 * a])
    return mass, speed, stiff


@kernel
def _exactly(contacts, still, work, out):
    """Resolve a group of one class as one contact; return OK or NOT_RESOLVED.

    If its forces separate other contacts, or it is one impact of a sequence, it returns no more energy than it
    has absorbed, like each of several contacts. If it separates others and e = 0, the result is NOT_RESOLVED:
    all of them are one plastic event.
    """
    index, W, before = work.index, work.matrix[SINGLE], work.vector[TRY]
    q = index[MEMBER, 0]
    i = index[FIRST_MEMBER, q]
    mu, e, law = contacts.friction[i], contacts.restitution[i], contacts.law[i]
    parts = equal_contacts.parts_others(contacts.k, contacts.W, i, index)
    if parts and not e > 0.0:
        return NOT_RESOLVED
    for r in range(3):
        before[r] = contacts.u[3 * i + r] if r == 0 or mu > 0.0 else 0.0
        for s in range(3):
            W[r, s] = work.matrix[MASS, r, s]
    single, clock, summary = work.single, work.clock, out.summary[0]
    single[one.STILL] = still
    several = parts or contacts.others > 0
    resolve_single(clock, W, before, mu, e, law, single)
    if several and clock[0].code == one.OK and single[one.WORK_R] > -single[one.WORK_C]:
        resolve_single(clock, W, before, mu, 1.0, laws.STRONGE, single)
        summary.marks |= CAPPED
    if clock[0].code != one.OK:
        return NOT_RESOLVED
    share = 1.0 / index[CLASS_SIZE, q]
    for j in range(contacts.k):
        if index[CLASS, j] == q:
            for r in range(3):
                out.impulse[3 * j + r] = single[one.IMPULSE + r] * share
            out.compression[j] = single[one.WORK_C] * share
            out.restitution[j] = single[one.WORK_R] * share
            out.friction[j] = single[one.FRICTION_LOSS] * share
            out.wedged[j] = 1 if int(single[one.PHASES]) & one.WEDGED != 0 else 0
    if not several:
        summary.marks |= EXACT
    summary.steps += int(single[one.STEPS])
    return OK


@kernel
def _finish(contacts, out):
    """Write u+ = u + W P and the energy; remove what round-off changed in it."""
    k, W, u = contacts.k, contacts.W, contacts.u
    n, result = 3 * k, out.summary[0]
    P_, after = out.impulse, out.velocity
    most = 0.0
    for a in range(n):
        most = max(most, abs(u[a]))
    for i in range(k):
        if not P_[3 * i] * W[3 * i, 3 * i] > _NOTHING * most:
            P_[3 * i], P_[3 * i + 1], P_[3 * i + 2] = 0.0, 0.0, 0.0
    capped, elastic = (result.marks & EXACT) == 0, _keeps_energy(contacts, out)
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
        wrong = energy > 0.0 or (elastic and energy < 0.0)
        if turn == 1 or not capped or not wrong or not gain > 2.0 * abs(energy):
            break
        for a in range(n):
            P_[a] *= 1.0 - energy / gain
        result.marks |= REPELLED
    close_ledger(k, out)


@kernel
def _keeps_energy(contacts, out):
    """Return whether all contacts with an impulse are elastic and without friction, and no body was trapped."""
    if (out.summary[0].marks & (PLASTIC | MISSED)) != 0:
        return False
    for i in range(contacts.k):
        acts = out.impulse[3 * i] > 0.0
        if acts and (contacts.friction[i] > 0.0 or contacts.restitution[i] < 1.0):
            return False
    return True


@kernel
def close_ledger(k, out):
    """Make the works of all contacts add up to the change of energy.

    Friction gets the difference between the work of the normal forces and the change of energy. If it cannot
    (without friction, or if tangential impulses of a plastic event, which has no path, added energy), the work
    of compression is changed.
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
        else:
            out.friction[i] = 0.0
            if loaded < 0.0:
                out.compression[i] *= 1.0 - exact / loaded
