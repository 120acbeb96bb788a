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
from carom.contact.continuous_detection import cubic_clears
from carom.generalized.linear import dot
from carom.generalized.motion import acceleration, find_contacts, persists, slip_of
from carom.generalized.step import take
from carom.generalized.thresholds import CONE_ERROR, GAP_ERROR
from carom.law.friction import bound_of_stick
from carom.model import actions as a
from carom.status import NOT_FINITE
from carom.stepping.event_search import begin_search, next_trial, update_bracket

TRIALS = 200  # of a search: the bracket is then round-off of its length
EARLIER = 20  # events that may lie before the first one that was found


@kernel
def find_margins(motion, t):
    """Evaluate all event functions at the end of the step; return a status.

    They are infinite for contacts that are not in their mode.
    """
    system, active, work = motion.system, motion.active, motion.work
    margin, nothing, end, code, most = work.margin, work.nothing, work.end, 0, 0.0
    find_contacts(system, t, end, work)
    for c in range(system.contacts):
        if not math.isfinite(work.gap[c]):
            return NOT_FINITE
    if persists(active):
        _, _, code = acceleration(system, active, t, end, work, work.trial)
    for c in range(system.contacts):
        if active[c].mode != a.MODE_OPEN:
            most = max(most, abs(active[c].force[0]))
    for c in range(system.contacts):
        contact, force, mu = active[c], active[c].force, bound_of_stick(system.laws, c)
        for kind in range(a.NO_EVENT):
            margin[kind, c], nothing[kind, c] = math.inf, 0.0
        if contact.mode == a.MODE_OPEN:
            margin[a.EVENT_GAP, c] = work.gap[c]
            nothing[a.EVENT_GAP, c] = GAP_ERROR * work.gap_scale[c]
            margin[a.EVENT_RATE, c] = -dot(work.G[c, 0], end[system.n :], system.n)
            continue
        margin[a.EVENT_SEPARATE, c] = force[0]
        if contact.mode == a.MODE_STICK:
            pull = math.sqrt(force[1] * force[1] + force[2] * force[2])
            margin[a.EVENT_CONE, c] = mu * force[0] - pull
            nothing[a.EVENT_CONE, c] = CONE_ERROR * most
        elif mu > 0.0:
            u1, u2, _, _ = slip_of(system, contact.heading, c, end, work)
            margin[a.EVENT_REVERSE, c] = u1 * contact.heading[0] + u2 * contact.heading[1]
            margin[a.EVENT_JAM, c] = contact.yields
    return code


@kernel
def first_violated(system, work):
    """Return (kind, contact) of an event function that is below zero, (NO_EVENT, -1) if none is."""
    for kind in (a.EVENT_GAP, a.EVENT_REVERSE, a.EVENT_JAM, a.EVENT_SEPARATE, a.EVENT_CONE):
        for c in range(system.contacts):
            if not work.margin[kind, c] >= -work.nothing[kind, c]:
                return kind, c
    return a.NO_EVENT, -1


@kernel
def dips(system, h, work):
    """Return a contact whose gap may have been below zero within the step, -1 if none.

    Its rate changes sign, and the cubic with the gaps and rates at both ends may be below zero.
    """
    for c in range(system.contacts):
        g0, r0 = work.before[0, c], work.before[1, c]
        g1, r1 = work.margin[a.EVENT_GAP, c], -work.margin[a.EVENT_RATE, c]
        if r0 < 0.0 < r1 and not cubic_clears(g0, r0, g1, r1, h, 0.0):
            return c
    return -1


@kernel
def find_root(motion, kind, c, t, x, high):
    """Return (s, status): the time s in (0, high] where an event function crosses zero.

    It is negative at `high`, whose state is in `work.end`; this is then the state at s.
    """
    work, search, s = motion.work, motion.work.search[0], high
    begin_search(search, kind, c, 0.0, high)
    if kind == a.EVENT_GAP:
        search.f, search.rate = work.before[0, c], work.before[1, c]
    for _ in range(TRIALS):
        if work.nothing[kind, c] > 0.0:
            search.tolerance = work.nothing[kind, c]
        rate = -work.margin[a.EVENT_RATE, c] if kind == a.EVENT_GAP else 0.0
        found = update_bracket(search, s, work.margin[kind, c], rate)
        if found != 0:
            return s, 0 if found > 0 else NOT_FINITE
        s = next_trial(search)
        code = state_at(motion, t, x, s)
        if code != 0:
            return s, code
    return s, 0


@kernel
def state_at(motion, t, x, s):
    """Write the state a time s after `x` as the end of the step, with its event functions; return a status."""
    code = take(motion, t, x, s)
    return find_margins(motion, t + s) if code == 0 else code


@kernel
def locate(motion, t, x, h):
    """Find the first event in the step h from `x`, whose end is known; return (s, kind, contact, status).

    The end is then the state at s. Without an event, the kind is a.NO_EVENT and s = h.
    """
    system, work, s = motion.system, motion.work, h
    find_contacts(system, t, x, work)
    for c in range(system.contacts):
        work.before[0, c] = work.gap[c]
        work.before[1, c] = dot(work.G[c, 0], x[system.n :], system.n)
    code = find_margins(motion, t + h)
    if code != 0:
        return h, a.NO_EVENT, -1, code
    kind, c = first_violated(system, work)
    if kind == a.NO_EVENT:
        c = dips(system, h, work)
        if c < 0:
            return h, a.NO_EVENT, -1, 0
        s, code = find_root(motion, a.EVENT_RATE, c, t, x, h)
        if code != 0 or work.margin[a.EVENT_GAP, c] >= -work.nothing[a.EVENT_GAP, c]:
            return h, a.NO_EVENT, -1, max(code, state_at(motion, t, x, h))
        kind = a.EVENT_GAP
    for _ in range(EARLIER):
        s, code = find_root(motion, kind, c, t, x, s)
        if code != 0:
            break
        other, b = first_violated(system, work)
        if other == a.NO_EVENT or (other == kind and b == c):
            break
        kind, c = other, b
    return s, kind, c, code
