"""A step of all bodies as one island: its start is kept, so that it can be done again another way."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.dynamics.explicit import keep
from carom.dynamics.more_forces import begin_turns, forget_turns
from carom.persistent.active_set import regroup
from carom.persistent.joint_events import review_joints
from carom.stepping.islands.parts import tire_body


@kernel
def begin_together(system, held, now, clocks, start):
    """Begin a step, unless it has begun already."""
    if start.begun[0] == 1:
        return
    clock = clocks[0]
    clock.first_touch, clock.tries, clock.effort = 0, 0, 0.0
    clock.before = clock.impacts
    if start.state.shape[0] == 0:  # it is not done in another way
        return
    for c in range(held.brinks.shape[0]):
        held.brinks[c].blows = 0
        start.brinks[c] = held.brinks[c]
    for b in range(now.shape[0]):
        keep(now[b], start.state[b])
    for i in range(held.count[0]):
        start.points[i] = held.points[i]
    begin_turns(system)
    start.count[0], start.begun[0] = held.count[0], 1
    start.clock[0] = clocks[0]


@kernel
def tire_together(step, work):
    """Have all bodies take this step and some more whole; return False if they do."""
    if work.body[0].whole_until > step:
        return False
    for b in range(work.body.shape[0]):
        tire_body(work.body[b], step)
    return True


@kernel
def forget_together(system, held, now, clocks, work, start):
    """Go back to the start of the step, as if nothing had happened in it."""
    mark_vertices(held, 0)
    for c in range(held.brinks.shape[0]):
        held.brinks[c] = start.brinks[c]
    for b in range(now.shape[0]):
        keep(start.state[b], now[b])
    held.count[0] = start.count[0]
    for i in range(held.count[0]):
        held.points[i] = start.points[i]
    mark_vertices(held, 1)
    clocks[0] = start.clock[0]
    start.begun[0] = 0
    forget_turns(system)
    work.search[0].pending = 0
    regroup(system, held, work)
    review_joints(system, held, now, work)


@kernel
def mark_vertices(held, carries):
    """Note for the vertices that are held whether they carry."""
    for i in range(held.count[0]):
        if held.points[i].touches == 0:
            held.carries[held.points[i].feature] = carries
