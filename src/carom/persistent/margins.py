"""Forces and margins of active points at the end of a step: their distances from opening, slip and stops.

Forces of several points need not be unique, but accelerations are. So a point opens if its normal acceleration
is positive, and slips if its tangential one is not zero. Before that, its force gives the distance:

    lift    N W_nn,  or  -a_n,               grip    (mu N - |T|) W_tt,  or  -|a_t|,

relative to the accelerations without contact forces. A zero force, or one at its cone, is no event.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.friction.layout import SLIDING
from carom.model.actions import (
    EVENT_BREAK,
    EVENT_JAM,
    EVENT_KINK,
    EVENT_KINK_OF_JOINT,
    EVENT_SEPARATE,
    EVENT_STOP,
    MODE_OPEN,
    MODE_SLIP,
    MODE_STICK,
)
from carom.model.workspace import MOTION_POINT, MOTION_ROLL
from carom.persistent.adhesion import pulled
from carom.persistent.joint_rows import greatest_load
from carom.persistent.rolling_friction import take_torque
from carom.persistent.springs import own
from carom.persistent.thresholds import EVENT_ERROR, EVENT_MARGIN, NO_MARGIN


@kernel
def greatest_push(k, group):
    """Return the greatest acceleration of the k points without contact forces.

    The result is 0 if two bodies touch at several points: the corners of their overlap appear and vanish, most
    of them without a force, so their events are handled at the end of the step.
    """
    for i in range(k):
        a = group.closed[i]
        for j in range(i if a.motion == MOTION_POINT and group.points[0][i].b != -1 else 0):
            if group.closed[j].contact == a.contact and group.closed[j].motion == MOTION_POINT:
                return 0.0
    return greatest_load(k, group)


@kernel
def time_to_stop(i, group):
    """Return the time until slip of point i stops at its present deceleration."""
    d1, d2 = group.problem.heading[i, 0], group.problem.heading[i, 1]
    speed = group.u[3 * i + 1] * d1 + group.u[3 * i + 2] * d2
    rate = group.a[3 * i + 1] * d1 + group.a[3 * i + 2] * d2
    return speed / -rate if group.problem.kind[i] == SLIDING and rate < 0.0 else math.inf


@kernel
def take_forces(active_point, i, group):
    """Write force and W of the closed point i to its active point, and when slip stops; or its torque."""
    motion = group.closed[i].motion
    if motion != MOTION_POINT:
        active_point.turn_stop[motion - MOTION_ROLL] = time_to_stop(i, group)
        take_torque(active_point, i, group)
        return
    active_point.stop, active_point.pull = time_to_stop(i, group), group.closed[i].pull
    for r in range(3):
        # a contact problem without a solution leaves forces that pull: no contact has them
        active_point.force[r] = group.p[3 * i + r] if group.p[3 * i] > 0.0 else 0.0
        for j in range(3):
            active_point.W[r, j] = group.own[3 * i + r, j]


@kernel
def set_margins(active_point, i, push, group):
    """Write lift and grip of point i; `next` is its mode at the end of the step."""
    active_point.lift, active_point.grip = 1.0, 1.0
    if not push > 0.0:
        return
    q, p, a = 3 * i, group.p, group.a
    if active_point.next == MODE_OPEN:
        active_point.lift = -max(a[q] / push, 2.0 * EVENT_ERROR)
        return
    if active_point.shares == 0:  # its force is unique: both are continuous
        active_point.lift = p[q] * own(group, q) / push if p[q] > 0.0 else -a[q] / push
    elif p[q] <= 0.0 and a[q] > NO_MARGIN * push:
        active_point.lift = -a[q] / push
    else:
        active_point.lift = max(p[q] * own(group, q) / push, EVENT_MARGIN)
    if active_point.mode == MODE_STICK:
        set_grip(active_point, i, push, group)


@kernel
def set_grip(active_point, i, push, group):
    """Write the grip of point i, which sticks at the start of the step."""
    q, p, a = 3 * i, group.p, group.a
    gain = math.sqrt(a[q + 1] ** 2 + a[q + 2] ** 2) / (push + pulled(i, group))
    if active_point.next == MODE_SLIP:
        active_point.grip = -max(gain, 2.0 * EVENT_ERROR)
    elif gain > NO_MARGIN:
        active_point.grip = -gain
    else:
        left = group.problem.mu[i] * p[q] - math.sqrt(p[q + 1] ** 2 + p[q + 2] ** 2)
        grip = left * max(own(group, q + 1), own(group, q + 2)) / push
        active_point.grip = grip if active_point.shares == 0 else max(grip, EVENT_MARGIN)


@kernel
def margin(active_point, kind):
    """Return the margin of a point from an event."""
    return active_point.lift if kind == EVENT_SEPARATE else active_point.grip


@kernel
def note_due(active, search, work):
    """Mark the points of the same group that have the event of the search within the trial step."""
    if search.kind in (EVENT_BREAK, EVENT_STOP, EVENT_KINK, EVENT_KINK_OF_JOINT):
        return
    label = work.body[active.points[search.contact].body].label
    for i in range(active.count[0]):
        active_point = active.points[i]
        same = active_point.rest == 0 and work.body[active_point.body].label == label
        active_point.due = 1 if same and margin(active_point, search.kind) < 0.0 else 0


@kernel
def switch_due(system, active, search):
    """Set the new mode of the points whose event has been located; return whether it is one of these."""
    if search.kind == EVENT_JAM:
        return False
    if search.kind in (EVENT_STOP, EVENT_KINK, EVENT_KINK_OF_JOINT):
        return True  # the modes of the end of the step are those of the stop, or of slip
    if search.kind == EVENT_BREAK:
        system.relations.memory.frictions[search.contact].next = MODE_SLIP
        return True
    for i in range(active.count[0]):
        active_point = active.points[i]
        near = active_point.due == 1 and margin(active_point, search.kind) <= 2.0 * EVENT_MARGIN
        if near or i == search.contact:
            active_point.next = MODE_OPEN if search.kind == EVENT_SEPARATE else MODE_SLIP
        active_point.due = 0
    return True
