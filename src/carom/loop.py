"""The loop of a run, compiled as a whole: free steps, events, impacts, held contacts, records."""

from __future__ import annotations

import math
from typing import NamedTuple

from carom.contact.exclude import BELOW, CLEAR, UNSURE, passage
from carom.contact.gap import round_off, slow, strike_point
from carom.contact.locate import locate
from carom.contact.return_map import return_map
from carom.contact.strike import strike
from carom.contact.work_mode import restore_work
from carom.hold.events import CONE, GAP, SEPARATE, find_held_event, slip
from carom.hold.lifecycle import settle, try_hold
from carom.jit import kernel
from carom.motion.acceleration import OPEN, SLIP, STICK
from carom.motion.explicit import keep
from carom.motion.forces import potential_energy
from carom.motion.project import project_velocity
from carom.motion.step import step
from carom.system import records as r
from carom.system.notes import begin_event, end_event

LOCATE, PROJECT, WORK = range(3)
STEP_CUT, TOO_MANY, NOT_FINITE, RETURN_MAP, CORNER = 2, 3, 4, 5, 8


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
    layer: int  # 1: impacts through the boundary layer by splines
    layer_steps: int
    layer_time: int  # 1: add the duration of impacts to the clock
    max_impacts: int
    max_cuts: int


@kernel
def run(system, method, controls, held, now, work, clocks, records, until):
    """Go on from `now` to step number `until`. Returns 0, `records.FULL`, or the number of a `Status`."""
    clock = clocks[0]
    while clock.step < until:
        begin = clock.step * controls.step
        length = min(controls.step, controls.duration - begin)
        while clock.spent < length:
            if clock.event >= records.event.shape[0] - 4:
                return r.FULL
            code = advance(
                system, method, controls, held, now, begin, length, work, clock, records
            )
            if code != 0:
                return code
            if clock.in_step > controls.max_impacts:
                return TOO_MANY
            if clock.at_once > 200:
                return CORNER
        clock.spent = 0.0
        clock.step += 1
        clock.in_step = 0
        clock.now = begin + length
        if not finite(now):
            return NOT_FINITE
        if clock.step % controls.save_every == 0 or clock.step == controls.last:
            save(held, now, clock, records)
    return 0


@kernel
def finite(state):
    """Return whether the state is made of numbers."""
    s = 0.0
    for b in range(state.shape[0]):
        for k in range(3):
            s += state[b].x[k] + state[b].v[k] + state[b].w[k]
        s += state[b].Q[0]
    return math.isfinite(s)


@kernel
def save_first(held, now, clocks, records):
    """Write the state at the start."""
    save(held, now, clocks[0], records)


@kernel
def save(held, now, clock, records):
    """Write the present state into the next row."""
    k = clock.saved
    row = records.series[k]
    row.t = clock.now
    row.loads, row.impacts = clock.loads, clock.impacts
    row.friction, row.bounces = clock.friction, clock.bounces
    for b in range(now.shape[0]):
        keep(now[b], records.state[k, b])
    for c in range(held.shape[0]):
        touch = records.touch[k, c]
        touch.mode = held[c].mode
        for i in range(3):
            touch.force[i] = held[c].force[i] if held[c].mode != OPEN else 0.0
            touch.point[i] = held[c].point[i]
    clock.saved += 1


@kernel
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


@kernel
def advance(system, method, controls, held, now, begin, length, work, clock, records):
    """Go on to the next event, or to the end of the step."""
    remaining = length - clock.spent
    horizon = remaining if controls.location == LOCATE else controls.step
    code, struck = look_near(system, controls, held, now, horizon, work, clock, records)
    if code != 0 or struck:
        return code
    dt, cuts = remaining, 0
    while True:
        applied, friction, code = step(system, method, held, now, dt, work.trial, work)
        clock.trials += 1
        if code != 0:
            return code
        verdict, kind, c, low, d1, d2 = examine(system, controls, held, now, dt, work)
        if verdict == UNSURE:
            cuts += 1
            clock.cuts += 1
            if cuts > controls.max_cuts:
                return STEP_CUT
            dt *= 0.5
            continue
        if verdict == CLEAR or (kind == GAP and controls.location != LOCATE):
            accept(now, work.trial, dt, applied, friction, begin, clock)
            if dt == remaining:
                clock.spent = length
            if verdict == CLEAR:
                return 0
            return bring_back(system, controls, held, c, now, horizon, work, clock, records)
        return to_event(
            system, method, controls, held, kind, c, d1, d2, now, low, dt, begin, horizon, work,
            clock, records,
        )  # fmt: skip


@kernel
def look_near(system, controls, held, now, horizon, work, clock, records):
    """Deal with open contacts that are closed already: at the start, and after an event.

    Returns a status, and whether a velocity changed.
    """
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
            if controls.location == LOCATE:
                code = strike(system, controls, held, c, now, horizon, work, clock, records)
            else:
                code = bring_back(system, controls, held, c, now, horizon, work, clock, records)
            hold.near = 1
            return code, True
        if rate <= still:
            for k in range(3):
                hold.point[k] = point[k]
            if try_hold(system, controls, held, c, now, horizon, work, clock, records):
                return 0, True
            hold.leaving = 1
    return 0, False


