"""Writing down an event: pose, and velocities before and after, of all bodies."""

from __future__ import annotations

from carom.jit import kernel


@kernel
def begin_event(c, feature, state, clock, records):
    """Write the state before an event into the next row."""
    k = clock.event
    records.event[k].time = clock.now
    records.event[k].contact, records.event[k].feature = c, feature
    records.event[k].saved = clock.saved
    for b in range(state.shape[0]):
        row = records.snapshot[k, b]
        for i in range(3):
            row.x[i], row.v0[i], row.w0[i] = state[b].x[i], state[b].v[i], state[b].w[i]
        for i in range(4):
            row.Q[i] = state[b].Q[i]


@kernel
def end_event(kind, state, clock, records):
    """Write the velocities after the event, and close its row."""
    k = clock.event
    records.event[k].kind = kind
    for b in range(state.shape[0]):
        row = records.snapshot[k, b]
        for i in range(3):
            row.v1[i], row.w1[i] = state[b].v[i], state[b].w[i]
    clock.event += 1
    clock.in_step += 1
    clock.at_once += 1
