"""A trial step: proposed, then shortened until it has no event, except the first event at its end."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined
from carom.contact.continuous_detection import CLEAR, FLAT_RIM, UNSURE
from carom.contact.operations import first_inside, lost_gap
from carom.dynamics.adapt import allowed_step, crawls, plan_next, shorter, step_error
from carom.dynamics.explicit import CONSTRAINTS_LOST, rubs
from carom.dynamics.more_forces import turns_round
from carom.dynamics.step import step
from carom.dynamics.thresholds import LEAST_STEP, SAFETY
from carom.geometry.thresholds import REMAINDER, ROUND_OFF
from carom.model import records as r
from carom.model.actions import (
    EVENT_CONE,
    EVENT_GAP,
    EVENT_KINK,
    EVENT_KINK_OF_JOINT,
    EVENT_SEPARATE,
    MODE_SLIP,
    STRIKE,
)
from carom.model.allowance import COUNT_SEARCHES, COUNT_TRIALS, mark_count, overdone
from carom.model.controls import LOCATE
from carom.persistent.contact_step import contact_step, seek_in_groups
from carom.persistent.events import note_first_stops
from carom.persistent.margins import note_due
from carom.persistent.slip_law import share_before_kink
from carom.persistent.step_control import too_long
from carom.status import NOT_FINITE, STEP_TOO_SMALL, TOO_MANY_POINTS, UNSTABLE
from carom.status import STEP_CUT_TO_NOTHING as STEP_CUT
from carom.status import TOO_MANY_IMPACTS as TOO_MANY
from carom.stepping.energy_balance import IN_A_ROW, off_balance
from carom.stepping.event_search import (
    begin_search,
    detect_event,
    event_value,
    kink_of,
    next_trial,
    update_bracket,
)
from carom.stepping.record import finite
from carom.stepping.thresholds import SHORTEST_STEP

ONCE_MORE = -1  # another trial step is needed
EVERYWHERE = 2  # `part` of a search: its last trial step is made again, for all groups
EVENTS_AT_NOW = 20  # events in no time: after so many they wait for the end of a step


@inlined
def propose_step(model, data):
    """Store the length of the first trial step, unless the loop was left in the middle of one."""
    clock, step, search = data.clocks[0], data.work.step[0], data.work.search[0]
    if step.paused == 1:
        step.paused = 0
        return
    note_first_stops(model.system, data.active)
    if clock.now - clock.moment > model.controls.step:
        clock.moment, clock.in_moment = clock.now, 0
    dt = min(search.left, search.pace)
    if model.controls.order > 0 and may_err(model.system, data.active):
        dt = min(dt, allowed_step(search.left, data.work))
    if data.active.count[0] > 0:
        dt = until_bounces_end(data.active, min(dt, step.longest))
    dt = until_stop(model, data.active, dt, clock)
    if search.sure < dt:
        dt = search.sure
        search.sure *= 2.0
    search.dt, search.cuts, search.again, search.active, search.part = dt, 0, 0, 0, 0
    data.work.search[0].stiff = 0
    mark_count(data.work)
    search.eager = 1 if clock.in_moment < EVENTS_AT_NOW else 0


@inlined
def may_err(system, active):
    """Return whether a body is in contact, joined or loaded: the error of free flight is zero at any step."""
    if active.count[0] > 0:
        return True
    for b in range(system.bodies.shape[0]):
        if system.bodies[b].ballistic == 0:
            return True
    return False


@inlined
def until_stop(model, active, dt, clock):
    """Return dt, or the time until slip of an active point or of a joint with friction stops."""
    first, frictions = dt, model.system.relations.memory.frictions
    for i in range(frictions.shape[0]):
        first = min(first, frictions[i].stop if frictions[i].stop > 0.0 else first)
    for i in range(active.count[0]):
        active_point = active.points[i]
        if active_point.rest == 0:
            first = min(first, active_point.stop if active_point.mode == MODE_SLIP else first)
            first = min(first, min(active_point.turn_stop[0], active_point.turn_stop[1]))
    # except if stops follow each other without end, or the difference is round-off of the step
    inside = first > model.controls.rest * min(dt, model.controls.step)
    inside = inside and first < (1.0 - ROUND_OFF) * dt
    return first if inside and clock.in_moment < EVENTS_AT_NOW else dt


@inlined
def until_bounces_end(active, dt):
    """Return dt, or the time at which rolling or pivoting friction of an active point begins."""
    for i in range(active.count[0]):
        if active.points[i].bounces > 0.0:
            dt = min(dt, active.points[i].bounces)
    return dt


@inlined
def first_event(model, data, method):
    """Make trial steps until one has no event, or only the first event at its end; return a code."""
    step, search = data.work.step[0], data.work.search[0]
    search.found = 0
    while True:
        if step.since > r.LONG:
            step.paused = 1
            return r.PAUSE
        code = trial_step(model, data, method)
        if code == 0:
            code = fits(model, data)
        if code == 0 and search.active == 1:
            code = is_root(model, data)
        if code == 0 and search.active == 1 and search.part == 1:
            search.part = EVERYWHERE  # the event is known: all groups go there
            code = ONCE_MORE
        elif code == 0:
            code = event_within(model, data)
        if code != ONCE_MORE:
            return code


@inlined
def trial_step(model, data, method):
    """Make a step of length `search.dt` from the present state to `work.trial`, with its contact impulses.

    The code of the step without contact impulses is stored in the search, because a shorter step may succeed.
    """
    system, controls, active, now = model.system, model.controls, data.active, data.state
    work, clock = data.work, data.clocks[0]
    own, search = work.step[0], work.search[0]
    work.moment[0].start, search.order = clock.now, controls.order
    applied, code = step(model, data, method, search.dt)
    search.applied, search.friction, search.code = applied, 0.0, code
    if search.part == EVERYWHERE:
        search.part = 0
    else:
        clock.trials += 1
        own.counts[COUNT_TRIALS] += 1.0
    own.counts[COUNT_SEARCHES] += work.pair.state[0].searches
    work.pair.state[0].searches = 0
    own.since += 1.0 + now.shape[0] + active.contact_states.shape[0]
    if overdone(controls, own):
        return TOO_MANY
    if controls.order > 0 and search.active == 0:
        if crawls(clock, controls.duration - clock.now, search.dt, controls.interval):
            return STEP_TOO_SMALL
    if (active.count[0] > 0 or rubs(system)) and code == 0:
        applied, friction, code = contact_step(model, data, method, search.dt)
        if code != 0:  # a stage without a solution: a shorter step may have one
            search.code = code
            return 0
        search.applied += applied
        search.friction += friction
    return 0


@inlined
def fits(model, data):
    """Return 0 if the trial step is short enough for its error and its joints; else ONCE_MORE or a code."""
    system, controls, work = model.system, model.controls, data.work
    clock, search, code = data.clocks[0], work.search[0], work.search[0].code
    dt = search.dt
    error = math.inf
    if code == TOO_MANY_POINTS:
        return code
    if code == 0 and controls.order > 0 and (search.active == 0 or may_close(model, data)):
        error = step_error(system, controls.rtol, controls.atol, work)
        if search.active == 1 and not error <= 1.0:  # so it does not go as far as its event
            search.active, search.part = 0, 0
    if controls.order > 0 and search.active == 0:
        if error <= 1.0:
            if may_err(system, data.active):
                plan_next(dt, error, search.again == 1, controls, work)
            return 0
        if not dt > LEAST_STEP * controls.duration:
            return code if code != 0 else STEP_TOO_SMALL
        share = share_before_kink(model, data.active) if code == 0 else 1.0
        search.dt, search.again = shorter(dt, error, clock, work), 1
        if share < 1.0:  # a kink of a law is the reason: the step goes as far as that
            search.dt = max(search.dt, min(share, SAFETY) * dt)
        return ONCE_MORE
    if code == CONSTRAINTS_LOST and dt > SHORTEST_STEP * controls.step:
        search.active = 0
        clock.cuts += 1
        search.dt = 0.5 * dt
        search.pace = search.dt
        return ONCE_MORE
    return code


@inlined
def may_close(model, data):
    """Return whether a trial of a search may be of a lower order than the first, whose error was judged.

    A stage without a solution has a closing step in its place, which is one of contacts and dry friction alone.
    """
    if data.active.count[0] == 0 and not rubs(model.system):
        return False
    return data.work.search[0].dt > LEAST_STEP * model.controls.duration


@inlined
def is_root(model, data):
    """Return 0 if the end of the trial step is the event of the search; otherwise ONCE_MORE or a code."""
    system, work, search = model.system, data.work, data.work.search[0]
    f, rate = event_value(model, data)
    state = update_bracket(search, search.dt, f, rate)
    if state < 0:
        return no_value(system, work)
    if state == 0 and search.kind == EVENT_SEPARATE and f > 0.0:
        # as a force falls to zero its cone does, so slip may come first: beyond the opening nothing shows it
        if data.active.points[search.contact].grip < 0.0:
            begin_search(search, EVENT_CONE, search.contact, 0.0, search.dt)
            seek_in_groups(system, data.active, work)
            return bracket(model, data)
    if state == 0:
        search.dt = next_trial(search)
        return ONCE_MORE
    return 0


@inlined
def no_value(system, work):
    """Return the code of a search whose function has no value in a trial step."""
    search = work.search[0]
    if search.kind == EVENT_GAP and finite(work.trial):
        return lost_gap(system.contacts[search.contact])
    return NOT_FINITE


@inlined
def event_within(model, data):
    """Return 0 if the trial step is accepted: it has no event, or only one at its end (`found`)."""
    system, controls, active, now = model.system, model.controls, data.active, data.state
    work, search = data.work, data.work.search[0]

    # is the energy error too large?
    loses = too_long(model, data)
    if search.active == 0 and search.dt > SHORTEST_STEP * controls.step:
        loses = loses or turns_round(system, now, work.trial, search.dt)
    if not loses and (controls.order == 0 or active.count[0] > 0):
        loses, gains = off_balance(model, data)
        if gains == IN_A_ROW:
            return UNSTABLE if finite(work.trial) else NOT_FINITE
    if loses:
        return halve(model, data, True)

    # does an event lie inside?
    verdict, kind, other, low = detect_event(model, data)
    if verdict == FLAT_RIM:  # its points strike together at the present position
        search.pending, search.contact, search.horizon = STRIKE, other, search.left
        return 0
    own = search.active == 1 and kind == search.kind and other == search.contact
    if verdict == CLEAR or (own and verdict != UNSURE):
        search.found = search.active
        return 0
    if verdict == UNSURE:
        return halve(model, data, False)
    begin_search(search, kind, other, low, search.dt)
    seek_in_groups(system, active, work)
    return bracket(model, data)


@inlined
def halve(model, data, loses):
    """Halve the trial step; return 0 if it is too short to halve.

    If it `loses` energy, later steps are as short; else the next one is at most twice as long: what lies near
    in this step will be near in the next.
    """
    clock, search = data.clocks[0], data.work.search[0]
    if search.active == 1 and search.dt <= REMAINDER * search.horizon:
        search.found = 1
        return 0
    search.cuts += 1
    clock.cuts += 1
    if search.cuts > model.controls.max_cuts:
        return STEP_CUT
    search.active = 0
    search.dt *= 0.5
    if loses:
        search.pace = search.dt
    else:
        search.sure = 2.0 * search.dt
    return ONCE_MORE


@inlined
def bracket(model, data):
    """Start to bracket the time of an event; if impacts are not located, they are at the end of the step."""
    system, controls, work, search = model.system, model.controls, data.work, data.work.search[0]
    if search.kind != EVENT_GAP:
        note_due(data.active, search, work)
    if search.kind == EVENT_GAP and controls.location != LOCATE:
        search.found = 1
        return 0
    f, rate = event_value(model, data)
    if search.kind in (EVENT_KINK, EVENT_KINK_OF_JOINT):  # known at the start, too
        search.f_low = kink_of(system, data.active, search)[0]
    if update_bracket(search, search.dt, f, rate) < 0:
        return no_value(system, work)
    dt = next_trial(search)
    if search.kind == EVENT_GAP:
        guess = first_inside(system, data, search.contact)
        dt = guess if search.low < guess < search.high else dt
    search.dt = dt
    return ONCE_MORE
