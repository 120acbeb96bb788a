"""An impact at a corner: several contacts are closed, and one or more strike (mathematics page, part 2).

*Blow by blow*: the pair that approaches fastest strikes alone, until none approaches (§2.6). Points of one pair
of bodies strike together, and so do pairs that approach equally fast, so that symmetric motions stay symmetric.
The rule is exact for Newton's cradle with e = 1. In general the result depends on the order of the impacts, as
for all such rules.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom.geometry.thresholds import LAST_DIGIT
from carom.impact import thresholds as limits
from carom.impact.final_slip import works
from carom.impact.layout import AT_ONCE, BAD_INPUT, OK, PLASTIC
from carom.impact.multiple import layout as o
from carom.impact.multiple.classes import find_groups, find_pressed, reduce
from carom.impact.multiple.group import strike_group
from carom.impact.multiple.moreau import sound
from carom.law import impact_laws


@entry
def resolve_multiple(k, contacts, laws, settings, workspace, out):
    """Resolve an impact of k `CornerContacts`; return OK, or BAD_INPUT without a result.

    Contacts of one pair strike together, those of different pairs one after another. `settings` are
    `MultipleSettings`, `workspace` and `out` from `new_multiple_workspace` and `new_multiple_result`, K >= k.
    """
    scale = _check(k, contacts, laws)
    if not scale >= 0.0:
        return BAD_INPUT
    _clear(k, contacts, out)
    blow, count = workspace.blow, 0
    together = settings.multiple == o.BY_NEWTON or strikes_at_once(k, contacts)
    while True:
        ends = together or count >= settings.max_events * k
        m = choose(k, contacts, ends, limits.IMPACT_ERROR * scale, blow, out)
        if m == 0:
            break
        if ends and not together:  # the sequence does not end: the rest is plastic
            for a in range(m):
                blow.contacts.contact[a].restitution = 0.0
        _together(scale, settings, laws, workspace)
        if (
            ends
            and not together
            and not fastest(m, blow.contacts.u) > limits.NO_RESTITUTION * scale
        ):
            blow.result.summary[0].marks &= ~PLASTIC  # it has ended: what is left is negligible
        take(k, contacts, m, blow, out)
        count += 1
        if ends or workspace.work.clock[0].left < 0:
            break
    if count > 1:
        out.summary[0].events += count
        out.summary[0].marks &= ~o.EXACT
    if not together:
        _finish(k, contacts, out, False)
    return OK


@kernel
def _together(scale, settings, laws, workspace):
    """Resolve an impact of contacts that strike together; `scale` is the greatest velocity of all contacts."""
    blow, clock = workspace.blow, workspace.work.clock[0]
    contacts, out, k = blow.contacts, blow.result, blow.impact[0].k
    result = out.summary[0]
    _clear(k, contacts, out)
    result.classes = reduce(k, blow, laws, scale)
    find_pressed(k, blow, laws, blow.impact[0].still)
    groups = find_groups(k, result.classes, blow)
    at_end = by_final_slip(k, contacts, laws)
    by_newton, growth = settings.multiple == o.BY_NEWTON or at_end, limits.ENERGY_BALANCE
    if at_end:
        result.marks, growth = o.FINAL_SLIP, limits.FREE_GAIN
    while True:
        for g in range(groups):
            strike_group(g, by_newton, settings, laws, workspace)
            if clock.left < 0:
                return  # it was stopped: there is no result
        _finish(k, contacts, out, True)
        exact = (result.marks & o.EXACT) != 0  # a single contact may gain energy with Newton's law
        bounds = (3 * k, limits.VISIBLE_ERROR, growth)
        if exact or sound(contacts.W, contacts.u, out.velocity, out.impulse, scale, bounds):
            break
        if by_newton:
            result.marks |= o.NO_RESULT
            break
        by_newton = True
        result.marks, result.miss, result.plastic_change = 0, 0.0, 0.0
    if at_end and result.marks & o.MISSED == 0:
        result.marks &= ~AT_ONCE


@kernel
def by_final_slip(k, contacts, laws):
    """Return whether the law of any contact has no path: all are one contact problem then."""
    for i in range(k):
        if laws.table[contacts.contact[i].law].impact_law in impact_laws.WITHOUT_PATH:
            return True
    return False


@kernel
def _check(k, contacts, laws):
    """Return the greatest velocity, or NaN if the input is invalid."""
    W, u, total, scale = contacts.W, contacts.u, 0.0, 0.0
    for a in range(3 * k):
        row = W[a]
        scale = max(scale, abs(u[a]))
        total += u[a]
        for b in range(3 * k):
            total += row[b]
    for i in range(k):
        c = contacts.contact[i]
        mu, e, kappa = c.friction, c.restitution, c.stiffness
        total += mu + e + kappa
        known = 0 <= c.law < laws.table.shape[0]
        sound = known and mu >= 0.0 and 0.0 <= e <= 1.0 and kappa > 0.0
        if not (sound and W[3 * i, 3 * i] >= 0.0):
            return math.nan
    return scale if math.isfinite(total) else math.nan


@kernel
def _clear(k, contacts, out):
    """Write the result for contacts none of which strikes."""
    result = out.summary[0]
    result.energy_change, result.plastic_change = 0.0, 0.0
    result.miss = 0.0
    result.steps, result.events, result.rounds, result.classes, result.marks = 0, 0, 0, 0, 0
    for i in range(k):
        out.compression[i], out.restitution[i], out.friction[i] = 0.0, 0.0, 0.0
        out.wedged[i] = 0
    for i in range(3 * k):
        out.impulse[i] = 0.0
        out.velocity[i] = contacts.u[i]


@kernel
def strikes_at_once(k, contacts):
    """Return whether all contacts belong to one pair, or all e are 0, which is one plastic event."""
    one, plastic = True, True
    for i in range(k):
        one = one and contacts.contact[i].pair == contacts.contact[0].pair
        plastic = plastic and not contacts.contact[i].restitution > 0.0
    return one or plastic


@kernel
def fastest(k, u):
    """Return the greatest speed of approach of k contacts."""
    most = 0.0
    for i in range(k):
        most = max(most, -u[3 * i])
    return most


@kernel
def choose(k, contacts, every, least, blow, out):
    """Gather the contacts of the next impact; return their number, 0 if none approaches faster than `least`.

    They belong to the pair that approaches fastest and to pairs that approach equally fast; if `every`, they
    are all contacts. `out` has the velocities.
    """
    given, chosen, u = contacts.contact, blow.contacts.contact, out.velocity
    most = fastest(k, u)
    if not most > least:
        return 0
    m, equal = 0, (1.0 - limits.GROUP_ERROR) * most
    for i in range(k):
        strikes = every
        for j in range(0 if every else k):
            strikes = strikes or (given[j].pair == given[i].pair and -u[3 * j] >= equal)
        if strikes:
            chosen[m] = given[i]
            chosen[m].place = i
            m += 1
    for a in range(m):
        i = chosen[a].place
        for r in range(3):
            blow.contacts.u[3 * a + r] = u[3 * i + r]
            row, whole = blow.contacts.W[3 * a + r], contacts.W[3 * i + r]
            for b in range(m):
                for s in range(3):
                    row[3 * b + s] = whole[3 * chosen[b].place + s]
    blow.impact[0].k, blow.impact[0].others, blow.impact[0].still = m, k - m, least
    return m


@kernel
def take(k, contacts, m, blow, out):
    """Add the result of the impact of `m` contacts to the result of all contacts."""
    part, u, W = blow.result, out.velocity, contacts.W
    for a in range(m):
        i = blow.contacts.contact[a].place
        out.compression[i] += min(0.0, part.compression[a])
        out.restitution[i] += max(0.0, part.restitution[a])
        out.friction[i] += part.friction[a]
        out.wedged[i] = part.wedged[a]
        for r in range(3):
            impulse = part.impulse[3 * a + r]
            out.impulse[3 * i + r] += impulse
            if impulse != 0.0 and m < k:
                for b in range(3 * k):
                    u[b] += impulse * W[b, 3 * i + r]
    if m == k:
        for b in range(3 * m):
            u[b] = part.velocity[b]
    result, done = out.summary[0], part.summary[0]
    result.energy_change += done.energy_change
    result.plastic_change += done.plastic_change
    result.miss = max(result.miss, done.miss)
    result.steps += done.steps
    result.events += done.events
    result.rounds += done.rounds
    result.classes += done.classes
    result.marks |= done.marks


@kernel
def _finish(k, contacts, out, whole):
    """Write u+ = u + W P and the energy; remove what round-off changed in it.

    `whole`: this is the impact of contacts that strike together, not one of several blows.
    """
    W, u = contacts.W, contacts.u
    n, result = 3 * k, out.summary[0]
    P_, after = out.impulse, out.velocity
    most = 0.0
    for a in range(n):
        most = max(most, abs(u[a]))
    for i in range(k):
        if not P_[3 * i] * W[3 * i, 3 * i] > LAST_DIGIT * most:
            P_[3 * i], P_[3 * i + 1], P_[3 * i + 2] = 0.0, 0.0, 0.0
    capped = (result.marks & (o.EXACT | o.FINAL_SLIP)) == 0
    elastic = _keeps_energy(k, contacts, out)
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
        result.marks |= o.REPELLED
    if result.marks & o.FINAL_SLIP == 0:
        close_ledger(k, out)
    elif whole:
        share_works(k, contacts, out)


@kernel
def share_works(k, contacts, out):
    """Write the works of contacts whose impulses have no path: they add up to the change of energy."""
    u, after, P = contacts.u, out.velocity, out.impulse
    for i in range(k):
        a = 3 * i
        out.compression[i], out.restitution[i] = works(u[a], after[a], P[a])
        rub = P[a + 1] * (u[a + 1] + after[a + 1]) + P[a + 2] * (u[a + 2] + after[a + 2])
        out.friction[i] = 0.0 - 0.5 * rub


@kernel
def _keeps_energy(k, contacts, out):
    """Return whether all contacts with an impulse are elastic and without friction, and no body was trapped."""
    if (out.summary[0].marks & (PLASTIC | o.MISSED)) != 0:
        return False
    for i in range(k):
        c, acts = contacts.contact[i], out.impulse[3 * i] > 0.0
        if acts and (c.friction > 0.0 or c.restitution < 1.0):
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
