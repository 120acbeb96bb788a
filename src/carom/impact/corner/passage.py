"""One group of contacts, in scaled variables: through the layer, plastically, or blow by blow."""

from __future__ import annotations

from carom.impact.corner import restitution as r
from carom.impact.corner.adaptive import ENDED, pass_layer, resume, start
from carom.impact.corner.fixed import pass_fixed
from carom.impact.corner.layout import CAPPED, FELL_BACK, FIXED, OUT_F, OUT_NEW, PLASTIC, TRY, U
from carom.impact.corner.plastic import end_plastically
from carom.jit import kernel


@kernel
def all_plastic(k, work):
    """Return whether no contact gives anything back."""
    for i in range(k):
        if work.contact[i].restitution > 0.0:
            return False
    return True


@kernel
def pass_group(k, work, cones, units, settings, result):
    """Resolve the group of `k` contacts in `work`; velocities before are in row U0, impulses go to P."""
    p = settings.exponent
    r.energetic(k, work)
    start(k, work)
    if all_plastic(k, work):
        end_plastically(units.plastic, k, work, cones, p)
        result.plastic_change += work.clock[0].change
        result.marks |= PLASTIC
        return
    fixed = 0 if k <= settings.adaptive_up_to else settings.fixed_steps
    ended = _once(k, work, units, settings, fixed, True)
    if ended != ENDED and fixed == 0 and work.clock[0].steps >= settings.max_steps * k:
        fixed = settings.fixed_steps
        ended = _once(k, work, units, settings, fixed, True)
    if r.any_aims(k, work) and ended == ENDED:
        ended = _meet_laws(k, work, units, settings, fixed, result)
    if fixed > 0:
        result.marks |= FIXED
        for i in range(3 * k):
            work.vector[TRY, i] = work.vector[U, i]
        ended = _once(k, work, units, settings, 2 * fixed, True)
        for i in range(3 * k):
            result.error = max(result.error, abs(work.vector[TRY, i] - work.vector[U, i]))
    result.steps += work.clock[0].steps
    result.events += work.clock[0].events
    if ended != ENDED:
        end_plastically(units.plastic, k, work, cones, p)
        result.plastic_change += work.clock[0].change
        result.marks |= PLASTIC


@kernel
def _once(k, work, units, settings, fixed, anew):
    """Pass the layer with the coefficients e_* as they are."""
    p, most_events = settings.exponent, settings.max_events * k
    if anew:
        start(k, work)
    if fixed > 0:
        most = 20 * fixed * k + 50 * fixed
        pass_fixed(units.fixed, k, work, units, fixed, p, 8 * most_events, most)
        return work.clock[0].code
    if not anew:
        resume(k, work)
    most = settings.max_steps * k
    pass_layer(units.layer, k, work, units, settings.rtol, p, most_events, most)
    return work.clock[0].code


@kernel
def _meet_laws(k, work, units, settings, fixed, result):
    """Iterate the energetic coefficients until each contact meets its own law."""
    clock, o = work.clock[0], work.vector
    tolerance = 1e-3 if fixed > 0 else max(3.0 * settings.rtol, 1e-10)
    r.begin(k, work)
    worst, capped = r.misses(k, work, o[OUT_F])
    ended, rounds = ENDED, 0
    while worst > tolerance and rounds < settings.max_rounds and ended == ENDED:
        r.improve(k, work)
        anew = fixed > 0 or clock.branched == 0
        ended = _once(k, work, units, settings, fixed, anew)
        rounds += 1
        worst, capped = r.misses(k, work, o[OUT_NEW])
        r.learn(k, work)
    result.rounds += rounds
    if not worst <= tolerance and ended == ENDED:
        r.energetic(k, work)
        result.marks |= FELL_BACK
        anew = fixed > 0 or clock.branched == 0
        return _once(k, work, units, settings, fixed, anew)
    if capped:
        result.marks |= CAPPED
    return ended
