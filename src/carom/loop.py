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
from carom.motion.acceleration import OPEN, SLIP
from carom.motion.project import project_velocity
from carom.motion.step import step
from carom.system import records as r

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
def run(system, method, controls, held, now, work, clock, records, until):
    """Go on from `now` to step number `until`. Returns 0, `records.FULL`, or the number of a `Status`."""
    count, time = clock.count, clock.time
    while count[r.STEP] < until:
        begin = count[r.STEP] * controls.step
        length = min(controls.step, controls.duration - begin)
        while time[r.SPENT] < length:
            if count[r.STRUCK] >= records.impact.shape[0] - 1:
                return r.FULL
            code = advance(
                system, method, controls, held, now, begin, length, work, clock, records
            )
            if code != 0:
                return code
            if count[r.IN_STEP] > controls.max_impacts:
                return TOO_MANY
            if count[r.AT_ONCE] > 200:
                return CORNER
        time[r.SPENT] = 0.0
        count[r.STEP] += 1
        count[r.IN_STEP] = 0
        time[r.NOW] = begin + length
        if not finite(now):
            return NOT_FINITE
        if count[r.STEP] % controls.save_every == 0 or count[r.STEP] == controls.last:
            save(system, held, now, clock, records)
    return 0


@kernel
def finite(state):
    """Return whether the state is made of numbers."""
    s = 0.0
    for b in range(state.x.shape[0]):
        for k in range(3):
            s += state.x[b, k] + state.v[b, k] + state.w[b, k]
        s += state.Q[b, 0]
    return math.isfinite(s)


@kernel
def save(system, held, now, clock, records):
    """Write the present state into the next row."""
    k = clock.count[r.SAVED]
    records.t[k] = clock.time[r.NOW]
    records.x[k], records.Q[k], records.v[k], records.w[k] = now.x, now.Q, now.v, now.w
    for i in range(clock.ledger.size):
        records.ledger[k, i] = clock.ledger[i]
    for c in range(held.mode.size):
        records.mode[k, c] = held.mode[c]
        for i in range(3):
            records.force[k, c, i] = held.force[c, i] if held.mode[c] != OPEN else 0.0
    clock.count[r.SAVED] += 1


@kernel
def accept(system, held, now, end, tau, applied, friction, begin, clock):
    """Make `end` the present state, a time tau later."""
    for b in range(now.x.shape[0]):
        for k in range(3):
            now.x[b, k], now.v[b, k], now.w[b, k] = end.x[b, k], end.v[b, k], end.w[b, k]
        for k in range(4):
            now.Q[b, k] = end.Q[b, k]
    clock.time[r.SPENT] += tau
    clock.time[r.NOW] = begin + clock.time[r.SPENT]
    clock.ledger[r.LOADS] += applied
    clock.ledger[r.FRICTION] += friction
    if tau > 0.0:
        clock.count[r.AT_ONCE] = 0


@kernel
def advance(system, method, controls, held, now, begin, length, work, clock, records):
    """Go on to the next event, or to the end of the step."""
    remaining = length - clock.time[r.SPENT]
    horizon = remaining if controls.location == LOCATE else controls.step
    code, struck = look_near(system, controls, held, now, horizon, work, clock, records)
    if code != 0 or struck:
        return code
    dt, cuts = remaining, 0
    while True:
        applied, friction, code = step(system, method, held, now, dt, work.trial, work)
        clock.count[r.TRIALS] += 1
        if code != 0:
            return code
        verdict, kind, c, low, d1, d2 = examine(system, controls, held, now, dt, work)
        if verdict == UNSURE:
            cuts += 1
            clock.count[r.CUTS] += 1
            if cuts > controls.max_cuts:
                return STEP_CUT
            dt *= 0.5
            continue
        if verdict == CLEAR:
            accept(system, held, now, work.trial, dt, applied, friction, begin, clock)
            if dt == remaining:
                clock.time[r.SPENT] = length
            return 0
        break
    if kind == GAP and controls.location != LOCATE:
        accept(system, held, now, work.trial, dt, applied, friction, begin, clock)
        if dt == remaining:
            clock.time[r.SPENT] = length
        return bring_back(system, controls, held, c, now, horizon, work, clock, records)
    return to_event(
        system, method, controls, held, kind, c, d1, d2, now, low, dt, begin, work, clock, records,
        horizon,
    )  # fmt: skip


@kernel
def look_near(system, controls, held, now, horizon, work, clock, records):
    """Deal with open contacts that are closed already: at the start, and after an event.

    Returns a status, and whether a velocity changed.
    """
    for c in range(held.mode.size):
        if held.near[c] == 0:
            continue
        held.near[c] = 0
        if held.mode[c] != OPEN:
            continue
        tie = controls.tie * system.contacts.size[c]
        rho, rate = strike_point(system, c, now.x, now.Q, now.v, now.w, tie, work.point)
        if rho > tie:
            continue
        still = slow(system, c, now.x, now.v, now.w)
        if rate < -still:
            if controls.location == LOCATE:
                return strike(system, controls, held, c, now, horizon, work, clock, records), True
            return (
                bring_back(system, controls, held, c, now, horizon, work, clock, records),
                True,
            )
        if rate <= still:
            for k in range(3):
                held.point[c, k] = work.point[k]
            if try_hold(system, controls, held, c, now, horizon, work, clock):
                return 0, True
            held.leaving[c] = 1
    return 0, False


