"""Newton's and Poisson's law for several contacts: an outer iteration on the whole event (§2.4).

An energetic coefficient e_* of each contact is sought with which Newton's target u_n+ = e v0, or Poisson's
p_r = e p_c, is reached. Broyden's method with projected updates iterates the logarithms x = ln e_*; it begins
as the fixed point iteration e_* <- e_* target/reached. Always e_* <= 1: each contact returns at most the energy
it has absorbed, so that energy cannot grow with any law; a target that requires more is not reached.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.thresholds import ROUND_OFF
from carom.impact import thresholds as limits
from carom.impact.multiple import layout as o
from carom.impact.multiple.layer import resume, start
from carom.impact.multiple.steps import ENDED, pass_layer
from carom.law import impact_laws

_PATIENCE = 4  # rounds without gain until it begins again, damped; after twice as many it ends


@kernel
def impact_law(c, passage):
    """Return the number of the law of impact of a contact, of `carom.law.impact_laws`."""
    return passage.laws.table[c.law].impact_law


@kernel
def energetic(k, work, passage):
    """Set e_*: (A_r/-A_c)^1/2 for laws of work, and e as the first guess for other laws."""
    for i in range(k):
        c = work.contact[i]
        e = c.restitution
        law = impact_law(c, passage)
        if law in impact_laws.BY_WORK:
            e = math.sqrt(impact_laws.goal(law, e, 0.0, 0.0, -1.0))
        c.e = min(1.0, max(limits.LEAST_RESTITUTION, e))


@kernel
def has_target(c, passage):
    """Return whether the contact has a target to reach."""
    law = impact_law(c, passage)
    if law in impact_laws.BY_WORK or not c.restitution > 0.0:
        return False
    return law in impact_laws.BY_IMPULSE or c.approach > 0.0


@kernel
def any_targets(k, work, passage):
    """Return whether any contact has a target to reach."""
    for i in range(k):
        if has_target(work.contact[i], passage):
            return True
    return False


@kernel
def misses(k, work, passage):
    """Write ln(target/reached) of each contact; return the greatest magnitude, and whether an e_* is capped."""
    worst, capped = 0.0, False
    for i in range(k):
        c = work.contact[i]
        work.outer[i].new_miss = 0.0
        if not has_target(c, passage) or c.wedged == 1:  # no e_* separates a wedged contact
            continue
        law = impact_law(c, passage)
        target = impact_laws.goal(law, c.restitution, c.approach, c.loading, 0.0)
        reached = work.now.velocity[3 * i] if law in impact_laws.BY_SPEED else c.unloading
        if not target > 0.0:
            continue
        miss = limits.LARGEST_CORRECTION
        if reached > target * math.exp(-limits.LARGEST_CORRECTION):
            miss = max(-limits.LARGEST_CORRECTION, math.log(target / reached))
        if c.e >= 1.0 - ROUND_OFF and miss > 0.0:
            capped = True
            miss = 0.0
        elif c.e <= limits.LEAST_RESTITUTION * (1.0 + ROUND_OFF) and miss < 0.0:
            miss = 0.0
        work.outer[i].new_miss = miss
        worst = max(worst, abs(miss))
    return worst, capped


@kernel
def accept(k, work):
    """Make the new misses the present ones."""
    for i in range(k):
        work.outer[i].miss = work.outer[i].new_miss


@kernel
def begin(k, work, passage, gain):
    """Begin at the e_* in use; the inverse Jacobian is -gain for equal misses, and more for differences.

    Contacts without a target, such as an edge at rest, respond to the others and make their u_n+ more equal.
    """
    m = 0
    for i in range(k):
        m += 1 if has_target(work.contact[i], passage) else 0
    differing = limits.FIRST_DIFFERENCE if m < k else 1.0
    for i in range(k):
        work.outer[i].x, work.outer[i].last = math.log(work.contact[i].e), 0.0
        for j in range(k):
            mean = (1.0 - differing) / m if has_target(work.contact[j], passage) else 0.0
            work.inverse[i, j] = -gain * (mean + (differing if i == j else 0.0))


@kernel
def keep_best(k, work):
    """Save the e_* in use and their misses as the best so far."""
    for i in range(k):
        a = work.outer[i]
        a.best, a.best_miss = a.x, a.miss


@kernel
def back_to_best(k, work):
    """Return to the best e_* so far."""
    for i in range(k):
        a = work.outer[i]
        a.x, a.miss = a.best, a.best_miss
        work.contact[i].e = math.exp(a.best)


@kernel
def improve(k, work):
    """Step from the misses F: x <- x - J^-1 F, e_* in [e_min, 1]."""
    outer, H = work.outer, work.inverse
    for i in range(k):
        a, step = outer[i], 0.0
        for j in range(k):
            step -= H[i, j] * outer[j].miss
        if a.miss == 0.0:  # on target, capped, or without a target
            step = 0.0
        step = min(limits.LARGEST_CORRECTION, max(-limits.LARGEST_CORRECTION, step))
        x = min(0.0, max(math.log(limits.LEAST_RESTITUTION), a.x + step))
        a.step, a.x = x - a.x, x
        work.contact[i].e = math.exp(x)


@kernel
def learn(k, work):
    """Update the inverse Jacobian H from the last step s and the change of misses y, so that H y = s.

    H <- H + (s - H y) v^T H / (v^T H y): Broyden's update, with v = s less its part along the step before, for
    which H stays right (Gay and Schnabel 1978).
    """
    outer, H = work.outer, work.inverse
    size, along, before = 0.0, 0.0, 0.0
    for i in range(k):
        a = outer[i]
        a.change = a.new_miss - a.miss
        size += a.step * a.step
        along += a.step * a.last
        before += a.last * a.last
    accept(k, work)
    share = along / before if before > 0.0 else 0.0
    left = size - share * along
    if not left > limits.PARALLEL_STEPS * size:
        share, left = 0.0, size
    bottom = 0.0
    for i in range(k):
        a, total = outer[i], 0.0
        for j in range(k):
            total += H[i, j] * outer[j].change
        a.reply = total
        a.direction = a.step - share * a.last
        a.last = a.step
        bottom += a.direction * total
    if not abs(bottom) > 0.05 * left:
        return
    for j in range(k):
        row = 0.0
        for i in range(k):
            row += outer[i].direction * H[i, j]
        outer[j].update = row / bottom
    for i in range(k):
        correction = outer[i].step - outer[i].reply
        for j in range(k):
            H[i, j] += correction * outer[j].update


@kernel
def run(k, work, settings, rtol):
    """Pass the layer with the coefficients e_* as they are; `rtol` holds from the first unloading.

    If the state there was saved, continue from it: it does not depend on e_*.
    """
    anew = work.clock[0].branched == 0
    if anew:
        start(k, work)
    else:
        resume(k, work, settings.exponent)
    return pass_layer(k, work, settings, settings.rtol if anew else rtol, rtol)


@kernel
def iterate_restitution(k, work, settings, result):
    """Iterate the energetic coefficients until each contact satisfies its own law.

    If they do not converge (two corners of one rigid edge cannot always both satisfy it), the nearest result is
    used if it is near enough, otherwise Stronge's law with the same e.
    """
    tolerance = max(3.0 * settings.rtol, limits.LEAST_MISS)
    begin(k, work, settings, 1.0)
    ended = ENDED
    worst, capped = misses(k, work, settings)
    if not worst > tolerance:  # the first passage was coarse
        ended = run(k, work, settings, settings.rtol)
        worst, capped = misses(k, work, settings)
    accept(k, work)
    keep_best(k, work)
    best, stale, rounds = worst, 0, 0
    while worst > tolerance and rounds < settings.max_rounds and ended == ENDED:
        improve(k, work)
        rtol = max(settings.rtol, min(limits.COARSE_TOLERANCE, limits.MISS_SHARE * worst))
        ended = run(k, work, settings, rtol)
        rounds += 1
        worst, capped = misses(k, work, settings)
        if not worst > tolerance and rtol > settings.rtol:
            rtol = settings.rtol
            ended = run(k, work, settings, rtol)
            worst, capped = misses(k, work, settings)
        learn(k, work)
        stale += 1
        if worst < best:
            stale = 0 if worst < limits.ROUND_GAIN * best else stale
            best = worst
            keep_best(k, work)
        if stale == _PATIENCE:
            back_to_best(k, work)
            begin(k, work, settings, 0.5)
        elif stale > 2 * _PATIENCE:
            break
    result.rounds += rounds
    if not worst <= tolerance and ended == ENDED:
        result.marks |= o.MISSED
        result.miss = max(result.miss, best)
        if best < limits.NEAREST_RESULT:
            back_to_best(k, work)
        else:
            energetic(k, work, settings)
        return run(k, work, settings, settings.rtol)
    if capped:
        result.marks |= o.CAPPED
    return ended
