"""The restitution of a contact in an impact: a number or a law of the speed; and inelastic collapse.

A body between two others may be struck infinitely often within a finite time, although the bounces on one of
them alone take longer (McNamara and Young 1992). Bounces lower than the tolerance, or than those that end in a
given step, g h^2/8, are not resolved. When a contact has struck n times in a row after bounces that low, and
e^n is negligible, its next impact is plastic: a single contact would have come to rest long before.
"""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom.dynamics.curve import value_at
from carom.geometry.rotation import norm
from carom.geometry.thresholds import ROUND_OFF
from carom.impact.thresholds import NO_RESTITUTION


@kernel
def count_blow(system, controls, contact, contact_state, approach, now):
    """Count an impact with the speed `approach` [m/s], after those before it if the last bounce was low."""
    size = system.bodies[contact.body].extent
    low = max(0.125 * norm(system.gravity) * controls.step**2, controls.atol + controls.rtol * size)
    if approach * (now - contact_state.struck) > max(low, ROUND_OFF * size):
        contact_state.blows = 0
    contact_state.blows, contact_state.struck = contact_state.blows + 1, now


@inlined
def restitution_at(system, contact, approach):
    """Return the restitution e of a contact at a speed of approach [m/s]."""
    if contact.restitution_piece == contact.last_restitution_piece:
        return contact.restitution
    return law_at(system.curves, contact, approach)


@kernel
def law_at(pieces, contact, approach):
    """Return e by the law of a contact."""
    law = (
        contact.restitution_piece, contact.last_restitution_piece, contact.restitution_exponent,
    )  # fmt: skip
    return min(1.0, max(0.0, value_at(pieces, law, approach)))


@kernel
def effective_restitution(system, contact, contact_state, approach):
    """Return the restitution of a contact for the impact that was counted last."""
    e, before = restitution_at(system, contact, approach), contact_state.blows - 1.0
    return 0.0 if e < 1.0 and before > 0.0 and e**before <= NO_RESTITUTION else e