@kernel
def examine(system, controls, held, now, dt, work):
    """Look at the step from `now` to work.trial: verdict, event, contact, a time before it, slip."""
    found, which, low = CLEAR, -1, 0.0
    for c in range(held.mode.size):
        tie = controls.tie * system.contacts.size[c]
        verdict, first = passage(system, held, c, now, work.trial, dt, work, controls.gap, tie)
        if verdict == UNSURE:
            return UNSURE, GAP, c, 0.0, 0.0, 0.0
        if verdict == BELOW and found == CLEAR:
            found, which, low = BELOW, c, 0.5 * first
        elif verdict == CLEAR and held.leaving[c] == 1 and first > 0.0:
            held.leaving[c] = 0
    if found == BELOW:
        return BELOW, GAP, which, low, 0.0, 0.0
    kind, c, d1, d2 = find_held_event(system, held, now, work.trial, work)
    if c >= 0:
        return BELOW, kind, c, 0.0, d1, d2
    return CLEAR, GAP, -1, 0.0, 0.0, 0.0


@kernel
def to_event(
    system, method, controls, held, kind, c, d1, d2, now, low, high, begin, work, clock, records,
    horizon,
):  # fmt: skip
    """Locate the event, make sure that none comes before it, and carry it out."""
    applied, friction = 0.0, 0.0
    for _ in range(2 * controls.max_cuts):
        tau, applied, friction, code = locate(
            system, method, controls, held, kind, c, d1, d2, now, low, high, work, clock
        )
        clock.count[r.LOCATED] += 1
        if code != 0:
            return code
        verdict, other_kind, other, low, e1, e2 = examine(system, controls, held, now, tau, work)
        if verdict == BELOW and other != c and tau > 0.0:
            kind, c, d1, d2, high = other_kind, other, e1, e2, tau
            continue
        if verdict == UNSURE and tau > 1e-9 * horizon:
            # something may lie before: stop half-way, the next step starts from there
            clock.count[r.CUTS] += 1
            tau *= 0.5
            applied, friction, code = step(system, method, held, now, tau, work.trial, work)
            if code != 0:
                return code
            verdict, other_kind, other, low, e1, e2 = examine(
                system, controls, held, now, tau, work
            )
            if verdict == CLEAR:
                accept(system, held, now, work.trial, tau, applied, friction, begin, clock)
                return 0
            if verdict == BELOW:
                kind, c, d1, d2, high = other_kind, other, e1, e2, tau
            else:
                high = tau
                kind, c = GAP, other
            continue
        accept(system, held, now, work.trial, tau, applied, friction, begin, clock)
        horizon = max(horizon - tau, 0.0)
        if kind == GAP:
            return land(system, controls, held, c, now, horizon, work, clock, records)
        return change_mode(system, held, kind, c, d1, d2, now, work, clock)
    return STEP_CUT


@kernel
def land(system, controls, held, c, now, horizon, work, clock, records):
    """Polish a located contact by the return map, and strike."""
    tie = controls.tie * system.contacts.size[c]
    tolerance = max(controls.gap * system.contacts.size[c], round_off(system, c, now.x))
    rho, _ = strike_point(system, c, now.x, now.Q, now.v, now.w, tie, work.point)
    if rho < -tolerance:
        if return_map(system, c, now.x, now.Q, work.middle, work, tie, tolerance) < 0:
            return RETURN_MAP
    strike_point(system, c, now.x, now.Q, now.v, now.w, tie, work.point)
    code = strike(system, controls, held, c, now, horizon, work, clock, records)
    held.near[c] = 1
    if controls.layer_time == 1 and code == 0:
        add_layer_time(clock, records)
    return code


@kernel
def add_layer_time(clock, records):
    """Let the last impact take its time on the clock (the position stays)."""
    k = clock.count[r.STRUCK] - 1
    if k >= 0:
        clock.time[r.SPENT] += records.impact[k, r.DURATION]


@kernel
def bring_back(system, controls, held, c, now, horizon, work, clock, records):
    """The paper's way: the step has left the manifold; map back to the boundary, then strike."""
    tie = controls.tie * system.contacts.size[c]
    tolerance = max(controls.gap * system.contacts.size[c], round_off(system, c, now.x))
    height = restore_work(system, now, work, 0.0, c, True)
    if return_map(system, c, now.x, now.Q, work.middle, work, tie, tolerance) < 0:
        return RETURN_MAP
    if system.joints.kind.size > 0:  # the velocity block again, with the position now fixed
        project_velocity(system, now.x, now.Q, now.v, now.w, work)
    strike_point(system, c, now.x, now.Q, now.v, now.w, tie, work.point)
    if controls.location == WORK:
        restore_work(system, now, work, height, c, False)
    code = strike(system, controls, held, c, now, horizon, work, clock, records)
    for i in range(held.near.size):
        held.near[i] = 1
    return code


@kernel
def change_mode(system, held, kind, c, d1, d2, now, work, clock):
    """Carry out the event of a held contact."""
    if kind == SEPARATE:
        held.mode[c] = OPEN
        held.leaving[c] = 1
        return 0
    if kind == CONE:
        held.mode[c] = SLIP
        return 0
    u1, u2 = slip(system, held, c, now)
    across = abs(u1 * d2 - u2 * d1)
    # slip has stopped if nothing is left across either; the scale is the slip one step would make
    f = held.force[c]
    stop = 1e-3 * clock.time[r.SPENT] * math.sqrt(f[0] * f[0]) * work.W[c, 1, 1]
    if across <= stop:
        settle(system, held, c, now, 2.0 * stop + across, work, clock)
    return 0


