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

ROUND_OFF = 1e-15  # of the gap's own terms


@kernel
def note_start(system, t, x, work):
    """Store gaps and their rates at the start of a step."""
    find_contacts(system, t, x, work)
    for c in range(system.size[TOUCHES]):
        work.before[0, c], work.before[1, c] = work.gap[c], rate_of(work.G[c, 0], x, system.size[N])


@kernel
def detect_event(system, active, t, x, work):
    """Evaluate at `x` all quantities that `value` needs; return a status."""
    if system.size[TOUCHES] == 0:
        return 0
    find_contacts(system, t, x, work)
    for c in range(system.size[TOUCHES]):
        if not math.isfinite(work.gap[c]):
            return NOT_FINITE
    if active.count[0] == 0:
        return 0
    _, _, code = acceleration(system, active, t, x, work, work.trial)
    return code


@kernel
def value(system, active, kind, i, x, work):
    """Return (event function, greatest magnitude that counts as zero)."""
    if kind == EVENT_GAP:
        return work.gap[i], ROUND_OFF * work.gap_scale[i]
    if kind == EVENT_RATE:
        return -rate_of(work.G[i, 0], x, system.size[N]), 0.0
    force, mu = active.force[i], system.friction[active.contact[i]]
    if kind == EVENT_SEPARATE:
        return force[0], 0.0
    if kind == EVENT_CONE:
        pull = math.sqrt(force[1] * force[1] + force[2] * force[2])
        return mu * force[0] - pull, 1e-12 * abs(force[0])
    if kind == EVENT_JAM:
        return active.yields[i], 0.0
    u1, u2 = slip_of(system, active, i, x, work)
    return u1 * active.heading[i, 0] + u2 * active.heading[i, 1], 0.0


@kernel
def turned(system, active, t, x, work):
    """Return whether slip has turned by more than 60 degrees within a step, and has not only stopped."""
    looked = False
    for i in range(active.count[0]):
        if active.mode[i] == MODE_SLIP and system.friction[active.contact[i]] > 0.0:
            if not looked:
                find_contacts(system, t, x, work)
                looked = True
            u1, u2 = slip_of(system, active, i, x, work)
            h1, h2 = active.heading[i, 0], active.heading[i, 1]
            along, across = u1 * h1 + u2 * h2, abs(u1 * h2 - u2 * h1)
            if across > (1.7320508 * along if along > 0.0 else -0.1 * along):
                return True
    return False


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
    f, none = value(system, active, kind, i, x, work)
    return f < -none


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
    """Return (s, status): the time s in (0, high] where an event function crosses zero, `work.end` its state.

    The function is positive at 0 and negative at `high`. (If it is zero at 0, a later time at which it is
    positive is found first.) Regula falsi with the weights of Anderson and Bjorck (1973); every fourth step is
    a bisection.
    """
    low, f_low, f_high, length = 0.0, 0.0, 0.0, high
    for _ in range(40):  # halve the time until the function is positive
        f_high, none, code = value_at(motion, kind, i, t, x, high)
        if code != 0:
            return high, code
        s = low + 0.5 * (high - low)
        f_low, none, code = value_at(motion, kind, i, t, x, s)
        if code != 0:
            return s, code
        if f_low > none:
            low = s
            break
        high = s
        if abs(f_low) <= none and high - low <= 1e-9 * length:
            return s, 0
    for turn in range(200):
        s = low - f_low * (high - low) / (f_high - f_low)
        if not low < s < high or turn % 4 == 3:
            s = low + 0.5 * (high - low)
        f, none, code = value_at(motion, kind, i, t, x, s)
        if code != 0:
            return s, code
        if abs(f) <= none or not high - low > 4e-16 * (t + high):
            break
        if f > 0.0:
            weight = 1.0 - f / f_low
            low, f_low = s, f
            f_high *= weight if weight > 0.0 else 0.5
        else:
            weight = 1.0 - f / f_high
            high, f_high = s, f
            f_low *= weight if weight > 0.0 else 0.5
    return s, 0


@kernel
def state_at(motion, t, x, s):
    """Write the state a time s after `x` as the end of the step, with all quantities that `value` needs."""
    code = take(motion, t, x, s)
    if code != 0:
        return code
    return detect_event(motion.system, motion.active, t + s, motion.work.end, motion.work)


@kernel
def value_at(motion, kind, i, t, x, s):
    """Return (event function, greatest magnitude that counts as zero, status) a time s after `x`."""
    code = state_at(motion, t, x, s)
    if code != 0:
        return 0.0, 0.0, code
    f, none = value(motion.system, motion.active, kind, i, motion.work.end, motion.work)
    return f, none, 0


@kernel
def locate(motion, t, x, h):
    """Find the first event in the step h from `x`, whose end is known; return (s, kind, index, status).

    The end is then the state at s. Without an event, the kind is NO_EVENT and s = h.
    """
    system, active, work = motion.system, motion.active, motion.work
    end = work.end
    code = detect_event(system, active, t + h, end, work)
    if code != 0:
        return h, NO_EVENT, -1, code
    kind, i = first_violated(system, active, end, work)
    high = h
    if kind == NO_EVENT:
        c = dips(system, active, h, end, work)
        if c < 0:
            return h, NO_EVENT, -1, 0
        high, code = find_root(motion, EVENT_RATE, c, t, x, h)
        if code == 0 and violated(system, active, EVENT_GAP, c, end, work):
            kind, i = EVENT_GAP, c
        else:
            return h, NO_EVENT, -1, max(code, state_at(motion, t, x, h))
    s = high
    for _ in range(20):
        s, code = find_root(motion, kind, i, t, x, high)
        if code != 0:
            break
        other, j = first_violated(system, active, end, work)
        if other == NO_EVENT or (other == kind and j == i):
            break
        kind, i, high = other, j, s
    return s, kind, i, code
