"""A step of all bodies as one island: its start is stored, so that it can be repeated in another way."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.contact.point_lists import mark
from carom.dynamics.explicit import copy_state
from carom.persistent.active_set import regroup
from carom.stepping.islands.parts import give_up_body


@kernel
def begin_single(system, active, now, clocks, work, start):
    """Begin a step, unless it has begun already."""
    if start.begun[0] == 1:
        return
    clock, step = clocks[0], work.step[0]
    step.first_touch, step.first_event, step.tries, step.whole = 0, clock.event, 0, 0
    work.pair.state[0].searches = 0
    step.impacts, step.owed = clock.impacts, 0.0
    if start.state.shape[0] == 0:  # the step is never repeated in another way
        return
    for c in range(active.contact_states.shape[0]):
        start.contact_states[c] = active.contact_states[c]
    for b in range(now.shape[0]):
        copy_state(now[b], start.state[b])
    for i in range(active.count[0]):
        start.points[i] = active.points[i]
    memory = system.relations.memory
    copy_memory(memory.coordinates, memory.frictions, start.turns, start.frictions)
    start.count[0], start.begun[0] = active.count[0], 1
    start.clock[0] = clocks[0]


@kernel
def copy_memory(turns, frictions, kept_turns, kept_frictions):
    """Copy what a step of joints goes on from."""
    for i in range(turns.shape[0]):
        kept_turns[i] = turns[i]
    for i in range(frictions.shape[0]):
        kept_frictions[i] = frictions[i]


@kernel
def give_up_single(controls, number, work):
    """Give all bodies time-stepping steps, `number` and some more; return False if they have them already."""
    if work.body[0].whole_until > number:
        return False
    for b in range(work.body.shape[0]):
        give_up_body(controls, number, work.step[0], work.body[b])
    return True


@kernel
def forget_single(system, active, now, clocks, work, start):
    """Go back to the start of the step and drop all its results."""
    mark_vertices(active, 0)
    for c in range(active.contact_states.shape[0]):
        active.contact_states[c] = start.contact_states[c]
    for b in range(now.shape[0]):
        copy_state(start.state[b], now[b])
    active.count[0] = start.count[0]
    for i in range(active.count[0]):
        active.points[i] = start.points[i]
    mark_vertices(active, 1)
    clocks[0] = start.clock[0]
    work.step[0].spent, work.step[0].paused, start.begun[0] = 0.0, 0, 0
    memory = system.relations.memory
    copy_memory(start.turns, start.frictions, memory.coordinates, memory.frictions)
    work.search[0].pending = 0
    regroup(system, active, work)


@kernel
def mark_vertices(active, carries):
    """Write `carries` for the vertices that are active."""
    for i in range(active.count[0]):
        mark(active, active.points[i], carries)
