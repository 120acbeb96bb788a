"""One group of contacts in scaled variables: its passage through the layer, or its plastic event."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.impact.multiple import restitution as r
from carom.impact.multiple.adaptive import ENDED, start
from carom.impact.multiple.at_once import solve_group
from carom.impact.multiple.motion import into_lanes
from carom.impact.multiple.restitution_iteration import COARSE, iterate_restitution, run


@kernel
def all_plastic(k, work):
    """Return whether e = 0 at all contacts."""
    for i in range(k):
        if work.contact[i].restitution > 0.0:
            return False
    return True


@kernel
def pass_group(k, work, settings, result):
    """Resolve the group of `k` contacts in `work`; row U0 has the velocities before, row P gets the impulses.

    If `left` of the clock is below 0 at the end, the group was stopped, because it took too many steps.
    """
    r.energetic(k, work)
    start(k, work)
    if all_plastic(k, work):
        at_once(k, work, result)
        return
    into_lanes(k, work)
    iterates = r.any_targets(k, work)
    rtol = max(settings.rtol, COARSE) if iterates else settings.rtol
    ended = run(k, work, settings, rtol, True)
    if iterates and ended == ENDED:
        ended = iterate_restitution(k, work, settings, result)
    result.steps += work.clock[0].steps
    result.events += work.clock[0].events
    work.clock[0].left -= work.clock[0].steps
    if ended != ENDED and work.clock[0].left >= 0:
        at_once(k, work, result)


@kernel
def at_once(k, work, result):
    """Resolve the group as one contact problem."""
    solve_group(k, work)
    result.plastic_change += work.clock[0].change
    result.marks |= work.clock[0].code
