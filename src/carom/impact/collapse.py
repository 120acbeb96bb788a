"""Inelastic collapse: when the impacts of a contact follow each other without end, one of them is plastic.

A body between two others may be struck infinitely often within a finite time, although the bounces on one of
them alone take longer (McNamara and Young 1992). Bounces lower than the tolerance, or than those that end in a
given step, g h^2/8, are not resolved. When a contact has struck n times in a row after bounces that low, and
e^n is negligible, its next impact is plastic: a single contact would have come to rest long before.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.geometry.rotation import norm
from carom.geometry.thresholds import ROUND_OFF
from carom.impact.thresholds import NO_RESTITUTION
from carom.law.restitution import restitution_at
from carom.model.laws import STRIKES


@kernel
def count_blow(system, controls, contact, contact_state, approach, now):
    """Count an impact with the speed `approach` [m/s], after those before it if the last bounce was low."""
    size = system.bodies[contact.body].extent
    low = max(0.125 * norm(system.gravity) * controls.step**2, controls.atol + controls.rtol * size)
    if approach * (now - contact_state.struck) > max(low, ROUND_OFF * size):
        contact_state.blows = 0
    contact_state.blows, contact_state.struck = contact_state.blows + 1, now


@kernel
def effective_restitution(system, contact, contact_state, approach):
    """Return the restitution of a contact for the impact that was counted last."""
    e = restitution_at(system.laws, contact.law[STRIKES], approach)
    before = contact_state.blows - 1.0
    return 0.0 if e < 1.0 and before > 0.0 and e**before <= NO_RESTITUTION else e
