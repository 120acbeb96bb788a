"""A body and a half-space: bounds of its distance, of the acceleration of its points, and of its path.

In free flight the bound a of the normal acceleration is strict, |n.g| + (|W|^2 + |W'|) r with the maxima on the
flight; otherwise it is an estimate, twice the largest value in the stages of the step.
"""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom.contact.continuous_detection import reach
from carom.kinematics.flight import point_bound
from carom.model.workspace import FREE, RESTS


@inlined
def along_normal(contact, a):
    """Return n . a for a world vector."""
    n = contact.axes
    return n[0, 0] * a[0] + n[0, 1] * a[1] + n[0, 2] * a[2]


@kernel
def room(system, contact, state, pieces):
    """Return the distance of the ball around a body, also for its `pieces`."""
    x = state[contact.body].x
    return along_normal(contact, x) - contact.offset - contact.radius - contact.extent


@inlined
def greatest_acceleration(system, contact, state, work):
    """Return bounds of the normal acceleration of the mass centre and of any point of the body."""
    body, r = system.bodies[contact.body], contact.core
    status, bound = work.body[contact.body].status, work.body[contact.body].bound
    if body.ballistic == 1 and status == FREE:
        begin = state[contact.body]
        centre = abs(along_normal(contact, system.gravity))
        return centre, centre + r * point_bound(body, begin.Q, begin.w, work.body[contact.body])
    centre = 2.0 * bound[0]
    return centre, centre + 2.0 * r * (bound[1] + bound[2] * bound[2])


@inlined
def ball_clears(system, data, contact, centre):
    """Return whether the bounding ball of the body does not touch: the first check, usually sufficient."""
    b, margin = contact.body, contact.extent + contact.radius + contact.offset
    start, end = data.state[b], data.work.trial[b]
    z0, z1 = along_normal(contact, start.x) - margin, along_normal(contact, end.x) - margin
    if not (z0 > 0.0 and z1 > 0.0):
        return False
    s0, s1 = along_normal(contact, start.v), along_normal(contact, end.v)
    flying = system.bodies[b].ballistic == 1 and data.work.body[b].status == FREE
    if flying and (s1 <= 0.0 or s0 >= 0.0):  # the gap is least at an end
        return True
    return reach(z0, s0, centre) + reach(z1, -s1, centre) >= data.work.search[0].dt


@inlined
def stays_far(system, data, contact):
    """Return the bounds of `relative_bound` for one body, and whether the ball around it stays above."""
    if data.work.body[contact.body].status == RESTS:
        return (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), True
    centre, most = greatest_acceleration(system, contact, data.state, data.work)
    return (centre, most, 0.0, 0.0, 0.0, 0.0), ball_clears(system, data, contact, centre)
