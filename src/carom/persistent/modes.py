"""Actions of events of persistent contacts: a point opens, slips, sticks, turns or jams."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.model.actions import MODE_OPEN, NOTHING
from carom.persistent.active_set import refresh_pairs, regroup, switch
from carom.persistent.jam import jam_margin, note_jam
from carom.persistent.rows import bodies_of
from carom.persistent.thresholds import JAM_MARGIN


@kernel
def jam_point(model, data, i):
    """Handle a jam of an active point: it presses (a_n = -k N < 0), and an impact follows; or it opens.

    Return the action.
    """
    system, active, active_point = model.system, data.active, data.active.points[i]
    k = jam_margin(system, active_point) + JAM_MARGIN * active_point.W[0, 0]
    if active_point.force[0] * k > 0.0:
        note_jam(active, active_point)
        return NOTHING
    switch(system, data, i, MODE_OPEN)
    regroup(system, active, data.work)
    return NOTHING


@kernel
def turn_modes(model, data):
    """Set the modes of several active points at the end of a step, and record its residual."""
    system, active, work, clock = model.system, data.active, data.work, data.clocks[0]
    changed = False
    clock.residual = max(clock.residual, work.search[0].residual)
    for i in range(active.count[0] - 1, -1, -1):
        active_point = active.points[i]
        if active_point.rest == 1:
            continue
        if (
            active_point.comes_to_rest == 1
        ):  # a group on which only gravity and contacts act rests as a whole
            _, loaded = bodies_of(model, data, work.body[active_point.body].label)
            active_point.rest = 0 if loaded else 1
        if active_point.jams == 1:
            note_jam(active, active_point)
        if active_point.next == active_point.mode:
            continue
        changed = True
        switch(system, data, i, active_point.next)
    if refresh_pairs(system, model.controls, data) or changed:
        regroup(system, active, work)
