"""One step of an island: free motion, events, impacts, held contacts, up to the end of the step.

Each large part (step, strike, hold) is called from one place: what is linked in is compiled once for each
call.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from carom._compiled.decorators import inlined, kernel
from carom.contact.closed_points import apart, closed_within
from carom.contact.continuous_detection import AGAIN, CLEAR, FLAT_RIM, UNSURE, greatest_acceleration
from carom.contact.gap import gap_and_rate, plane_in_body, slow
from carom.contact.pair_point import REACH, find_touches, smaller, touch_rate
from carom.contact.stop import look_at_stop
from carom.dynamics.acceleration import OPEN, SLIP, STICK
from carom.dynamics.adapt import NOTHING_LEFT, plan_next, shorter, step_error
from carom.dynamics.explicit import CONSTRAINTS_LOST, keep
from carom.dynamics.more_forces import note_turns, turns_round
from carom.dynamics.step import step
from carom.geometry.rotation import norm
from carom.impact.effective_restitution import TIRED
from carom.impact.strike import strike
from carom.kinematics.contact_point import contact_velocity
from carom.model import records as r
from carom.model.actions import HOLD, NOTHING, SETTLE, STRIKE
from carom.model.arrays import FREE, STOP
from carom.model.choice import only_with_pairs
from carom.model.event_rows import begin_event, end_event
from carom.persistent.active_set import (
    is_held,
    let_go,
    refresh_pairs,
    regroup,
    set_anchor,
    strike_off,
)
from carom.persistent.contact_step import press
from carom.persistent.events import (
    CONE,
    GAP,
    JAM,
    REVERSE,
    SEPARATE,
    end_forces,
    held_value,
    residual,
    slides_on,
)
from carom.persistent.jam import JAMMED, note_jam, presses
from carom.persistent.joint_events import STOPS, review_joints, turn_joint
from carom.persistent.lifecycle import hold_contact, settle
from carom.persistent.margins import meet_due, note_due
from carom.persistent.step_control import (
    CAREFUL,
    UNSOLVED,
    USELESS,
    affordable,
    goes_wild,
    next_pace,
    too_long,
    unsolved,
)
from carom.stepping.energy_balance import IN_A_ROW, SHORTEST, WIDER, imbalance
from carom.stepping.event_search import begin_search, event_value, examine, narrow, propose
from carom.stepping.record import finite, save_contacts

LOCATE, PROJECT, WORK = range(3)
STEP_CUT, TOO_MANY, NOT_FINITE = 2, 3, 4
NO_CONVERGENCE, STEP_TOO_SMALL, UNSTABLE = 1, 12, 14
TRIES = 3000  # trial steps of a step that is given up
# a step that is given up goes on in so many parts without looking for the times of events, with so many events
# in a part at most
PARTS, MOST_AT_ONCE = 16, 50


class Controls(NamedTuple):
    """Settings of a run, as numbers."""

    step: float
    duration: float
    location: int  # LOCATE, PROJECT or WORK
    save_every: int
    last: int  # number of the last step; 0 where steps vary
    gap: float  # tolerance of a located gap, relative to the body
    tie: float  # vertices this near the lowest strike together, relative to the body
    hold: int
    rest: float  # speeds below this part of what forces give in a step are none
    layer_steps: int
    layer_time: int  # 1: add the duration of impacts to the clock
    max_impacts: int
    max_cuts: int
    strike_at: int  # addresses of units
    hold_at: int
    corner_at: int
    settle_at: int
    press_at: int
    heap_at: int
    heap: int  # an island of so many bodies takes its steps whole
    retry: int  # a step that does not get on is given up, to be taken: 1 whole, 2 in parts; 0: it is not
    order: int  # of the error of a step whose length is chosen; 0: all steps are `step`
    rtol: float
    atol: float
    longest: float


@inlined
def advance(
    system, method, controls, held, now, begin, length, cluster, corner, work, clocks, records,
    watch,
):  # fmt: skip
    """Move the bodies of an island to the end of the step. Returns 0, or what `run` is to return."""
    clock, search, trial = clocks[0], work.search[0], work.trial
    late = controls.retry == 2 and is_whole(
        clock.step, work
    )  # events at the ends of parts of the step
    goes_on = clock.spent > 0.0 or clock.paused == 1 or search.pending != NOTHING
    pace = search.pace if goes_on else math.inf
    while clock.spent < length:
        search.pace = pace  # wherever the loop is left, it goes on as if it had not been
        if clock.since > r.LONG and clock.paused == 0:
            return r.PAUSE
        if full(system, held, clock, records):
            return r.FULL
        if not late:
            if clock.in_step > controls.max_impacts or clock.at_once > 1000:
                return TOO_MANY
            if controls.retry > 0 and clock.effort > affordable(controls, clock):
                return TOO_MANY
        remaining = length - clock.spent
        exact = controls.location == LOCATE and controls.order == 0 and not late
        horizon = remaining if exact else controls.step
        action, c = search.pending, search.contact
        if clock.paused == 1 or (late and clock.at_once > MOST_AT_ONCE):
            action = search.pending = NOTHING
        elif action != NOTHING:  # what was put off until its unit was compiled
            horizon = search.horizon
            search.pending = NOTHING
        else:
            action, c = look_near(system, controls, held, now, work)
        if action == NOTHING:
            # a trial step, cut until nothing can lie inside it, or shortened to its first event
            dt, cuts, found, again = min(remaining, pace), 0, False, False
            if clock.paused == 1:
                dt, cuts, again = search.dt, search.cuts, search.again == 1
                clock.paused = 0
            else:
                if held.count[0] > 0 and not late:
                    dt = until_stop(controls, held, dt, clock)
                if late:
                    dt = min(dt, length / PARTS)
                search.active, search.eager = 0, 1 if clock.in_step < 20 else 0
            while True:
                if clock.since > r.LONG:
                    search.dt, search.cuts, search.pace = dt, cuts, pace
                    search.again, clock.paused = 1 if again else 0, 1
                    return r.PAUSE
                work.result[0].start = clock.now
                applied, friction, code = step(method, system, held, now, dt, trial, work)
                clock.trials += 1
                clock.tries += 1
                alone = friction  # of points that are held one to a body
                clock.since += 1.0 + now.shape[0] + held.brinks.shape[0]
                if controls.retry > 0 and not late:
                    if clock.tries > TRIES or clock.effort > affordable(controls, clock):
                        return TOO_MANY
                if held.count[0] > 0 and code == 0:
                    end_forces(system, held, trial, work)
                    press(
                        controls.press_at, system, controls, held, now, dt, trial, cluster,
                        work, clocks,
                    )  # fmt: skip
                    if work.result[0].code != 0:
                        return work.result[0].code
                    if controls.retry == 1 and clock.effort > affordable(controls, clock):
                        return TOO_MANY  # and its rounds were not all made
                    applied += work.result[0].applied
                    friction += work.result[0].friction
                if controls.order > 0 and search.active == 0:
                    error = math.inf
                    if code == 0:
                        error = step_error(
                            system, controls.rtol, controls.atol, now, dt, trial, work
                        )
                    if not error <= 1.0:
                        if not dt > NOTHING_LEFT * controls.duration:
                            return code if code != 0 else STEP_TOO_SMALL
                        dt, again = shorter(dt, error, controls, clock), True
                        remaining, length = dt, clock.length
                        continue
                    plan_next(dt, error, again, controls, clock)
                elif code == CONSTRAINTS_LOST and dt > SHORTEST * controls.step:
                    search.active, clock.cuts = 0, clock.cuts + 1
                    pace = dt = 0.5 * dt
                    continue
                elif code != 0:
                    return code
                if search.active == 1:
                    f, rate = event_value(system, controls, held, search, trial, work)
                    state = narrow(search, dt, f, rate)
                    if state < 0:
                        return NOT_FINITE
                    if state == 0:
                        dt = propose(search)
                        continue
                verdict, kind, other, low, d1, d2 = UNSURE, GAP, -1, 0.0, 0.0, 0.0
                loses = too_long(
                    system, controls, held, now, trial, dt, alone, pace < math.inf, late, work
                )
                if search.active == 0 and dt > SHORTEST * controls.step:
                    loses = loses or turns_round(system, now, trial, dt)
                if not loses and controls.order == 0:
                    loses, gains = off_balance(
                        system, controls, held, now, trial, applied + friction, dt, pace < math.inf,
                        clock, work, watch,
                    )  # fmt: skip
                    if gains == IN_A_ROW:
                        return UNSTABLE if finite(trial) else NOT_FINITE
                if not loses:
                    verdict, kind, other, low, d1, d2 = examine(
                        system, controls, held, now, dt, work
                    )
                if verdict == FLAT_RIM and not late:  # its points strike together where they are
                    search.pending, search.contact, search.horizon = STRIKE, other, remaining
                    break
                own = search.active == 1 and kind == search.kind and other == search.contact
                if verdict == CLEAR or (own and verdict != UNSURE):
                    found = search.active == 1
                    break
                if verdict == AGAIN:
                    search.active = 0
                    continue
                if late and not loses:  # at the end of this part
                    search.kind, search.contact, found = kind, other, other >= 0
                    break
                if verdict == UNSURE:
                    if search.active == 1 and dt <= 1e-9 * horizon:
                        found = True
                        break
                    cuts += 1
                    clock.cuts += 1
                    if cuts > controls.max_cuts:
                        return STEP_CUT
                    search.active = 0
                    dt *= 0.5
                    pace = dt if loses else pace
                    continue
                begin_search(search, kind, other, low, dt, d1, d2)
                if kind != GAP and kind < STOPS:
                    note_due(held, search, work)
                if kind == GAP and controls.location != LOCATE:
                    found = True
                    break
                f, rate = event_value(system, controls, held, search, trial, work)
                narrow(search, dt, f, rate)
                dt = propose(search)
            if search.pending != NOTHING:
                continue
            # an island is taken whole then; where there are none the run goes on as long as it makes sense
            bearable = UNSOLVED if controls.retry == 1 else USELESS
            if held.count[0] > 0 and unsolved(system, controls, work, bearable):
                if not late:
                    return NO_CONVERGENCE
                let_go(held)
                regroup(system, held, work)
                continue
            if held.count[0] > 0 and controls.retry == 1 and goes_wild(work):
                return NO_CONVERGENCE
            if not finite(trial):
                return NOT_FINITE
            accept(now, trial, dt, applied, friction, begin, clock)
            note_turns(system, now)
            pace = search.pace = next_pace(pace, work)
            if strayed(system, now, dt, work):
                return r.STRAYED
            if dt == remaining:
                clock.spent = length
            of_contact = found and search.kind != GAP and search.kind < STOPS
            met = of_contact and not late and meet_due(held, search)
            if held.count[0] > 0:
                turn_modes(system, controls, held, now, work, clock, records)
            if not found:
                continue
            clock.located += 1
            c = search.contact
            horizon = max(horizon - dt, 0.0) if exact else horizon
            action = NOTHING if met else STRIKE
            if search.kind >= STOPS:
                turn_joint(system, search.kind, c, held, now, work)
                clock.in_step += 1
                clock.at_once += 1
                continue
            if search.kind != GAP and not met:
                action = change_mode(system, held, c, search.kind, now, work, clock, records)
        closed = 0
        clock.at_once += 1 if action != NOTHING else 0
        if action == STRIKE:
            struck = clock.struck
            strike(
                controls.strike_at, method, system, controls, held, c, now, cluster, corner,
                work, clocks, records,
            )  # fmt: skip
            closed = work.hit[0].closed
            clock.since += 10.0
            if late:
                tire_contacts(held)
            if work.hit[0].code != 0:
                search.pending, search.contact, search.horizon = STRIKE, c, horizon
                return work.hit[0].code
            review_joints(system, held, now, work)
            if controls.layer_time == 1 and clock.struck > struck:
                clock.spent += records.impact[struck].duration  # the position stays
        if action == STRIKE and not (
            closed != 1 or may_end(system.contacts[c], system, now, horizon, work)
        ):
            continue
        if action != NOTHING and controls.hold == 1:
            if controls.hold_at == 0:
                search.pending, search.contact = max(action, HOLD), c
                search.horizon = horizon
                return r.NEEDS_HOLD
            if action == SETTLE:
                settle(controls.settle_at, system, controls, held, c, now, work, clocks, records)
            else:
                hold_contact(
                    controls.hold_at, system, controls, held, c, now, horizon, cluster, work,
                    clocks, records,
                )  # fmt: skip
                if work.hit[0].code != 0:
                    return work.hit[0].code
            if clock.now == 0.0:  # touching from the start: the first row says so
                clock.touched = clock.first_touch
                save_contacts(system, held, now, 0, clock, work, records)
    return 0


@inlined
def is_whole(step, work):
    """Return whether the bodies are to take this step without looking for the times of its events."""
    return work.body[0].whole_until > step


@inlined
def tire_contacts(held):
    """Let contacts that were struck be plastic up to the end of the step."""
    for c in range(held.brinks.shape[0]):
        if held.brinks[c].blows > 0:
            held.brinks[c].blows = TIRED


@inlined
def full(system, held, clock, records):
    """Return whether the records have no room for one turn of the loop."""
    rows = r.MARGIN + held.count[0]
    last = max(clock.event + 1, clock.struck) + rows
    if last > records.event.shape[0] or clock.touched + rows > records.touch.shape[0]:
        return True
    return clock.snapped + 2 * (system.bodies.shape[0] + rows) > records.snapshot.shape[0]


@inlined
def strayed(system, now, dt, work):
    """Return whether a body may have left the ball that was given to it for this step.

    Both ends of a piece of its path are within it by what a fall of that time can bulge between them.
    """
    bulge = 0.125 * dt * dt * norm(system.gravity)
    for b in range(now.shape[0]):
        memory, d = work.body[b], 0.0
        if not math.isfinite(memory.room):
            continue
        for k in range(3):
            d += (now[b].x[k] - memory.home[k]) ** 2
        if not math.sqrt(d) + bulge <= memory.room:
            return True
    return False


@kernel
def _look_at_pair(system, controls, held, contact, c, now, still, work):
    """Return whether a closed point of two bodies is to be struck or held."""
    near = closed_within(controls, contact, now)
    if apart(contact, now, near):
        return NOTHING
    action = NOTHING
    for i in range(find_touches(system, contact, now, REACH * smaller(contact), work)):
        touch = work.touches[i]
        if touch.gap <= near:
            rate = touch_rate(contact, touch, now)
            if rate < -still:
                return STRIKE
            if rate <= still and not is_held(system, held, c, touch, now):
                action = HOLD
    return action


@kernel
def _look_at_none(system, controls, held, contact, c, now, still, work):
    """No kernels of pairs are needed."""
    return NOTHING


look_at_pair = only_with_pairs(_look_at_pair, _look_at_none)


@inlined
def look_near(system, controls, held, now, work):
    """Find a closed point that is not held, at the start or after an event: strike or hold it."""
    for c in range(held.brinks.shape[0]):
        brink, contact = held.brinks[c], system.contacts[c]
        if brink.near == 0:
            continue
        near, still = controls.tie * contact.extent, slow(contact, now)
        action = NOTHING
        if contact.touches == 1:
            action = look_at_pair(system, controls, held, contact, c, now, still, work)
        elif contact.touches == STOP:
            action = look_at_stop(system, controls, held, contact, c, now, work)
        else:
            plane = plane_in_body(contact, now)
            for i in range(contact.first, contact.last):
                z, rate = gap_and_rate(plane, system.vertices[i])
                if z <= near:
                    if rate < -still:
                        action = STRIKE
                    elif rate <= still and held.carries[i] == 0 and action == NOTHING:
                        action = HOLD
        brink.near = 0
        if brink.jams == 1:
            brink.jams, action = 0, STRIKE
        if action == HOLD:
            brink.leaving = 1  # unless it is held now
        if action != NOTHING:
            return action, c
    return NOTHING, -1


@inlined
def may_end(contact, system, state, horizon, work):
    """Return whether the bounces of a contact that was just struck, alone, could end within the horizon.

    A first look, with a bound of the acceleration where there is one, before the forces are worked out.
    """
    if contact.touches != 0:
        return True
    point = work.point[0]
    rate = contact_velocity(point, state)[0]
    if rate <= slow(contact, state) or system.bodies[contact.body].ballistic == 0:
        return True
    work.body[contact.body].status = FREE
    _, most = greatest_acceleration(system, contact, state, work)
    return 2.0 * rate < most * (1.0 - contact.restitution) * horizon


@inlined
def until_stop(controls, held, dt, clock):
    """Return dt, or the time in which slip of one of several held points is going to stop."""
    first = dt
    for i in range(held.count[0]):
        hold = held.points[i]
        if hold.several == 1 and hold.rest == 0:
            first = min(first, hold.stop if hold.mode == SLIP else first)
            first = min(first, min(hold.turn_stop[0], hold.turn_stop[1]))
    # not where they follow each other without end, nor for round-off of the step
    inside = first > controls.rest * dt and first < (1.0 - 1e-12) * dt
    return first if inside and clock.in_step < 20 else dt


@kernel
def off_balance(system, controls, held, start, end, named, dt, careful, clock, work, watch):
    """Return whether a step is to be cut for energy without a name, and how many gained energy in a row.

    The shortest are taken as they are, and the limit is made wider for those that come: round-off, or a force
    that jumps, is not to cut all steps of a run. On the way to a jam forces have no bound: it is come to by
    halves, however short.
    """
    result, search, shortest = work.result[0], work.search[0], dt <= SHORTEST * controls.step
    jams = search.active == 1 and search.kind == JAM
    if search.active == 1 and shortest and not jams:
        return False, 0
    if held.count[0] == 0:
        result.unnamed = 0.0
    off, grows = imbalance(system, held, start, end, named, clock.now, dt, watch)
    result.unnamed = max(result.unnamed, off)
    cut = grows or off > (CAREFUL if careful else 1.0)
    if (cut and not shortest) or (grows and jams):
        return True, 0
    if off > 1.0:
        watch.share *= WIDER
    watch.gains = watch.gains + 1 if grows else 0
    return False, watch.gains


@kernel
def change_mode(system, held, i, kind, now, work, clock, records):
    """Carry out the event of a held point; return what is left to do."""
    if kind == REVERSE:
        return SETTLE
    hold = held.points[i]
    if kind == JAM:
        k = held_value(system, hold, JAM, 0.0, 0.0, now, work) + JAMMED * hold.W[0, 0]
        if presses(hold, k):
            note_jam(held, hold)
            return NOTHING
        kind = SEPARATE
    begin_event(system, hold.contact, hold.feature, now, clock, records)
    if kind == SEPARATE:
        strike_off(held, i)
        regroup(system, held, work)
        end_event(system, r.OPENS, now, clock, records)
    elif kind == CONE:
        hold.mode = SLIP
        end_event(system, r.SLIPS, now, clock, records)
    return NOTHING


@kernel
def turn_modes(system, controls, held, now, work, clock, records):
    """Take over the modes that a step of several held points has ended with, and the residual of the step."""
    changed = False
    clock.residual = max(
        clock.residual, max(residual(system, held, now, work), work.result[0].residual)
    )
    for i in range(held.count[0] - 1, -1, -1):
        hold = held.points[i]
        if hold.several == 0 or hold.rest == 1:
            continue
        if hold.settles == 1:
            hold.rest = system.bodies[hold.body].ballistic
            if hold.other >= 0:
                hold.rest = min(hold.rest, system.bodies[hold.other].ballistic)
        if hold.jams == 1:
            note_jam(held, hold)
        if hold.next == hold.mode:
            changed = changed or slides_on(system, hold, now, controls.step, work)
            continue
        changed = True
        begin_event(system, hold.contact, hold.feature, now, clock, records)
        if hold.next == OPEN:
            strike_off(held, i)
            end_event(system, r.OPENS, now, clock, records)
        else:
            hold.mode = hold.next
            if hold.mode == STICK:
                set_anchor(system, hold, now, work)
            end_event(system, r.STICKS if hold.mode == STICK else r.SLIPS, now, clock, records)
    if refresh_pairs(system, controls, held, now, work) or changed:
        regroup(system, held, work)


@inlined
def accept(now, end, tau, applied, friction, begin, clock):
    """Make `end` the present state, a time tau later."""
    for b in range(now.shape[0]):
        keep(end[b], now[b])
    before = clock.now
    clock.spent += tau
    clock.now = begin + clock.spent
    clock.loads += applied
    clock.friction += friction
    clock.owed = max(0.0, clock.owed + friction)
    if clock.now > before:
        clock.at_once = 0
