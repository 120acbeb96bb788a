"""Blow by blow: the contact that approaches fastest is resolved alone, until none approaches (V.6).

Exact for Newton's cradle with e = 1. In general it depends on the order of the blows, and so do all such rules.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.impact import laws
from carom.impact import layout as one
from carom.impact.multiple.adaptive import APART, start
from carom.impact.multiple.layout import MASS, PLASTIC, SINGLE, TRY, P, U
from carom.impact.multiple.motion import set_velocity
from carom.impact.multiple.one import resolve_single
from carom.impact.multiple.plastic import end_plastically


@kernel
def blow_by_blow(k, work, cones, settings, result):
    """Resolve the group of `k` contacts in `work`; velocities before are in row U0, impulses go to P."""
    start(k, work)
    for i in range(k):
        work.contact[i].mode = 0
    while True:
        lead = 0
        for i in range(k):
            if work.vector[U, 3 * i] < work.vector[U, 3 * lead]:
                lead = i
        if not work.vector[U, 3 * lead] < -APART:
            return
        if result.events >= settings.max_events * k or not _blow(lead, work):
            break
        result.events += 1
        set_velocity(k, work)
    end_plastically(k, work, cones, settings.exponent)
    result.plastic_change += work.clock[0].change
    result.marks |= PLASTIC


@kernel
def _blow(i, work):
    """Resolve contact `i` alone; return whether it could be."""
    c, W, u, single = work.contact[i], work.matrix[SINGLE], work.vector[TRY], work.single
    for r in range(3):
        u[r] = work.vector[U, 3 * i + r]
        for s in range(3):
            W[r, s] = work.matrix[MASS, 3 * i + r, 3 * i + s]
    clock = work.clock
    resolve_single(clock, W, u, c.mu, c.restitution, c.law, single)
    if (
        clock[0].code == one.OK and single[one.WORK_R] > -single[one.WORK_C]
    ):  # not more than it took
        resolve_single(clock, W, u, c.mu, 1.0, laws.STRONGE, single)
    if clock[0].code != one.OK:
        return False
    for r in range(3):
        work.vector[P, 3 * i + r] += single[one.IMPULSE + r]
    c.absorbed -= single[one.WORK_C]
    c.returned += single[one.WORK_R]
    c.loss += single[one.FRICTION_LOSS]
    return True
