"""Newton's and Poisson's law for several contacts: an outer iteration on the whole event (§2.4).

An energetic coefficient e_* of each contact is sought with which Newton's target u_n+ = e v0, or Poisson's
p_r = e p_c, is reached. Broyden's method with projected updates iterates the logarithms x = ln e_*; it begins
as the fixed point iteration e_* <- e_* target/reached. Always e_* <= 1: each contact returns at most the energy
it has absorbed, so that energy cannot grow with any law; a target that requires more is not reached.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.impact import laws
from carom.impact.multiple.law import E_MIN
from carom.impact.multiple.layout import (
    INVERSE,
    NOW_U,
    OUT_BEST,
    OUT_BEST_F,
    OUT_DF,
    OUT_DX,
    OUT_F,
    OUT_H,
    OUT_LAST,
    OUT_NEW,
    OUT_V,
    OUT_X,
)

_FARTHEST = 1.5  # greatest |ln(target/reached)| and step that is believed
_DIFFERING = 3.0  # part of a first step in which contacts differ, if some have no target
_PARALLEL = 0.01  # squared sine of the least angle between two steps of which both are kept


@kernel
def energetic(k, work):
    """Set e_*: (A_r/-A_c)^1/2 for laws of work, and e as the first guess for other laws."""
    for i in range(k):
        c = work.contact[i]
        e = c.restitution
        if c.law in laws.BY_WORK:
            e = math.sqrt(laws.goal(c.law, e, 0.0, 0.0, -1.0))
        c.e = min(1.0, max(E_MIN, e))


@kernel
def has_target(c):
    """Return whether the contact has a target to reach."""
    if c.law in laws.BY_WORK or not c.restitution > 0.0:
        return False
    return c.law in laws.BY_IMPULSE or c.approach > 0.0


@kernel
def any_targets(k, work):
    """Return whether any contact has a target to reach."""
    for i in range(k):
        if has_target(work.contact[i]):
            return True
    return False


@kernel
def misses(k, work, out):
    """Write ln(target/reached) of each contact; return the greatest magnitude, and whether an e_* is capped."""
    worst, capped = 0.0, False
    for i in range(k):
        out[i] = 0.0
        c = work.contact[i]
        if not has_target(c) or c.wedged == 1:  # no e_* separates a wedged contact
            continue
        target = laws.goal(c.law, c.restitution, c.approach, c.loading, 0.0)
        reached = work.vector[NOW_U, 3 * i] if c.law in laws.BY_SPEED else c.unloading
        if not target > 0.0:
            continue
        miss = _FARTHEST
        if reached > target * math.exp(-_FARTHEST):
            miss = max(-_FARTHEST, math.log(target / reached))
        if c.e >= 1.0 - 1e-12 and miss > 0.0:
            capped = True
            miss = 0.0
        elif c.e <= E_MIN * (1.0 + 1e-12) and miss < 0.0:
            miss = 0.0
        out[i] = miss
        worst = max(worst, abs(miss))
    return worst, capped


@kernel
def begin(k, work, gain):
    """Begin at the e_* in use; the inverse Jacobian is -gain for equal misses, and more for differences.

    Contacts without a target, such as an edge at rest, respond to the others and make their u_n+ more equal.
    """
    m = 0
    for i in range(k):
        m += 1 if has_target(work.contact[i]) else 0
    differing = _DIFFERING if m < k else 1.0
    for i in range(k):
        work.vector[OUT_X, i], work.vector[OUT_LAST, i] = math.log(work.contact[i].e), 0.0
        for j in range(k):
            mean = (1.0 - differing) / m if has_target(work.contact[j]) else 0.0
            work.matrix[INVERSE, i, j] = -gain * (mean + (differing if i == j else 0.0))


@kernel
def keep_best(k, work):
    """Save the e_* in use and their misses as the best so far."""
    for i in range(k):
        work.vector[OUT_BEST, i] = work.vector[OUT_X, i]
        work.vector[OUT_BEST_F, i] = work.vector[OUT_F, i]


@kernel
def back_to_best(k, work):
    """Return to the best e_* so far."""
    for i in range(k):
        work.vector[OUT_X, i] = work.vector[OUT_BEST, i]
        work.contact[i].e = math.exp(work.vector[OUT_BEST, i])
        work.vector[OUT_F, i] = work.vector[OUT_BEST_F, i]


@kernel
def improve(k, work):
    """Step from the misses in row OUT_F: x <- x - J^-1 F, e_* in [e_min, 1]."""
    o, H = work.vector, work.matrix[INVERSE]
    for i in range(k):
        step = 0.0
        for j in range(k):
            step -= H[i, j] * o[OUT_F, j]
        if o[OUT_F, i] == 0.0:  # on target, capped, or without a target
            step = 0.0
        step = min(_FARTHEST, max(-_FARTHEST, step))
        x = min(0.0, max(math.log(E_MIN), o[OUT_X, i] + step))
        o[OUT_DX, i] = x - o[OUT_X, i]
        o[OUT_X, i] = x
        work.contact[i].e = math.exp(x)


@kernel
def learn(k, work):
    """Update the inverse Jacobian H from the last step s (OUT_DX) and the change of misses y, so that H y = s.

    H <- H + (s - H y) v^T H / (v^T H y): Broyden's update, with v = s less its part along the step before, for
    which H stays right (Gay and Schnabel 1978).
    """
    o, H = work.vector, work.matrix[INVERSE]
    size, along, before = 0.0, 0.0, 0.0
    for i in range(k):
        o[OUT_DF, i] = o[OUT_NEW, i] - o[OUT_F, i]
        o[OUT_F, i] = o[OUT_NEW, i]
        size += o[OUT_DX, i] * o[OUT_DX, i]
        along += o[OUT_DX, i] * o[OUT_LAST, i]
        before += o[OUT_LAST, i] * o[OUT_LAST, i]
    share = along / before if before > 0.0 else 0.0
    left = size - share * along
    if not left > _PARALLEL * size:
        share, left = 0.0, size
    bottom = 0.0
    for i in range(k):
        total = 0.0
        for j in range(k):
            total += H[i, j] * o[OUT_DF, j]
        o[OUT_H, i] = total
        o[OUT_V, i] = o[OUT_DX, i] - share * o[OUT_LAST, i]
        o[OUT_LAST, i] = o[OUT_DX, i]
        bottom += o[OUT_V, i] * total
    if not abs(bottom) > 0.05 * left:
        return
    for j in range(k):
        row = 0.0
        for i in range(k):
            row += o[OUT_V, i] * H[i, j]
        o[OUT_NEW, j] = row / bottom
    for i in range(k):
        correction = o[OUT_DX, i] - o[OUT_H, i]
        for j in range(k):
            H[i, j] += correction * o[OUT_NEW, j]
