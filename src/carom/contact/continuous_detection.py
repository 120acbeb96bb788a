"""Continuous detection for a half-space: may a body have touched it between two states? No impact is missed.

For each vertex the gap z and its rate are known at both ends, and |d2z/dt2| <= a in between. Then

    z(t) >= z0 + z0' t - a t^2/2,      z(t) >= z1 - z1' s - a s^2/2,   s = h - t,

and the path is clear if the times for which these bounds are positive, (z0' + sqrt(z0'^2 + 2 a z0))/a and the
same from the end, add up to at least h. If not, the caller halves the step. In free flight a is a strict bound,
|n.g| + (|W|^2 + |W'|) r with the maxima on the flight; otherwise it is an estimate, twice the largest value in
the stages of the step. For a body in persistent contact, z is assumed to be the cubic with the gaps and rates
at both ends. It is never below the least of its control points (Bezier): z0, z0 + h z0'/3, z1 - h z1'/3, z1.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined
from carom.contact.gap import along_normal, gap_and_rate, plane_in_body, round_off
from carom.geometry.thresholds import RESOLUTION
from carom.kinematics.flight import point_bound
from carom.model.workspace import FREE, RESTS

#: verdicts on a step: no touch; a point is inside at the end; undecided because the step is too long; a rim in
#: persistent contact on one side passes the flat position
CLEAR, BELOW, UNSURE, FLAT_RIM = range(4)


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
def reach(z, rate, a):
    """Return the time during which z + rate t - a t^2/2 is positive."""
    z = max(z, 0.0)
    if a <= 0.0:
        return math.inf if rate >= 0.0 else -z / rate
    return (rate + math.sqrt(rate * rate + 2.0 * a * z)) / a


@inlined
def cubic_clears(z0, rate0, z1, rate1, h, tiny):
    """Return whether the cubic with these ends and rates stays above -tiny: its control points do.

    What is deeper at the start, and not deeper later, has touched before: it comes out.
    """
    return min(z0 + h * rate0 / 3.0, min(z1, z1 - h * rate1 / 3.0)) >= min(-tiny, z0)


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
def passage(model, data, c):
    """Return CLEAR, BELOW (the end is inside the half-space) or UNSURE, and a time before any contact.

    The step is the trial step. Vertices that carry a persistent contact are left out.
    """
    system, start, work = model.system, data.state, data.work
    contact, end, h = system.contacts[c], work.trial, work.search[0].dt
    if work.body[contact.body].status == RESTS:
        return CLEAR, h
    centre, a = greatest_acceleration(system, contact, start, work)
    if ball_clears(system, data, contact, centre):
        return CLEAR, h
    verdict, first, flies = CLEAR, h, work.body[contact.body].status == FREE
    tiny = max(model.controls.gap * contact.extent, round_off(contact, end))
    sag = 0.125 * a * h * h  # bound of the distance of a path from its chord
    smooth = not flies or sag <= RESOLUTION * contact.extent
    before, after = plane_in_body(contact, start), plane_in_body(contact, end)
    for i in range(contact.first, contact.last):
        z0, rate0 = gap_and_rate(before, system.vertices[i])
        z1, rate1 = gap_and_rate(after, system.vertices[i])
        if min(z0, z1) > sag or data.active.carries[i] == 1:
            continue
        t0 = reach(z0, rate0, a)
        first = min(first, t0)
        if not (z1 >= -tiny):
            # a touching point may be leaving, or other bodies may push it in by no more than may be missed
            pushed = not flies and z1 >= -RESOLUTION * contact.extent
            if not (z0 <= tiny and (pushed or (z0 < -tiny and z1 >= z0))):
                verdict = BELOW
        elif (
            verdict == CLEAR
            and t0 + reach(z1, -rate1, a) < h * (1.0 - 1e-12)
            and sag > tiny  # what could be missed is more than the tolerance
            and data.active.contact_states[c].leaving == 0
            and not (smooth and cubic_clears(z0, rate0, z1, rate1, h, tiny))
        ):
            verdict = UNSURE
    return verdict, first
