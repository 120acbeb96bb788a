"""Continuous detection: may two bodies have touched between two states? No impact is missed.

Are they far from each other? Does a face separate them? Which points are nearest at the end, and at the start,
and for how long from each end do they stay apart (`operations.time_apart`)? The path is clear if the sum of
both times is at least the step, or if the cubic between both ends, which describes the gap in short steps,
stays positive. Kinds with known points decide by these points (`kinds.vertices`, `kinds.stop`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact import thresholds as limits
from carom.contact.continuous_detection import (
    BELOW,
    CLEAR,
    FLAT_RIM,
    UNSURE,
    arrives,
    cubic_clears,
    time_of_hop,
)
from carom.contact.gap import slow
from carom.contact.kinds import by_kind
from carom.contact.kinds.found_points import nearest_touch, touch_rate
from carom.contact.kinds.level_surfaces import rides_on, touches_already
from carom.contact.kinds.partner import smaller
from carom.contact.kinds.rim import closed_rim, longest_way
from carom.contact.operations import (
    find_touches,
    list_touches,
    located_within,
    lowest_found,
    lowest_open,
    stays_beside_face,
    stays_far,
    time_apart,
    way_past,
)
from carom.geometry.rotation import norm
from carom.geometry.thresholds import RESOLUTION, ROUND_OFF
from carom.geometry.vectors import minus
from carom.kinematics.flexible import greatest_deflection, greatest_ringing
from carom.model.workspace import FREE


class Step(NamedTuple):
    """What a trial step is like for a contact."""

    h: float  # its length [s]
    bounds: tuple  # of accelerations and spins (`kinematics.flight.relative_bound`)
    tiny: float  # gap within which an impact is located [m]
    part: float  # the largest depth that is no penetration [m]
    flies: bool  # both bodies fly
    short: bool  # they pass each other by less than a part of the smaller one
    little: bool  # and turn by less than half a radian


@by_kind("model.system.contacts[c]")
def passage(model, data, c):
    """Return CLEAR, BELOW (they overlap at the end), UNSURE or FLAT_RIM, and a time before any contact.

    The step is the trial step. Points that carry a persistent contact are left out.
    """
    return passage_of_found(model, data, c)


@unit
def passage_of_found(model, data, c) -> tuple[int, float]:
    """Return this for points that are found in each state."""
    system, work = model.system, data.work
    contact, h, end = system.contacts[c], work.search[0].dt, work.trial
    bounds, far = stays_far(system, data, contact)
    if far:
        return CLEAR, h
    step = step_of(model, data, contact, bounds)
    touching = touches_already(system, data.active, c)
    smooth = is_smooth(model, contact, step, bounds[1])
    if not touching and stays_beside_face(system, data, contact, smooth, step.tiny, bounds):
        return CLEAR, h
    if find_touches(system, contact, end, limits.REACH * smaller(contact), work) == 0:
        return (CLEAR, h) if touching else passage_hidden(system, data, contact, bounds)
    least, rate = lowest_open(system, data, c, end)
    if touching:
        return passage_of_touching(model, data, c, step, (least, rate))
    if rides_on(system, data.active, c, nearest_touch(work)) and least >= -step.part:
        return CLEAR, h
    if not least >= -step.tiny:
        return passage_below(system, data, c, step, (least, rate))
    feature = nearest_touch(work).feature
    last, most = time_apart(system, contact, end, bounds, -h, work)
    if last >= h:
        return CLEAR, h
    return passage_between(model, data, c, step, (feature, least, rate, last, most))


@kernel
def step_of(model, data, contact, bounds):
    """Return what the trial step is like for a contact."""
    work = data.work
    h = work.search[0].dt
    flies = work.body[contact.body].status == FREE
    if contact.other >= 0:
        flies = flies and work.body[contact.other].status == FREE
    short = way_past(contact, data) <= limits.SAFE_DISPLACEMENT * smaller(contact)
    little = short and h * (bounds[3] + bounds[5]) <= limits.SAFE_ROTATION
    tiny, part = located_within(model.controls, contact, work.trial), RESOLUTION * smaller(contact)
    return Step(h, bounds, tiny, part, flies, short, little)


@kernel
def sag(step, most):
    """Return a bound of the distance of a path from its chord; `most` bounds the acceleration."""
    return 0.125 * most * step.h * step.h


@kernel
def is_smooth(model, contact, step, most):
    """Return whether the cubic between both ends describes the gap of the points nearest at both."""
    if step.short and (not step.flies or sag(step, most) <= step.part):
        return True
    return step.little and model.controls.order > 0 and is_integrated(model.system, contact)


@kernel
def passage_of_touching(model, data, c, step, at_end):
    """Return the verdict for bodies in contact: the lowest point of a wobbling rim must not go too far.

    Only steps up to `longest` may follow it along a large arc.
    """
    system, controls, work = model.system, model.controls, data.work
    longest, moved = limits.RIM_TIME * controls.step, longest_way(system, data, c)
    if moved > limits.RIM_STEP:
        if step.h > longest:
            return UNSURE, 0.0
        if flat_rim_strikes(system, system.contacts[c], data.state, longest, work):
            return FLAT_RIM, 0.0
        if moved > limits.RIM_DISTANCE and step.h > 0.1 * longest:
            return UNSURE, 0.0
    if not at_end[0] >= -step.part:
        return passage_below(system, data, c, step, at_end)
    return CLEAR, step.h


@kernel
def passage_below(system, data, c, step, at_end):
    """Return the verdict for points inside at the end: clear if they touched and separate or are pushed."""
    (before, rate), (least, its_rate) = lowest_found(system, data, c, data.state), at_end
    off = 0.0
    if before <= step.tiny:
        comes_out = before < -step.tiny and least >= before
        pushed = not step.flies and least >= -step.part
        if pushed and not comes_out:
            off = time_of_hop(before, rate, least, its_rate, step.h, step.tiny)
        if comes_out or (pushed and off == 0.0):
            return CLEAR, step.h
    return BELOW, 2.0 * off


@kernel
def passage_between(model, data, c, step, at_end):
    """Return the verdict for bodies that are apart at the end, for the `last` part of the step."""
    system, work, start = model.system, data.work, data.state
    contact, (feature, least, rate, last, most) = system.contacts[c], at_end
    smooth, bent = is_smooth(model, contact, step, most), sag(step, most)
    list_touches(system, contact, start, 0.0, work)
    nearest = nearest_touch(work)
    gap, rate0, alike = nearest.gap, touch_rate(contact, nearest, start), nearest.feature == feature
    first, _ = time_apart(system, contact, start, step.bounds, step.h, work)
    if arrives(gap, rate0, least, rate, step.tiny, slow(contact, work.trial)):
        data.active.contact_states[c].near = 1
    follows = alike and smooth
    if follows and cubic_clears(gap, rate0, least, rate, step.h, step.tiny):
        return CLEAR, first
    # other points may be nearest at the end (faces that are parallel): none comes so far
    if smooth and min(gap, least) > greatest_travel(system, contact, data):
        return CLEAR, first
    bends = bent > step.tiny or follows or not step.short
    if step.little and max(abs(gap), abs(least)) <= step.tiny:
        if max(abs(rate0), abs(rate)) <= slow(
            contact, work.trial
        ):  # slides or rolls along, unforced
            return CLEAR, first
    leaving = data.active.contact_states[c].leaving
    if first + last < step.h * (1.0 - ROUND_OFF) and bends and leaving == 0:
        return UNSURE, first
    return CLEAR, first


@by_kind("contact")
def passage_hidden(system, data, contact, bounds):
    """Return the verdict for a solid whose nearest points at the end belong to a level surface.

    If they belonged to the same one at the start, the row of the surface decides.
    """
    start, work, h = data.state, data.work, data.work.search[0].dt
    end, hidden = work.trial, work.pair.state[0].hidden
    if find_touches(system, contact, start, 0.0, work) == 0:
        if work.pair.state[0].hidden == hidden:
            return CLEAR, h
    list_touches(system, contact, end, 0.0, work)
    last, _ = time_apart(system, contact, end, bounds, -h, work)
    list_touches(system, contact, start, 0.0, work)
    first, most = time_apart(system, contact, start, bounds, h, work)
    bends = 0.125 * most * h * h > RESOLUTION * smaller(contact)
    bends = bends or way_past(contact, data) > limits.SAFE_DISPLACEMENT * smaller(contact)
    return (UNSURE, first) if first + last < h * (1.0 - ROUND_OFF) and bends else (CLEAR, first)


@kernel
def flat_rim_strikes(system, contact, state, time, work):
    """Return whether a point of a rim that counts as flat approaches the other body."""
    count = find_touches(system, contact, state, limits.REACH * smaller(contact), work)
    near = closed_rim(system, contact, work.touches[0].normal, state, time) if count > 0 else 0.0
    for i in range(count):
        touch = work.touches[i]
        if touch.gap <= near and touch_rate(contact, touch, state) < -slow(contact, state):
            return True
    return False


@kernel
def is_integrated(system, contact):
    """Return whether the motion of a body is integrated: joined and loaded bodies are not in closed form.

    With tolerances the cubic of a gap is within the error of their step, which is of the same order; bounds
    from the accelerations of its stages are no stricter.
    """
    other = contact.other
    joined = other >= 0 and system.bodies[other].ballistic == 0
    return joined or system.bodies[contact.body].ballistic == 0


@kernel
def greatest_travel(system, contact, data):
    """Return a bound of the way of any point of one solid past the other, if motions are cubics of time.

    A cubic with the displacement D in a step h, and speeds up to s at its ends, goes at most D + 8/27 h s.
    """
    start, end, a, b = data.state, data.work.trial, contact.body, contact.other
    moved, speed = minus(end[a].x, start[a].x), 0.0
    turned = contact.extent * angle_between(start[a], end[a])
    if b >= 0:
        moved = minus(moved, minus(end[b].x, start[b].x))
        turned += contact.other_extent * angle_between(start[b], end[b])
    for state in (start, end):
        v, w = minus(state[a].v, (0.0, 0.0, 0.0)), contact.extent * norm(state[a].w)
        if b >= 0:
            v, w = minus(v, state[b].v), w + contact.other_extent * norm(state[b].w)
        speed = max(speed, norm(v) + w)
    if contact.bends == 1:
        for state in (start, end):
            turned += greatest_deflection(system, a, b, state)
            speed += greatest_ringing(system, a, b, state)
    return norm(moved) + turned + limits.CUBIC_SHARE * data.work.search[0].dt * speed


@kernel
def angle_between(start, end):
    """Return a bound of the angle between two attitudes, from the distance of their quaternions."""
    square = 0.0
    for j in range(4):
        square += (end.Q[j] - start.Q[j]) ** 2
    return limits.CHORD_ANGLE * math.sqrt(square)
