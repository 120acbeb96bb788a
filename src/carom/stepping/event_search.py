"""Search for the first event inside a step: examination of a trial step, and the root of an event function.

For a gap the rate is known: the next trial is the root of the cubic through the last two values and rates, if
it is inside the bracket (this is exact for a falling ball), otherwise Newton's method. The first trial is the
least root of the cubics of the vertices that are inside at the end: the lowest at the start may be another. For
persistent contacts: regula falsi with the Illinois rule. Every trial is a step of the method from the start of
the step, so an event is as accurate as the method.

The margins of several bodies jump where another of their points opens or slips: values on both sides of a jump
stay what they are. Then the bracket is halved until its length does not matter.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.contact.continuous_detection import BELOW, CLEAR, FLAT_RIM, UNSURE, cubic_root
from carom.contact.operations import event_gap, located_within
from carom.contact.passage import passage
from carom.geometry.thresholds import LAST_DIGIT, ROUND_OFF
from carom.law.friction import depends_on_slip
from carom.law.thresholds import KINK_ERROR
from carom.model.actions import (
    EVENT_BREAK,
    EVENT_CONE,
    EVENT_GAP,
    EVENT_JAM,
    EVENT_KINK,
    EVENT_KINK_OF_JOINT,
    EVENT_SEPARATE,
    EVENT_STOP,
)
from carom.model.laws import PERSISTENT
from carom.persistent.events import contact_event_value, find_contact_event
from carom.persistent.stops import least_left
from carom.persistent.thresholds import BREAK_AWAY, EVENT_ERROR, EVENT_MARGIN, JUMP_ERROR
from carom.stepping.thresholds import EVENT_VALUE, FLAT_PART

CREEPS = 6  # after so many regula falsi is slow
FLAT_TRIALS = 3  # trials in a row without another value, after which an event function jumps


@inlined
def detect_event(model, data):
    """Return the first event of the trial step: verdict, event, contact, a time before it.

    A gap may jump, as when another part of a body becomes the nearest: the search then ends inside,
    and what else is inside there has come earlier.
    """
    system, active, search = model.system, data.active, data.work.search[0]
    found, which, low = CLEAR, -1, 0.0
    narrowed = search.active == 1 and search.dt < (1.0 - ROUND_OFF) * search.width
    known = search.contact if narrowed and search.kind == EVENT_GAP else -1
    for c in range(active.contact_states.shape[0]):
        verdict, first = passage(model, data, c)
        if verdict in (UNSURE, FLAT_RIM):
            return verdict, EVENT_GAP, c, 0.0
        if verdict == BELOW and (found == CLEAR or which == known):
            found, which, low = BELOW, c, 0.5 * first
        elif verdict == CLEAR and active.contact_states[c].leaving == 1 and first > 0.0:
            active.contact_states[c].leaving = 0
    if found == BELOW:
        return BELOW, EVENT_GAP, which, low
    kind, i = find_contact_event(system, active, data.work)
    if i >= 0:
        return BELOW, kind, i, 0.0
    return CLEAR, EVENT_GAP, -1, 0.0


@kernel
def event_value(model, data):
    """Return the event function at the end of the trial step and, for a gap, its rate."""
    system, active, work = model.system, data.active, data.work
    search, state = work.search[0], work.trial
    if search.kind == EVENT_GAP:
        contact = system.contacts[search.contact]
        search.tolerance = located_within(model.controls, contact, state)
        return event_gap(system, data, search.contact, state)
    if search.kind == EVENT_BREAK:
        search.tolerance = BREAK_AWAY
        return system.relations.memory.frictions[search.contact].grip, 0.0
    if search.kind == EVENT_STOP:
        search.tolerance = 0.0  # what is round-off of a stop is zero
        return least_left(system, active, work), 0.0
    if search.kind in (EVENT_KINK, EVENT_KINK_OF_JOINT):
        search.tolerance = KINK_ERROR
        return kink_of(system, active, search)[1], 0.0
    active_point = active.points[search.contact]
    law = system.contacts[active_point.contact].law[PERSISTENT]
    if depends_on_slip(system.laws, law) and search.kind == EVENT_CONE:
        search.tolerance = BREAK_AWAY
    elif active_point.shares == 1 and search.kind != EVENT_JAM:
        search.tolerance = EVENT_ERROR
    return contact_event_value(system, active_point, search.kind), 0.0


@kernel
def kink_of(system, active, search):
    """Return the margins of the search before a kink of a law, at start and end of the step."""
    if search.kind == EVENT_KINK:
        kink = active.points[search.contact].kink
    else:
        kink = system.relations.memory.frictions[search.contact].kink
    return kink[0], kink[1]


@kernel
def begin_search(search, kind, contact, low, high):
    """Start the search for an event between `low` and `high`; its function is negative at `high`."""
    search.active, search.kind, search.contact = 1, kind, contact
    search.low, search.high, search.width = low, high, high
    search.f_low, search.side, search.tolerance = 1.0 if kind == EVENT_STOP else -1.0, 0, -1.0
    search.t, search.f, search.rate = 0.0, 0.0, 0.0
    search.above, search.below, search.alike, search.tried = 0.0, 0.0, 0, 0


@kernel
def update_bracket(search, t, f, rate):
    """Narrow the bracket by the value f at t; return 1 if t is the event, 0 if not, -1 if f is NaN."""
    search.before, search.f_before, search.rate_before = search.t, search.f, search.rate
    search.t, search.f, search.rate = t, f, rate
    if search.f_low < 0.0:  # the first value: only the sign is known at the low end
        search.f_low = abs(f)
        if search.tolerance < 0.0:
            search.tolerance = EVENT_VALUE * abs(f)
    if abs(f) <= search.tolerance or search.high - search.low <= LAST_DIGIT * search.width:
        return 1
    if only_sign(search) and f < 0.0 and -f * (t - search.low) <= JUMP_ERROR * search.width:
        return 1  # where it jumps, as what is shared does, its time is known to what that changes
    if jumps(search) and f < 0.0 and is_short(search, t):
        return 1
    note_flat(search, f)
    if f < 0.0:
        search.high, search.f_high = t, f
        if search.side == 1:
            search.f_low *= 0.5
        search.side = 1
    elif f > 0.0:
        search.low, search.f_low = t, f
        if search.side == 2:
            search.f_high *= 0.5
        search.side = 2
    else:
        return -1
    return 0


@kernel
def note_flat(search, f):
    """Store the value at the end of the bracket that moves; count the trials that have left it as it was."""
    before = search.below if f < 0.0 else search.above
    known = search.above > 0.0 and search.below < 0.0
    same = abs(f - before) <= FLAT_PART * (search.above - search.below)
    search.alike = search.alike + 1 if known and same else 0
    search.tried += 1
    if f < 0.0:
        search.below = f
    else:
        search.above = f


@kernel
def jumps(search):
    """Return whether the event function of several bodies is taken to jump in the bracket."""
    event = search.kind in (EVENT_CONE, EVENT_SEPARATE, EVENT_STOP)
    return event and search.many == 1 and search.alike >= FLAT_TRIALS


@kernel
def is_short(search, t):
    """Return whether the time from the low end to t, at which a margin has jumped, does not matter."""
    most = 1.0 if search.kind == EVENT_STOP else -search.below
    return most * (t - search.low) <= JUMP_ERROR * search.width


@kernel
def only_sign(search):
    """Return whether only the sign of the event function is known before the event."""
    return search.tolerance == EVENT_ERROR and search.f_low <= EVENT_MARGIN


@kernel
def by_secant(search):
    """Return the root of the line through the last two values on one side of the event; inf if they are not.

    Margins of several bodies may have another slope on the other side, where regula falsi is slow.
    """
    slow = search.many == 1 and search.tried > CREEPS
    same = slow and search.f * search.f_before > 0.0
    slope = search.f - search.f_before
    if not same or slope == 0.0:
        return math.inf
    return search.t - search.f * (search.t - search.before) / slope


@kernel
def next_trial(search):
    """Return the next time to try, by a cubic, Newton's method or regula falsi, otherwise the middle."""
    if search.kind == EVENT_GAP and search.rate < 0.0:
        t = cubic_root(
            search.before, search.f_before, search.rate_before, search.t, search.f, search.rate
        )
        if not (search.low < t < search.high):
            t = search.t - search.f / search.rate
        if not t > 0.0 and search.low == 0.0 and search.many == 1:  # it is inside at the start
            return 0.5 * LAST_DIGIT * search.width
    else:
        low, high = search.low, search.high
        if jumps(search) and is_short(search, high):
            return high
        if jumps(search):
            return 0.5 * (low + high)
        t = by_secant(search)
        if low < t < high:
            return t
        if only_sign(search):
            return 0.5 * (low + high)
        t = (low * search.f_high - high * search.f_low) / (search.f_high - search.f_low)
    if not (search.low < t < search.high):
        t = 0.5 * (search.low + search.high)
    return t
