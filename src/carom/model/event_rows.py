"""Record an event: poses, and velocities before and after, of the bodies that take part."""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def begin_event(system, c, feature, state, clock, records):
    """Write the state before an event of contact c into the next rows."""
    event, k = records.event[clock.event], clock.snapped
    event.time, event.saved, event.first = clock.now, clock.saved, k
    event.contact, event.feature = system.contacts[c].number, feature
    for b in range(state.shape[0]):
        row = records.snapshot[k + b]
        row.event, row.body = clock.event, b
        for i in range(3):
            row.x[i], row.v0[i], row.w0[i] = state[b].x[i], state[b].v[i], state[b].w[i]
        for i in range(4):
            row.Q[i] = state[b].Q[i]


@kernel
def end_event(system, c, kind, state, clock, records):
    """Write the velocities after the event of contact c, and close its row.

    Only bodies of the contact, and those whose velocity has changed, keep their snapshots.
    """
    contact, k = system.contacts[c], clock.snapped
    for b in range(state.shape[0]):
        row = records.snapshot[clock.snapped + b]
        changed = b == contact.body or b == contact.other
        for i in range(3):
            row.v1[i], row.w1[i] = state[b].v[i], state[b].w[i]
            changed = changed or row.v0[i] != row.v1[i] or row.w0[i] != row.w1[i]
        if changed:
            row.body = system.bodies[b].number
            records.snapshot[k] = records.snapshot[clock.snapped + b]
            k += 1
    records.event[clock.event].kind = kind
    clock.snapped = k
    clock.event += 1
    clock.in_moment += 1
    clock.at_once += 1


@kernel
def note_event(model, data, c, feature, kind, mode):
    """Write an event of a crowd, without snapshots: states are not interpolated up to it."""
    clock = data.clocks[0]
    event = data.records.event[clock.event]
    event.time, event.saved, event.first = clock.now, clock.saved, clock.snapped
    event.contact, event.feature = model.system.contacts[c].number, feature
    event.kind, event.mode = kind, mode
    clock.event += 1
