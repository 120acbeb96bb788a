"""Rolling and pivoting friction: a torque of at most d times the normal force."""

from __future__ import annotations

from carom._compiled.decorators import inlined
from carom.model.laws import PERSISTENT
from carom.model.workspace import MOTION_ROLL


@inlined
def arm_of_torque(laws, contact, motion):
    """Return d [m] of a contact for `MOTION_ROLL` or `MOTION_PIVOT`, 0 if it has no such friction."""
    return laws.table[contact.law[PERSISTENT]].turning[motion - MOTION_ROLL]
