"""Whether two laws are the same in an impact."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.model.laws import SLIP


@kernel
def strike_alike(laws, i, j):
    """Return whether contacts with these laws, of equal friction and restitution, strike alike."""
    if i == j:
        return True
    a, b = laws.table[i], laws.table[j]
    same = a.impact_law == b.impact_law and a.tangential_restitution == b.tangential_restitution
    return same and a.first[SLIP] == b.first[SLIP] and a.last[SLIP] == b.last[SLIP]
