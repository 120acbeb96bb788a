"""A step of all bodies as one island: its start is stored, so that it can be repeated in another way."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.dynamics.explicit import copy_state
from carom.dynamics.more_forces import begin_turns, forget_turns
from carom.persistent.active_set import regroup
from carom.stepping.islands.parts import give_up_body


@kernel
def begin_single(system, active, now, clocks, work, start):
    """Begin a step, unless it has begun already."""
    if start.begun[0] == 1:
        return
    clock = clocks[0]
    clock.first_touch, clock.tries = 0, 0
    work.pair.state[0].searches = 0
    clock.before = clock.impacts
    if start.state.shape[0] == 0:  # the step is never repeated in another way
        return
    for c in range(active.contact_states.shape[0]):
        start.contact_states[c] = active.contact_states[c]
    for b in range(now.shape[0]):
        copy_state(now[b], start.state[b])
    for i in range(active.count[0]):
        start.points[i] = active.points[i]
    begin_turns(system)
    start.count[0], start.begun[0] = active.count[0], 1
    start.clock[0] = clocks[0]


@kernel
def give_up_single(controls, clock, work):
    """Give all bodies time-stepping steps, this one and some more; return False if they have them already."""
    if work.body[0].whole_until > clock.step:
        return False
    for b in range(work.body.shape[0]):
        give_up_body(controls, clock, work.body[b])
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
    start.begun[0] = 0
    forget_turns(system)
    work.search[0].pending = 0
    regroup(system, active, work)


@kernel
def mark_vertices(active, carries):
    """Write `carries` for the vertices that are active."""
    for i in range(active.count[0]):
        if active.points[i].touches == 0:
            active.carries[active.points[i].feature] = carries
