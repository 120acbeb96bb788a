"""One group of contacts in scaled variables: its passage through the layer, or its plastic event."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.impact.multiple import restitution as r
from carom.impact.multiple.adaptive import ENDED, start
from carom.impact.multiple.at_once import solve_group
from carom.impact.multiple.layout import FIXED, TRY, U
from carom.impact.multiple.motion import into_lanes
from carom.impact.multiple.restitution_iteration import COARSE, iterate_restitution, run

# greatest error of velocities, in units of the speed of approach, after fixed steps that replace those of
# controlled error: if a light body is between heavy ones, they are too long
_POOR = 1e-3


@kernel
def all_plastic(k, work):
    """Return whether e = 0 at all contacts."""
    for i in range(k):
        if work.contact[i].restitution > 0.0:
            return False
    return True


@kernel
def pass_group(k, work, cones, settings, result):
    """Resolve the group of `k` contacts in `work`; row U0 has the velocities before, row P gets the impulses.

    If `left` of the clock is below 0 at the end, the group was stopped, because it took too many steps.
    """
    r.energetic(k, work)
    start(k, work)
    if all_plastic(k, work):
        at_once(k, work, cones, result)
        return
    into_lanes(k, work)
    few = k <= settings.adaptive_up_to
    fixed = 0 if few else settings.fixed_steps
    iterates = r.any_targets(k, work)
    rtol = max(settings.rtol, COARSE) if iterates else settings.rtol
    ended = run(k, work, settings, rtol, fixed, True)
    if ended != ENDED and fixed == 0 and work.clock[0].steps >= settings.max_steps * k:
        fixed = settings.fixed_steps
        ended = run(k, work, settings, settings.rtol, fixed, True)
    if iterates and ended == ENDED:
        ended = iterate_restitution(k, work, settings, fixed, result)
    if fixed > 0:
        result.marks |= FIXED
        for i in range(3 * k):
            work.vector[TRY, i] = work.vector[U, i]
        ended = run(k, work, settings, settings.rtol, 2 * fixed, True)
        for i in range(3 * k):
            result.error = max(result.error, abs(work.vector[TRY, i] - work.vector[U, i]))
    result.steps += work.clock[0].steps
    result.events += work.clock[0].events
    work.clock[0].left -= work.clock[0].steps
    if (ended != ENDED or (few and not result.error <= _POOR)) and work.clock[0].left >= 0:
        at_once(k, work, cones, result)


@kernel
def at_once(k, work, cones, result):
    """Resolve the group as one contact problem."""
    solve_group(k, work, cones)
    result.plastic_change += work.clock[0].change
    result.marks |= work.clock[0].code
    result.error = 0.0
