"""The order of pairs and contacts in an island: that of the scene, independent of when their rows were made.

Contacts with rows from the start have the order of these rows. Contacts added later follow in the order of
their bodies, as if all pairs had been made at the start. So the time of their addition has no effect.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def comes_before(fixed, a, pair_a, b, pair_b):
    """Return whether contact a comes before contact b; `pair_a` and `pair_b` have their bodies."""
    if a < fixed or b < fixed:
        return a < b
    if pair_a.body != pair_b.body:
        return pair_a.body < pair_b.body
    if pair_a.other != pair_b.other:
        return pair_a.other < pair_b.other
    return a < b


@kernel
def sort_contacts(system, islands):
    """Sort the contacts of each island by insertion, because they are nearly sorted."""
    fixed, which, contacts = islands.plan[0].fixed, islands.which, system.contacts
    for island in range(islands.plan[0].count):
        first = islands.first[1, island]
        for i in range(first + 1, islands.first[1, island + 1]):
            c, j = which[i], i
            while j > first and comes_before(
                fixed, c, contacts[c], which[j - 1], contacts[which[j - 1]]
            ):
                which[j] = which[j - 1]
                j -= 1
            which[j] = c


@kernel
def sort_pairs(islands):
    """Sort the pairs of balls by counting: by the second body, then by the first."""
    first, n, count = islands.pair_first, islands.pair_first.shape[0] - 1, islands.plan[0].pairs
    for turn in range(2):
        source, target, side = islands.pair[turn], islands.pair[1 - turn], 1 - turn
        for b in range(n + 1):
            first[b] = 0
        for p in range(count):
            first[source[p, side] + 1] += 1
        for b in range(n):
            first[b + 1] += first[b]
        for p in range(count):
            place = first[source[p, side]]
            first[source[p, side]] += 1
            target[place, 0], target[place, 1] = source[p, 0], source[p, 1]
