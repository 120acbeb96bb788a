"""Inelastic collapse: infinitely many impacts within a finite time.

A body between two others may be struck infinitely often within a finite time, although the bounces on one of
them alone take longer (McNamara and Young 1992). When a contact has struck n times within a step and e^n is
negligible, its next impact is plastic: a single contact would have come to rest long before.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

SPENT = 1e-6  # e^n below this is negligible


@kernel
def effective_restitution(contact, contact_state):
    """Return the restitution of a contact for its next impact in this step."""
    e = contact.restitution
    return 0.0 if e < 1.0 and e ** float(contact_state.blows) <= SPENT else e
