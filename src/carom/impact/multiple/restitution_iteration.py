"""The outer iteration of Newton's and Poisson's law over passages of the layer (mathematics page, §2.4)."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.impact.multiple import restitution as r
from carom.impact.multiple.adaptive import ENDED, pass_layer, resume, start
from carom.impact.multiple.layout import CAPPED, MISSED, OUT_F, OUT_NEW

_GAIN = 0.8  # a round is a gain if it reduces the greatest miss to this part or less
_PATIENCE = 4  # rounds without gain until it begins again, damped; after twice as many it ends
COARSE = 1e-4  # greatest tolerance of a passage; it decreases with the misses
_NEAR = 0.1  # greatest ln(target/reached) at which the nearest result is used


@kernel
def run(k, work, settings, rtol, anew):
    """Pass the layer with the coefficients e_* as they are; `rtol` holds from the first unloading."""
    p, most_events = settings.exponent, settings.max_events * k
    if anew:
        start(k, work)
    else:
        resume(k, work, p)
    most = settings.max_steps * k
    pass_layer(k, work, settings.rtol if anew else rtol, rtol, p, most_events, most)
    return work.clock[0].code


@kernel
def iterate_restitution(k, work, settings, result):
    """Iterate the energetic coefficients until each contact satisfies its own law.

    If they do not converge (two corners of one rigid edge cannot always both satisfy it), the nearest result is
    used if it is near enough, otherwise Stronge's law with the same e.
    """
    o = work.vector
    tolerance = max(3.0 * settings.rtol, 1e-10)
    r.begin(k, work, 1.0)
    ended = ENDED
    worst, capped = r.misses(k, work, o[OUT_F])
    if not worst > tolerance:  # the first passage was coarse
        ended = again(k, work, settings, settings.rtol)
        worst, capped = r.misses(k, work, o[OUT_F])
    r.keep_best(k, work)
    best, stale, rounds = worst, 0, 0
    while worst > tolerance and rounds < settings.max_rounds and ended == ENDED:
        r.improve(k, work)
        rtol = max(settings.rtol, min(COARSE, 0.01 * worst))
        ended = again(k, work, settings, rtol)
        rounds += 1
        worst, capped = r.misses(k, work, o[OUT_NEW])
        if not worst > tolerance and rtol > settings.rtol:
            rtol = settings.rtol
            ended = again(k, work, settings, rtol)
            worst, capped = r.misses(k, work, o[OUT_NEW])
        r.learn(k, work)
        stale += 1
        if worst < best:
            stale = 0 if worst < _GAIN * best else stale
            best = worst
            r.keep_best(k, work)
        if stale == _PATIENCE:
            r.back_to_best(k, work)
            r.begin(k, work, 0.5)
        elif stale > 2 * _PATIENCE:
            break
    result.rounds += rounds
    if not worst <= tolerance and ended == ENDED:
        result.marks |= MISSED
        result.miss = max(result.miss, best)
        if best < _NEAR:
            r.back_to_best(k, work)
        else:
            r.energetic(k, work)
        return again(k, work, settings, settings.rtol)
    if capped:
        result.marks |= CAPPED
    return ended


@kernel
def again(k, work, settings, rtol):
    """Pass the layer with other coefficients, from the first unloading if its state was saved."""
    return run(k, work, settings, rtol, work.clock[0].branched == 0)
