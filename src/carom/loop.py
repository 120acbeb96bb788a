"""The loop of a run, compiled as a whole: free steps, events, impacts, held contacts, records.

Written so that each large part (step, strike, hold) is called from one place: what Numba compiles it
compiles again into each of its callers.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from carom.contact.exclude import CLEAR, UNSURE, greatest_acceleration
from carom.contact.gap import slow, strike_point
from carom.hold.events import CONE, GAP, REVERSE, SEPARATE, end_forces
from carom.hold.lifecycle import hold_contact
from carom.hold.search import begin_search, event_value, examine, narrow, propose
from carom.impact.strike import strike
from carom.jit import entry, inlined, kernel
from carom.motion.acceleration import OPEN, SLIP
from carom.motion.contact_point import contact_arm, contact_velocity
from carom.motion.explicit import keep
from carom.motion.step import step
from carom.system import records as r
from carom.system.notes import begin_event, end_event

LOCATE, PROJECT, WORK = range(3)
STEP_CUT, TOO_MANY, NOT_FINITE, CORNER = 2, 3, 4, 8
NOTHING, STRIKE, HOLD, SETTLE = range(4)


class Controls(NamedTuple):
    """Settings of a run, as numbers."""

    step: float
    duration: float
    location: int  # LOCATE, PROJECT or WORK
    save_every: int
    last: int  # number of the last step
    gap: float  # tolerance of a located gap, relative to the body
    tie: float  # vertices this near the lowest strike together, relative to the body
    hold: int
    layer_steps: int
    layer_time: int  # 1: add the duration of impacts to the clock
    max_impacts: int
    max_cuts: int
    strike_at: int  # addresses of two units
    hold_at: int


@entry
def run(system, method, controls, held, now, work, clocks, records, until):
    """Go on from `now` to step number `until`. Returns 0, `records.FULL`, or the number of a `Status`."""
    clock, search, trial = clocks[0], work.search[0], work.trial
    while clock.step < until:
        begin = clock.step * controls.step
        length = min(controls.step, controls.duration - begin)
        while clock.spent < length:
            if clock.event >= records.event.shape[0] - 4:
                return r.FULL
            if clock.in_step > controls.max_impacts or clock.at_once > 200:
                return CORNER if clock.released > 10 else TOO_MANY
            remaining = length - clock.spent
            horizon = remaining if controls.location == LOCATE else controls.step
            action, c = search.pending, search.contact
            if action != NOTHING:  # what was put off until its unit was compiled
                horizon = search.horizon
                search.pending = NOTHING
            else:
                action, c = look_near(system, controls, held, now, work)
            if action == NOTHING:
                # a trial step, cut until nothing can lie inside it, or shortened to its first event
                dt, cuts, found = remaining, 0, False
                search.active = 0
                while True:
                    applied, friction, code = step(method, system, held, now, dt, trial, work)
                    clock.trials += 1
                    if code != 0:
                        return code
                    end_forces(system, held, trial, work)
                    if search.active == 1:
                        f, rate = event_value(system, controls, held, search, trial, work)
                        state = narrow(search, dt, f, rate)
                        if state < 0:
                            return NOT_FINITE
                        if state == 0:
                            dt = propose(search)
                            continue
                    verdict, kind, other, low, d1, d2 = examine(
                        system, controls, held, now, dt, work
                    )
                    own = search.active == 1 and other == search.contact
                    if verdict == CLEAR or (own and verdict != UNSURE):
                        found = search.active == 1
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
                        continue
                    begin_search(search, kind, other, low, dt, d1, d2)
                    if kind == GAP and controls.location != LOCATE:
                        found = True
                        break
                    f, rate = event_value(system, controls, held, search, trial, work)
                    narrow(search, dt, f, rate)
                    dt = propose(search)
                accept(now, trial, dt, applied, friction, begin, clock)
                if dt == remaining:
                    clock.spent = length
                if not found:
                    continue
                clock.located += 1
                c = search.contact
                horizon = horizon if controls.location != LOCATE else max(horizon - dt, 0.0)
                action = STRIKE
                if search.kind != GAP:
                    action = change_mode(held[c], c, search.kind, now, clock, records)
            if action == STRIKE:
                struck = clock.struck
                strike(
                    controls.strike_at, method, system, controls, held, c, now, work, clocks,
                    records,
                )  # fmt: skip
                if work.hit[0].code != 0:
                    return work.hit[0].code
                if controls.layer_time == 1 and clock.struck > struck:
                    clock.spent += records.impact[struck].duration  # the position stays
            if action == STRIKE and not may_end(
                system.contacts[c], system, held[c], now, horizon, work
            ):
                continue
            if action != NOTHING and controls.hold == 1:
                if controls.hold_at == 0:
                    search.pending, search.contact = max(action, HOLD), c
                    search.horizon = horizon
                    return r.NEEDS_HOLD
                hold_contact(
                    controls.hold_at, system, controls, held, c, now, horizon, action == SETTLE,
                    work, clocks, records,
                )  # fmt: skip
                if clock.now == 0.0:  # touching from the start: the first row says so
                    save_contacts(held, 0, records)
        clock.spent = 0.0
        clock.step += 1
        clock.in_step, clock.released = 0, 0
        clock.now = begin + length
        if not finite(now):
            return NOT_FINITE
        if clock.step % controls.save_every == 0 or clock.step == controls.last:
            save(held, now, clock, records)
    return 0


@inlined
def look_near(system, controls, held, now, work):
    """Find an open contact that is closed already, at the start or after an event: strike or hold it."""
    for c in range(held.shape[0]):
        hold, contact = held[c], system.contacts[c]
        if hold.near == 0:
            continue
        hold.near = 0
        if hold.mode != OPEN:
            continue
        tie, point = controls.tie * contact.extent, work.hit[0].point
        rho, rate = strike_point(contact, system.vertices, now, tie, point)
        if rho > tie:
            continue
        still = slow(contact, now)
        if rate < -still:
            return STRIKE, c
        if rate <= still:
            for k in range(3):
                hold.point[k] = point[k]
            hold.leaving = 1  # unless it is held now
            return HOLD, c
    return NOTHING, -1


@inlined
def may_end(contact, system, hold, state, horizon, work):
    """Return whether the bounces of a contact that was just struck could end within the horizon.

    A first look, with a bound of the acceleration where there is one, before the forces are worked out.
    """
    rx, ry, rz = contact_arm(contact, state, hold.point)
    rate = contact_velocity(contact, state, rx, ry, rz)[0]
    if rate <= slow(contact, state) or system.bodies[contact.body].ballistic == 0:
        return True
    work.body[contact.body].status = 0  # in flight again: the strike has opened its contacts
    _, most = greatest_acceleration(system, contact, state, work)
    return 2.0 * rate < most * (1.0 - contact.restitution) * horizon


@kernel
def change_mode(hold, c, kind, now, clock, records):
    """Carry out the event of a held contact; return what is left to do."""
    if kind == REVERSE:
        return SETTLE
    begin_event(c, now, clock, records)
    if kind == SEPARATE:
        hold.mode = OPEN
        hold.leaving = 1
        end_event(r.OPENS, now, clock, records)
    elif kind == CONE:
        hold.mode = SLIP
        end_event(r.SLIPS, now, clock, records)
    return NOTHING


@inlined
def finite(state):
    """Return whether the state is made of numbers."""
    s = 0.0
    for b in range(state.shape[0]):
        for k in range(3):
            s += state[b].x[k] + state[b].v[k] + state[b].w[k]
        s += state[b].Q[0]
    return math.isfinite(s)


@entry
def save_now(held, now, clocks, records):
    """Write the present state: at the start, and after a failure."""
    save(held, now, clocks[0], records)


@inlined
def save(held, now, clock, records):
    """Write the present state into the next row."""
    k = clock.saved
    row = records.series[k]
    row.t = clock.now
    row.loads, row.impacts = clock.loads, clock.impacts
    row.friction, row.bounces = clock.friction, clock.bounces
    for b in range(now.shape[0]):
        keep(now[b], records.state[k, b])
    save_contacts(held, k, records)
    clock.saved += 1


@inlined
def save_contacts(held, k, records):
    """Write modes and forces of the contacts into row k."""
    for c in range(held.shape[0]):
        touch = records.touch[k, c]
        touch.mode = held[c].mode
        for i in range(3):
            touch.force[i] = held[c].force[i] if held[c].mode != OPEN else 0.0
            touch.point[i] = held[c].point[i]


@inlined
def accept(now, end, tau, applied, friction, begin, clock):
    """Make `end` the present state, a time tau later."""
    for b in range(now.shape[0]):
        keep(end[b], now[b])
    clock.spent += tau
    clock.now = begin + clock.spent
    clock.loads += applied
    clock.friction += friction
    if tau > 0.0:
        clock.at_once = 0
