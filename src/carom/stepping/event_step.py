"""One step of an island, event by event: propose a step, find its first event, accept, act.

Each large part (trial step, strike, persistent contact) is called from only one place, because a linked
function is compiled once for each call.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined
from carom._compiled.units import unit
from carom.contact.gap import slow
from carom.contact.kinds.half_space import greatest_acceleration
from carom.contact.operations import due, is_fixed
from carom.dynamics.energy import kinetic_energy
from carom.dynamics.explicit import copy_state
from carom.dynamics.more_forces import note_turns
from carom.geometry.rotation import multiply, norm
from carom.impact.strike import strike
from carom.kinematics.contact_point import contact_velocity
from carom.kinematics.reach import way_of_turn
from carom.law.restitution import depends_on_approach
from carom.model import records as r
from carom.model.actions import EVENT_GAP, EVENT_STOP, NOTHING, PERSIST, PUSHED_IN, STRIKE
from carom.model.allowance import overdone, smooth_count
from carom.model.controls import LOCATE
from carom.model.laws import STRIKES
from carom.model.workspace import FREE
from carom.persistent.activation import activate_contact
from carom.persistent.bounces import horizon_of, time_of_bounces
from carom.persistent.margins import switch_due
from carom.persistent.modes import jam_point, turn_modes
from carom.persistent.step_control import goes_wild, next_pace, unsolved
from carom.persistent.thresholds import CUT_RESIDUAL, STOP_RESIDUAL
from carom.status import LEFT_CURVE, NO_CONVERGENCE, NOT_FINITE
from carom.status import TOO_MANY_IMPACTS as TOO_MANY
from carom.stepping.energy_balance import note_exchanged
from carom.stepping.record import finite, grow, room_of_touches, save_contacts
from carom.stepping.trial_step import first_event, propose_step


@unit
def advance(model, data, method) -> int:
    """Move the bodies of an island to the end of the step; return 0, or the code that `run` must return.

    Propose a step, find the first event in it, accept the motion up to there, and act on the event.
    """
    step, search = data.work.step[0], data.work.search[0]
    if not (step.spent > 0.0 or step.paused == 1 or search.pending != NOTHING):
        search.pace, search.sure = math.inf, math.inf
    while step.spent < step.length:
        code = may_go_on(model, data)
        if code != 0:
            return code
        action = due_action(model, data)
        if action == NOTHING:
            propose_step(model, data)
            code = first_event(model, data, method)
            if code != 0:
                return code
            if search.pending != NOTHING:  # points of a flat rim strike at the present position
                continue
            code, action = accept_step(model, data)
            if code != 0:
                return code
        if action != NOTHING:
            code = act(model, data, method, action)
            if code != 0:
                return code
    return 0


@inlined
def may_go_on(model, data):
    """Return 0, or the code with which the loop is left: pause, longer arrays, or a step with too much work."""
    controls, clock, step = model.controls, data.clocks[0], data.work.step[0]
    if step.since > r.LONG and step.paused == 0:
        return r.PAUSE
    if full(model.system, data, clock):
        return grow(step, r.FULL_EVENTS)
    many = clock.event - step.first_event > controls.max_impacts or clock.at_once > 1000
    if many or overdone(controls, step):
        return TOO_MANY
    return 0


@inlined
def due_action(model, data):
    """Return the action that is due before time advances: a postponed one, or one that closed points need."""
    controls, step, search = model.controls, data.work.step[0], data.work.search[0]
    search.left = step.length - step.spent
    action = search.pending
    search.pending = NOTHING
    if action != NOTHING and step.paused == 0:
        return action  # it was postponed until its unit was compiled, and keeps its horizon
    search.horizon = search.left if exact(controls) else controls.step
    if step.paused == 1:
        return NOTHING
    action, c = find_due_contact(model, data)
    if action != NOTHING:
        search.contact = c
    return action


@inlined
def exact(controls):
    """Return whether events are located, and the step ends at the horizon."""
    return controls.location == LOCATE and controls.order == 0


@inlined
def accept_step(model, data):
    """Make the trial state the present one; return a code, and the action that its event needs."""
    system, controls, work = model.system, model.controls, data.work
    active, now, clock, search = data.active, data.state, data.clocks[0], data.work.search[0]

    # if a time-stepping step is possible, it replaces this one; otherwise the run accepts larger residuals
    bearable = CUT_RESIDUAL if controls.retry == 1 else STOP_RESIDUAL
    if active.count[0] > 0 and unsolved(controls, work, bearable):
        return NO_CONVERGENCE, NOTHING
    if active.count[0] > 0 and controls.retry == 1 and goes_wild(controls, work):
        return NO_CONVERGENCE, NOTHING
    if not finite(work.trial):
        return NOT_FINITE, NOTHING

    # the motion up to the end of the trial step, and the modes at its end
    accept(system, data, search)
    if note_turns(system, now, search.dt):
        return LEFT_CURVE, NOTHING
    search.pace = next_pace(search.pace, work)
    if left_ball(system, now, search.dt, work):
        return r.LEFT_BALL, NOTHING
    if search.dt == search.left:
        work.step[0].spent = work.step[0].length
    met = search.found == 1 and search.kind != EVENT_GAP and switch_due(system, active, search)
    if search.found == 1 and search.kind == EVENT_STOP:
        clock.in_moment += 1
    if active.count[0] > 0:
        turn_modes(model, data)
    if search.found == 0:
        if controls.order > 0 and search.dt < 0.5 * search.pace:
            smooth_count(work)
        return 0, NOTHING

    # its event
    clock.located += 1
    if exact(controls):
        search.horizon = max(search.horizon - search.dt, 0.0)
    if met:
        return 0, NOTHING
    return 0, STRIKE if search.kind == EVENT_GAP else jam_point(model, data, search.contact)


@inlined
def accept(system, data, search):
    """Make the trial state the present one, and add the work done in the step."""
    now, trial, active = data.state, data.work.trial, data.active
    clock, step = data.clocks[0], data.work.step[0]
    for b in range(now.shape[0]):
        copy_state(trial[b], now[b])
    for i in range(active.count[0]):
        active.points[i].bounces = max(0.0, active.points[i].bounces - search.dt)
    before = clock.now
    step.spent += search.dt
    clock.now = step.begin + step.spent
    clock.loads += search.applied
    clock.friction += search.friction
    step.owed = max(0.0, step.owed + search.friction)
    note_exchanged(clock, kinetic_energy(system, now))
    if clock.now > before:
        clock.at_once = 0


@inlined
def act(model, data, method, action):
    """Solve the impact of an event, and make contacts persistent whose bounces have ended."""
    system, controls, work = model.system, model.controls, data.work
    clock, search = data.clocks[0], data.work.search[0]
    clock.at_once += 1
    if action == STRIKE:
        struck = clock.struck
        strike(model, data, method, search.contact)
        closed = work.hit[0].closed
        work.step[0].since += 10.0
        if work.hit[0].code != 0:
            search.pending = STRIKE if work.hit[0].code >= r.GROW else NOTHING
            return work.hit[0].code
        if controls.layer_time == 1 and clock.struck > struck:
            work.step[0].spent += data.records.impact[struck].duration  # positions do not change
        contact = system.contacts[search.contact]
        if closed == 1 and not may_end(contact, system, controls, data.state, search.horizon, work):
            return 0
    return persist(model, data) if controls.hold == 1 else 0


@inlined
def persist(model, data):
    """Make the closed points of the contact persistent, or change their modes; return a code."""
    work, clock, search = data.work, data.clocks[0], data.work.search[0]
    activate_contact(model, data, search.contact, search.horizon)
    if work.hit[0].code != 0:
        return work.hit[0].code
    if clock.now == 0.0:  # in contact from the start: write it to the first row
        clock.touched = work.step[0].first_touch
        save_contacts(model, data, 0)
    return 0


@inlined
def full(system, data, clock):
    """Return whether the records have no room for one turn of the loop."""
    records = data.records
    rows = r.MARGIN + data.active.count[0] + data.group.closed.shape[0] - data.group.idle.shape[1]
    last = max(clock.event + 1, clock.struck) + rows
    touches = clock.touched + room_of_touches(system, rows)
    if last > records.event.shape[0] or touches > records.touch.shape[0]:
        return True
    return clock.snapped + 2 * (system.bodies.shape[0] + rows) > records.snapshot.shape[0]


@inlined
def left_ball(system, now, dt, work):
    """Return whether a body may have left its ball of this step.

    It has not left it if both ends of the step are inside by the distance that a fall in this time can add.
    Of a body that has neighbours in its ball the displacement of all its points counts.
    """
    fall = norm(system.gravity)
    for b in range(now.shape[0]):
        memory, d = work.body[b], 0.0
        most = fall if system.bodies[b].ballistic == 1 else max(fall, memory.bound[0])
        bulge = 0.125 * dt * dt * most
        if not math.isfinite(memory.room):
            continue
        for k in range(3):
            d += (now[b].x[k] - memory.home[k]) ** 2
        way = math.sqrt(d) + bulge
        if not way <= memory.room:
            return True
        if memory.reach < math.inf:
            q = memory.facing
            _, x, y, z = multiply((q[0], -q[1], -q[2], -q[3]), now[b].Q)
            way += 2.0 * way_of_turn(system.bodies[b], (x, y, z))
            if not way <= memory.reach:
                return True
    return False


@inlined
def find_due_contact(model, data):
    """Find a closed point that is not active, at the start or after an event, and the action that it needs."""
    active = data.active
    for c in range(active.contact_states.shape[0]):
        contact_state = active.contact_states[c]
        if contact_state.near == 0:
            continue
        action = due(model, data, c)
        if action == NOTHING and contact_state.near == PUSHED_IN:
            action = PERSIST
        contact_state.near = 0
        if contact_state.jams == 1:
            contact_state.jams, action = 0, STRIKE
        if action == PERSIST:
            contact_state.leaving = 1  # if it does not become active now
        if action != NOTHING:
            return action, c
    return NOTHING, -1


@inlined
def may_end(contact, system, controls, state, horizon, work):
    """Return whether the bounces of a contact that has just struck, alone, could end within the horizon.

    This is a first check with a bound of the acceleration, before forces are computed.
    """
    if not is_fixed(contact):
        return True
    point = work.struck[0]
    rate = contact_velocity(system, point, state)[0]
    if rate <= slow(contact, state) or system.bodies[contact.body].ballistic == 0:
        return True
    work.body[contact.body].status = FREE
    _, most = greatest_acceleration(system, contact, state, work)
    horizon = horizon_of(system, contact, controls, most, horizon, state)
    law = contact.law[STRIKES]
    if depends_on_approach(system.laws, law):
        return time_of_bounces(system, contact, rate, most) < horizon
    return 2.0 * rate < most * (1.0 - system.laws.table[law].restitution) * horizon
