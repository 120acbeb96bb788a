"""How far one of several held points is from opening and from slip, at the end of a step.

Forces of several points need not be unique, accelerations are. So the point opens where its normal
acceleration is above nothing, and slips where its tangential one is; before that its force tells how far it is:

    lift    N W_nn,  or  -a_n,               grip    (mu N - |T|) W_tt,  or  -|a_t|,

relative to what the bodies do without contact forces. A force of nothing, or at the cone, is no event.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.acceleration import OPEN, SLIP, STICK
from carom.impact.workspace import OLD, C, P
from carom.persistent.events import SEPARATE

LEAST = 1e-5  # before an event: what counts as none is not near
NONE = 1e-7  # of an acceleration: those of two bodies are worked out to 1e-9
NEAR = 1e-6  # an event is located to this part of the acceleration


@kernel
def greatest_push(k, cluster):
    """Return the greatest acceleration of the k points without contact forces.

    0 where two bodies touch at several points: the corners of their overlap come and go, most of them without
    a force, and their events are left to the end of the step.
    """
    push = 0.0
    for i in range(k):
        a = cluster.seats[i]
        for j in range(i if a.turns == 0 and cluster.points[0][i].b >= 0 else 0):
            if cluster.seats[j].contact == a.contact and cluster.seats[j].turns == 0:
                return 0.0
    for i in range(3 * k):
        push = max(push, abs(cluster.v[C][i]))
    return push


@kernel
def set_margins(hold, i, push, cluster):
    """Write lift and grip of point i; `next` says what the step has found."""
    hold.lift, hold.grip = 1.0, 1.0
    if not push > 0.0:
        return
    q, W, p, a = 3 * i, cluster.m[0], cluster.v[P], cluster.v[OLD]
    if hold.next == OPEN:
        hold.lift = -max(a[q] / push, 2.0 * NEAR)
        return
    if p[q] <= 0.0 and a[q] > NONE * push:
        hold.lift = -a[q] / push
    else:
        hold.lift = max(p[q] * W[q, q] / push, LEAST)
    if hold.mode == STICK:
        gain = math.sqrt(a[q + 1] ** 2 + a[q + 2] ** 2) / push
        if hold.next == SLIP:
            hold.grip = -max(gain, 2.0 * NEAR)
        elif gain > NONE:
            hold.grip = -gain
        else:
            left = cluster.mu[i] * p[q] - math.sqrt(p[q + 1] ** 2 + p[q + 2] ** 2)
            hold.grip = max(left * max(W[q + 1, q + 1], W[q + 2, q + 2]) / push, LEAST)


@kernel
def margin(hold, kind):
    """Return how far a point is from an event."""
    return hold.lift if kind == SEPARATE else hold.grip


@kernel
def note_due(held, search, work):
    """Mark the points of the same group for which the step on trial has the event that is looked for."""
    group = work.body[held.points[search.contact].body].group
    for i in range(held.count[0]):
        hold = held.points[i]
        same = hold.several == 1 and hold.rest == 0 and work.body[hold.body].group == group
        hold.due = 1 if same and margin(hold, search.kind) < 0.0 else 0


@kernel
def meet_due(held, search):
    """Give the points whose event has been located their new mode; return whether there are any."""
    if held.points[search.contact].several == 0:
        return False
    for i in range(held.count[0]):
        hold = held.points[i]
        near = hold.due == 1 and margin(hold, search.kind) <= 2.0 * LEAST
        if near or i == search.contact:
            hold.next = OPEN if search.kind == SEPARATE else SLIP
        hold.due = 0
    return True
