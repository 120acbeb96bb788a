"""Blows without end in a finite time: inelastic collapse.

A body between two others may be struck without end before a finite time, and no single contact comes to an
end of its bounces there (McNamara and Young 1992). Once a contact has struck n times within a step, and
e^n is next to nothing, its next blow is plastic: alone it would have come to rest long before.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel

SPENT = 1e-6  # part of a speed that counts as nothing
TIRED = 1 << 40  # blows after which the next is plastic even with e = 1


@kernel
def what_is_left(contact, brink):
    """Return the restitution of a contact for its next blow in this step."""
    e = contact.restitution
    if brink.blows >= TIRED:
        return 0.0
    return 0.0 if e < 1.0 and e ** float(brink.blows) <= SPENT else e
