"""A sequence of impacts: the pair that approaches fastest strikes alone, until none approaches (§2.6).

Points of one pair of bodies strike together, and so do pairs that approach equally fast, so that symmetric
motions stay symmetric. The rule is exact for Newton's cradle with e = 1. In general the result depends on the
order of the impacts, as for all such rules.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.impact.multiple.equal_contacts import SAME
from carom.impact.multiple.layout import BLOW_FRICTION, BLOW_RESTITUTION, BLOW_STIFFNESS, BLOW_U


@kernel
def strikes_at_once(contacts):
    """Return whether all contacts belong to one pair, or all e are 0, which is one plastic event."""
    one, plastic = True, True
    for i in range(contacts.k):
        one = one and contacts.pair[i] == contacts.pair[0]
        plastic = plastic and not contacts.restitution[i] > 0.0
    return one or plastic


@kernel
def choose(contacts, every, least, blow, out):
    """Gather the contacts of the next impact; return their number, 0 if none approaches faster than `least`.

    They belong to the pair that approaches fastest and to pairs that approach equally fast; if `every`, they
    are all contacts. `out` has the velocities.
    """
    k, pair, member, u, fastest = contacts.k, contacts.pair, blow.member, out.velocity, 0.0
    for i in range(k):
        fastest = max(fastest, -u[3 * i])
    if not fastest > least:
        return 0
    m, equal = 0, (1.0 - SAME) * fastest
    for i in range(k):
        strikes = every
        for j in range(0 if every else k):
            strikes = strikes or (pair[j] == pair[i] and -u[3 * j] >= equal)
        if strikes:
            member[m] = i
            m += 1
    for a in range(m):
        i = member[a]
        blow.given[BLOW_FRICTION, a] = contacts.friction[i]
        blow.given[BLOW_RESTITUTION, a] = contacts.restitution[i]
        blow.given[BLOW_STIFFNESS, a] = contacts.stiffness[i]
        blow.law[0, a], blow.law[1, a] = contacts.law[i], pair[i]
        for r in range(3):
            blow.given[BLOW_U, 3 * a + r] = u[3 * i + r]
            row, whole = blow.W[3 * a + r], contacts.W[3 * i + r]
            for b in range(m):
                for s in range(3):
                    row[3 * b + s] = whole[3 * member[b] + s]
    return m


@kernel
def take(contacts, m, blow, out):
    """Add the result of the impact of `m` contacts to the result of all contacts."""
    member, part, u, W = blow.member, blow.result, out.velocity, contacts.W
    for a in range(m):
        i = member[a]
        out.compression[i] += min(0.0, part.compression[a])
        out.restitution[i] += max(0.0, part.restitution[a])
        out.friction[i] += max(0.0, part.friction[a])
        out.wedged[i] = part.wedged[a]
        for r in range(3):
            impulse = part.impulse[3 * a + r]
            out.impulse[3 * i + r] += impulse
            if impulse != 0.0 and m < contacts.k:
                for b in range(3 * contacts.k):
                    u[b] += impulse * W[b, 3 * i + r]
    if m == contacts.k:
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
