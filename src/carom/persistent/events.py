"""Events that are located: a point opens, friction does not suffice for stick, slip jams.

The function of an event is positive before it and negative after it, and is evaluated at the end of a step:

    EVENT_SEPARATE   the margin before opening        (`carom.persistent.margins`)
    EVENT_CONE       the margin before slip
    EVENT_JAM        k                                while slipping (`carom.persistent.jam`)
    EVENT_BREAK      the margin before slip           of a joint
    EVENT_STOP       the least part of a slip that is left, with given steps  (`carom.persistent.stops`)
    EVENT_KINK       the margin before a kink of the law (`carom.law.piecewise`)
"""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom.law.piecewise import any_depends_on_speed
from carom.model.actions import (
    EVENT_BREAK,
    EVENT_CONE,
    EVENT_GAP,
    EVENT_JAM,
    EVENT_KINK,
    EVENT_KINK_OF_JOINT,
    EVENT_SEPARATE,
    EVENT_STOP,
    MODE_OPEN,
    MODE_SLIP,
)
from carom.persistent.jam import jam_margin
from carom.persistent.margins import margin
from carom.persistent.stops import least_left


@kernel
def contact_event_value(system, active_point, kind):
    """Return the event function `kind` with the forces of the end of the step."""
    return jam_margin(system, active_point) if kind == EVENT_JAM else margin(active_point, kind)


@inlined
def note_first_stops(system, active):
    """Keep the times to the stops at the start of a step: its trial steps write those of their ends."""
    for i in range(active.count[0]):
        active_point = active.points[i]
        first, turns = active_point.first_stop, active_point.turn_stop
        first[0], first[1], first[2] = active_point.stop, turns[0], turns[1]
    frictions = system.relations.memory.frictions
    for i in range(frictions.shape[0]):
        frictions[i].first_stop[0], frictions[i].mode = frictions[i].stop, frictions[i].next


@inlined
def find_contact_event(system, active, work):
    """Return (event, index) of the first active point whose mode ends; index -1 if there is none."""
    if work.search[0].eager == 0:
        return EVENT_GAP, -1
    for i in range(active.count[0]):
        active_point = active.points[i]
        if active_point.mode == MODE_OPEN or active_point.rest == 1:
            continue
        slips = active_point.mode == MODE_SLIP and active_point.next == MODE_SLIP
        if active_point.shares == 0 and slips and jam_margin(system, active_point) <= 0.0:
            return EVENT_JAM, i
        if active_point.lift < 0.0:
            return EVENT_SEPARATE, i
        if active_point.grip < 0.0:
            return EVENT_CONE, i
    frictions = system.relations.memory.frictions
    for i in range(frictions.shape[0]):
        if frictions[i].grip < 0.0:
            return EVENT_BREAK, i
        if frictions[i].kink[1] < 0.0:
            return EVENT_KINK_OF_JOINT, i
    for i in range(active.count[0] if any_depends_on_speed(system.laws) else 0):
        if active.points[i].kink[1] < 0.0:
            return EVENT_KINK, i
    if least_left(system, active, work) < 0.0:
        return EVENT_STOP, 0
    return EVENT_GAP, -1
