"""Events that end a mode of motion within a step: functions that are positive before and negative after.

EVENT_GAP        gap                  of an open contact
EVENT_RATE       - d gap/dt           of a gap that falls below zero and returns within a step
EVENT_SEPARATE   N                    of a persistent contact
EVENT_CONE       mu N - |T|           while it sticks
EVENT_REVERSE    u_t . e              while it slips, e its direction at the start of the step
EVENT_JAM        W_nn - mu W_nt . e   while it slips (mathematics page, §3.6)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.generalized.layout import TOUCHES, N
from carom.generalized.motion import acceleration, find_contacts, rate_of, slip_of
from carom.generalized.step import take
from carom.model.actions import (
    EVENT_CONE,
    EVENT_GAP,
    EVENT_JAM,
    EVENT_RATE,
    EVENT_REVERSE,
    EVENT_SEPARATE,
    MODE_SLIP,
    MODE_STICK,
    NO_EVENT,
)
from carom.status import NOT_FINITE
from carom.stepping.event_search import begin_search, next_trial, update_bracket

ROUND_OFF = 1e-15  # of the gap's own terms
CONE_ROUND_OFF = 1e-12  # of the normal force, which is a result of elimination
TRIALS = 200  # of a search: the bracket is then round-off of its length
EARLIER = 20  # events that may lie before the first one that was found


@kernel
def note_start(system, t, x, work):
    """Store gaps and their rates at the start of a step."""
    find_contacts(system, t, x, work)
    for c in range(system.size[TOUCHES]):
        work.before[0, c], work.before[1, c] = work.gap[c], rate_of(work.G[c, 0], x, system.size[N])


@kernel
def value(system, active, kind, i, x, work):
    """Return the event function, and for a gap its rate; note the greatest magnitude that counts as zero.

    Its default, for functions that do not need another one, is that of `update_bracket`.
    """
    n, search = system.size[N], work.search[0]
    if kind == EVENT_GAP:
        search.tolerance = ROUND_OFF * work.gap_scale[i]
        return work.gap[i], rate_of(work.G[i, 0], x, n)
    if kind == EVENT_RATE:
        return -rate_of(work.G[i, 0], x, n), 0.0
    force, mu = active.force[i], system.friction[active.contact[i]]
    if kind == EVENT_SEPARATE:
        return force[0], 0.0
    if kind == EVENT_CONE:
        search.tolerance = CONE_ROUND_OFF * abs(force[0])
        return mu * force[0] - math.sqrt(force[1] * force[1] + force[2] * force[2]), 0.0
    if kind == EVENT_JAM:
        return active.yields[i], 0.0
    u1, u2 = slip_of(system, active, i, x, work)
    return u1 * active.heading[i, 0] + u2 * active.heading[i, 1], 0.0


@kernel
def open_contact(active, c):
    """Return whether contact c is not active."""
    for i in range(active.count[0]):
        if active.contact[i] == c:
            return False
    return True


@kernel
def violated(system, active, kind, i, x, work):
    """Return whether an event function is below zero."""
    work.search[0].tolerance = 0.0
    f, _ = value(system, active, kind, i, x, work)
    return f < -work.search[0].tolerance


@kernel
def first_violated(system, active, x, work):
    """Return (kind, index) of an event function that is below zero at `x`, (NO_EVENT, -1) if none is."""
    for c in range(system.size[TOUCHES]):
        if open_contact(active, c) and violated(system, active, EVENT_GAP, c, x, work):
            return EVENT_GAP, c
    for i in range(active.count[0]):
        if active.mode[i] == MODE_SLIP and system.friction[active.contact[i]] > 0.0:
            if violated(system, active, EVENT_REVERSE, i, x, work):
                return EVENT_REVERSE, i
            if not active.yields[i] > 0.0:
                return EVENT_JAM, i
        if violated(system, active, EVENT_SEPARATE, i, x, work):
            return EVENT_SEPARATE, i
        if active.mode[i] == MODE_STICK and violated(system, active, EVENT_CONE, i, x, work):
            return EVENT_CONE, i
    return NO_EVENT, -1


@kernel
def dips(system, active, h, x, work):
    """Return a contact whose gap may have been below zero within the step, -1 if none.

    The cubic with the gaps and rates at both ends decides: its least value is below a tenth of the depth of the
    dip.
    """
    for c in range(system.size[TOUCHES]):
        g0, r0 = work.before[0, c], h * work.before[1, c]
        g1, r1 = work.gap[c], h * rate_of(work.G[c, 0], x, system.size[N])
        if not (r0 < 0.0 < r1 and open_contact(active, c)):
            continue
        a, b = 2.0 * (g0 - g1) + r0 + r1, 3.0 * (g1 - g0) - 2.0 * r0 - r1
        root = math.sqrt(max(b * b - 3.0 * a * r0, 0.0))  # of 3 a s^2 + 2 b s + r0
        s = -r0 / (b + root) if b > 0.0 else (root - b) / (3.0 * a)
        least = g0 + s * (r0 + s * (b + s * a))
        if least <= 0.1 * (min(g0, g1) - least):
            return c
    return -1


@kernel
def find_root(motion, kind, i, t, x, high):
    """Return (s, status): the time s in (0, high] where an event function crosses zero.

    It is negative at `high`, whose state is in `work.end`; this is then the state at s.
    """
    work, search = motion.work, motion.work.search[0]
    begin_search(search, kind, i, 0.0, high)
    if kind == EVENT_GAP:
        search.f, search.rate = work.before[0, i], work.before[1, i]
    s = high
    for _ in range(TRIALS):
        f, rate = value(motion.system, motion.active, kind, i, work.end, work)
        found = update_bracket(search, s, f, rate)
        if found != 0:
            return s, 0 if found > 0 else NOT_FINITE
        s = next_trial(search)
        code = state_at(motion, t, x, s)
        if code != 0:
            return s, code
    return s, 0


@kernel
def state_at(motion, t, x, s):
    """Write the state a time s after `x` as the end of the step, with all quantities that `value` needs."""
    code = take(motion, t, x, s)
    if code != 0:
        return code
    return look_at_end(motion, t + s)


@kernel
def look_at_end(motion, t):
    """Evaluate all quantities that `value` needs at the end of the step; return a status."""
    system, work = motion.system, motion.work
    find_contacts(system, t, work.end, work)
    for c in range(system.size[TOUCHES]):
        if not math.isfinite(work.gap[c]):
            return NOT_FINITE
    if motion.active.count[0] == 0:
        return 0
    _, _, code = acceleration(system, motion.active, t, work.end, work, work.trial)
    return code


@kernel
def locate(motion, t, x, h):
    """Find the first event in the step h from `x`, whose end is known; return (s, kind, index, status).

    The end is then the state at s. Without an event, the kind is NO_EVENT and s = h.
    """
    system, active, work, s = motion.system, motion.active, motion.work, h
    code = look_at_end(motion, t + h)
    if code != 0:
        return h, NO_EVENT, -1, code
    kind, i = first_violated(system, active, work.end, work)
    if kind == NO_EVENT:
        c = dips(system, active, h, work.end, work)
        if c < 0:
            return h, NO_EVENT, -1, 0
        s, code = find_root(motion, EVENT_RATE, c, t, x, h)
        if code != 0 or not violated(system, active, EVENT_GAP, c, work.end, work):
            return h, NO_EVENT, -1, max(code, state_at(motion, t, x, h))
        kind, i = EVENT_GAP, c
    for _ in range(EARLIER):
        s, code = find_root(motion, kind, i, t, x, s)
        if code != 0:
            break
        other, j = first_violated(system, active, work.end, work)
        if other == NO_EVENT or (other == kind and j == i):
            break
        kind, i = other, j
    return s, kind, i, code
