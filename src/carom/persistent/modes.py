"""Events of persistent contacts carried out: a point opens, slips, sticks, turns or jams."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.dynamics.acceleration import OPEN, SLIP, STICK
from carom.model import records as r
from carom.model.actions import NOTHING, SETTLE
from carom.model.event_rows import begin_event, end_event
from carom.persistent.active_set import refresh_pairs, regroup, set_anchor, strike_off
from carom.persistent.events import CONE, JAM, REVERSE, SEPARATE, held_value, residual, slides_on
from carom.persistent.jam import JAMMED, note_jam, presses


@kernel
def change_mode(model, data, i, kind):
    """Carry out the event of a held point; return what is left to do."""
    system = model.system
    held, now, work, clock, records = data.held, data.state, data.work, data.clocks[0], data.records
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
def turn_modes(model, data):
    """Take over the modes that a step of several held points has ended with, and the residual of the step."""
    system, controls = model.system, model.controls
    held, now, work, clock, records = data.held, data.state, data.work, data.clocks[0], data.records
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