@kernel
def examine(system, controls, held, now, dt, work):
    """Look at the step from `now` to work.trial: verdict, event, contact, a time before it, slip."""
    found, which, low = CLEAR, -1, 0.0
    for c in range(held.shape[0]):
        contact = system.contacts[c]
        tie = controls.tie * contact.extent
        verdict, first = passage(
            system, contact, held[c], now, work.trial, dt, work, controls.gap, tie
        )
        if verdict == UNSURE:
            return UNSURE, GAP, c, 0.0, 0.0, 0.0
        if verdict == BELOW and found == CLEAR:
            found, which, low = BELOW, c, 0.5 * first
        elif verdict == CLEAR and held[c].leaving == 1 and first > 0.0:
            held[c].leaving = 0
    if found == BELOW:
        return BELOW, GAP, which, low, 0.0, 0.0
    kind, c, d1, d2 = find_held_event(system, held, now, work.trial, work)
    if c >= 0:
        return BELOW, kind, c, 0.0, d1, d2
    return CLEAR, GAP, -1, 0.0, 0.0, 0.0


@kernel
def to_event(
    system, method, controls, held, kind, c, d1, d2, now, low, high, begin, horizon, work, clock,
    records,
):  # fmt: skip
    """Locate the event, make sure that none comes before it, and carry it out."""
    for _ in range(2 * controls.max_cuts):
        tau, applied, friction, code = locate(
            system, method, controls, held, kind, c, d1, d2, now, low, high, work, clock
        )
        clock.located += 1
        if code != 0:
            return code
        verdict, other_kind, other, low, e1, e2 = examine(system, controls, held, now, tau, work)
        if verdict == BELOW and other != c and tau > 0.0:
            kind, c, d1, d2, high = other_kind, other, e1, e2, tau
            continue
        if verdict == UNSURE and tau > 1e-9 * horizon:
            # something may lie before: look at the first half, and go on from there
            clock.cuts += 1
            high = 0.5 * tau
            applied, friction, code = step(system, method, held, now, high, work.trial, work)
            clock.trials += 1
            if code != 0:
                return code
            verdict, kind, c, low, d1, d2 = examine(system, controls, held, now, high, work)
            if verdict == CLEAR:
                accept(now, work.trial, high, applied, friction, begin, clock)
                return 0
            if verdict == BELOW:
                continue
            return halve(system, method, controls, held, now, high, begin, work, clock)
        accept(now, work.trial, tau, applied, friction, begin, clock)
        if kind == GAP:
            left = max(horizon - tau, 0.0)
            return land(system, controls, held, c, now, left, work, clock, records)
        return change_mode(system, controls, held, kind, c, d1, d2, now, work, clock, records)
    return STEP_CUT


@kernel
def halve(system, method, controls, held, now, dt, begin, work, clock):
    """Go on by the first part of a step that is surely clear, halving dt until one is."""
    for _ in range(controls.max_cuts):
        dt *= 0.5
        clock.cuts += 1
        clock.trials += 1
        applied, friction, code = step(system, method, held, now, dt, work.trial, work)
        if code != 0:
            return code
        if examine(system, controls, held, now, dt, work)[0] == CLEAR:
            accept(now, work.trial, dt, applied, friction, begin, clock)
            return 0
    return STEP_CUT


@kernel
def land(system, controls, held, c, now, horizon, work, clock, records):
    """Polish a located contact by the return map, and strike."""
    contact = system.contacts[c]
    tie, point = controls.tie * contact.extent, work.hit[0].point
    tolerance = max(controls.gap * contact.extent, round_off(contact, now))
    rho, _ = strike_point(contact, system.vertices, now, tie, point)
    if rho < -tolerance:
        if return_map(system, contact, now, work, tie, tolerance) < 0:
            return RETURN_MAP
        strike_point(contact, system.vertices, now, tie, point)
    struck = clock.struck
    code = strike(system, controls, held, c, now, horizon, work, clock, records)
    held[c].near = 1
    if controls.layer_time == 1 and code == 0 and clock.struck > struck:
        clock.spent += records.impact[struck].duration  # the position stays
    return code


@kernel
def bring_back(system, controls, held, c, now, horizon, work, clock, records):
    """The paper's way: the step has left the manifold; map back to the boundary, then strike."""
    contact = system.contacts[c]
    tie, point = controls.tie * contact.extent, work.hit[0].point
    tolerance = max(controls.gap * contact.extent, round_off(contact, now))
    before = potential_energy(system, now)
    if return_map(system, contact, now, work, tie, tolerance) < 0:
        return RETURN_MAP
    if system.joints.shape[0] > 0:  # the velocity block again, with the position now fixed
        project_velocity(system, now, work)
    strike_point(contact, system.vertices, now, tie, point)
    if controls.location == WORK:
        restore_work(system, contact, now, before - potential_energy(system, now), work)
    code = strike(system, controls, held, c, now, horizon, work, clock, records)
    for i in range(held.shape[0]):
        held[i].near = 1
    return code


@kernel
def change_mode(system, controls, held, kind, c, d1, d2, now, work, clock, records):
    """Carry out the event of a held contact."""
    hold = held[c]
    begin_event(c, now, clock, records)
    if kind == SEPARATE:
        hold.mode = OPEN
        hold.leaving = 1
        end_event(r.OPENS, now, clock, records)
    elif kind == CONE:
        hold.mode = SLIP
        end_event(r.SLIPS, now, clock, records)
    else:
        u1, u2 = slip(system.contacts[c], hold, now)
        across = abs(u1 * d2 - u2 * d1)
        # slip has stopped if nothing is left across either; the scale is what friction does in a step
        stop = 1e-3 * controls.step * abs(hold.force[0]) * hold.W[1, 1]
        if across <= stop:
            settle(system, held, c, now, 2.0 * stop + across, work, clock)
            end_event(r.STICKS if hold.mode == STICK else r.SLIPS, now, clock, records)
    return 0
