"""Continuous detection for a pair: may two solids have touched between two states? Separating planes decide.

Along the normal n of a plane that rests, or moves with one of them, the gap of any two core points is
z(t) >= z0 + z0' t - a t^2/2, where a bounds their relative acceleration in the frame of the plane (`parting`).
One time results from the plane of the nearest points at the start, another one backwards from the end. The path
is clear if the sum of both is at least the step.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact import thresholds as limits
from carom.contact.closed_points import round_off_of_both
from carom.contact.continuous_detection import (
    BELOW,
    CLEAR,
    FLAT_RIM,
    UNSURE,
    ball_clears,
    cubic_clears,
    greatest_acceleration,
    reach,
)
from carom.contact.gap import slow
from carom.contact.level import rides_on, share_surface
from carom.contact.pair_point import find_touches, list_touches, smaller, touch_rate
from carom.contact.parting import plane_of, stays_beside_face, time_apart
from carom.contact.parting_of_profile import has_profile, time_off_profile
from carom.contact.parting_on_surface import room_over_surface, time_over_surface
from carom.contact.place_of_other import balls, centre_of_other, on_curved_ground, on_half_space
from carom.contact.rim import closed_rim, longest_way, place_of
from carom.geometry.rotation import norm
from carom.geometry.thresholds import RESOLUTION
from carom.geometry.vectors import dot, minus
from carom.kinematics.flight import relative_bound
from carom.model.workspace import FREE, RESTS


@kernel
def balls_clear(system, data, contact, a, pieces):
    """Return whether the balls around both bodies, or two `pieces` of them, stay apart in the trial step."""
    time, curved = 0.0, on_curved_ground(system, contact)
    for side in range(2):
        state, sign = (data.state, 1.0) if side == 0 else (data.work.trial, -1.0)
        if curved:
            room = room_over_surface(system, contact, state, pieces)
            if not room > 0.0:
                return False
            own = state[contact.body]
            time += reach(room, -norm(own.v) - (contact.extent * norm(own.w) if pieces else 0.0), a)
            continue
        x, y, radii = balls(system, contact, state, pieces)
        s, u = minus(x, y), (x[3] - y[3], x[4] - y[4], x[5] - y[5])
        d = math.sqrt(dot(s, s))
        if not d > radii:
            return False
        time += reach(d - radii, sign * dot(s, u) / d, a)
    return time >= data.work.search[0].dt


@kernel
def lowest_open(system, data, c, state):
    """Return the least gap of the points in work.touches that are not active, and its rate.

    It is nan where a profile and its partner have no sections: the search for this event ends the run.
    """
    least, rate, work = math.inf, 0.0, data.work
    for i in range(work.pair.state[0].total):
        touch = work.touches[i]
        if not touch.gap >= least and place_of(system, data.active, c, touch, state) < 0:
            least, rate = touch.gap, touch_rate(system.contacts[c], touch, state)
    return least, rate


@kernel
def nearest_touch(work):
    """Return the point in work.touches with the least gap."""
    nearest = work.touches[0]
    for i in range(1, work.pair.state[0].total):
        if work.touches[i].gap < nearest.gap:
            nearest = work.touches[i]
    return nearest


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


@unit
def lowest_pair(system, data, c, state) -> tuple[float, float]:
    """Return the least gap of two solids, over points that are not active, and its rate."""
    contact = system.contacts[c]
    find_touches(system, contact, state, limits.REACH * smaller(contact), data.work)
    return lowest_open(system, data, c, state)


@kernel
def far_apart(system, data, contact):
    """Return the bounds of `relative_bound`, and whether balls around the two stay apart."""
    start, work = data.state, data.work
    a, b, none = contact.body, contact.other, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if on_half_space(contact):
        if work.body[a].status == RESTS:
            return none, True
        centre, most = greatest_acceleration(system, contact, start, work)
        bounds = (centre, most, 0.0, 0.0, 0.0, 0.0)
        return bounds, ball_clears(system, data, contact, centre)
    if work.body[a].status == RESTS and (b < 0 or work.body[b].status == RESTS):
        return none, True
    bounds = relative_bound(system, contact, start, work)
    clear = balls_clear(system, data, contact, bounds[0], False)
    if contact.part == 1 and not clear:
        clear = balls_clear(system, data, contact, bounds[1], True)
    return bounds, clear


@unit
def passage_pair(model, data, c) -> tuple[int, float]:
    """Return CLEAR, BELOW (they overlap at the end), UNSURE or FLAT_RIM, and a time before any contact.

    The step is the trial step. Only steps up to `longest` may follow the lowest point of a wobbling rim along a
    large arc.
    """
    system, controls, start, work = model.system, model.controls, data.state, data.work
    contact, end, h = system.contacts[c], work.trial, work.search[0].dt
    longest = limits.RIM_TIME * controls.step
    bounds, clear = far_apart(system, data, contact)
    if clear:
        return CLEAR, h
    touching = touches_already(system, data.active, c)
    flies = work.body[contact.body].status == FREE
    if contact.other >= 0:
        flies = flies and work.body[contact.other].status == FREE
    curved, first, last, most = on_curved_ground(system, contact), 0.0, 0.0, bounds[1]
    if curved and not touching:
        last, most = time_over_surface(system, contact, end, bounds, -h, work)
    sag = 0.125 * most * h * h
    short = way_past(contact, data) <= limits.SAFE_DISPLACEMENT * smaller(contact)
    little = short and h * (bounds[3] + bounds[5]) <= limits.SAFE_ROTATION
    smooth = short and (not flies or sag <= RESOLUTION * smaller(contact))
    smooth = smooth or (little and controls.order > 0 and is_integrated(system, contact))
    tiny = 4.0 * max(controls.gap * smaller(contact), round_off_of_both(contact, end))
    if not touching and stays_beside_face(system, data, contact, smooth, tiny, bounds):
        return CLEAR, h
    if find_touches(system, contact, end, limits.REACH * smaller(contact), work) == 0:
        hidden = touching or contact.surface > 0
        return (CLEAR, h) if hidden else passage_hidden(system, data, contact, bounds)
    least, rate = lowest_open(system, data, c, end)
    rides = not touching and rides_on(system, data.active, c, nearest_touch(work))
    if rides and least >= -RESOLUTION * smaller(contact):
        return CLEAR, h
    if touching:
        moved = longest_way(system, data, c)
        if moved > limits.RIM_STEP and h > longest:
            return UNSURE, 0.0
        if moved > limits.RIM_STEP:
            if flat_rim_strikes(system, contact, start, longest, work):
                return FLAT_RIM, 0.0
            if moved > limits.RIM_DISTANCE and h > 0.1 * longest:
                return UNSURE, 0.0
            find_touches(system, contact, end, limits.REACH * smaller(contact), work)
    if not least >= -(tiny if not touching else RESOLUTION * smaller(contact)):
        before, _ = lowest_pair(system, data, c, start)
        if before <= tiny:  # they touch already: they separate, or others push them
            if (before < -tiny and least >= before) or (
                not flies and least >= -RESOLUTION * smaller(contact)
            ):
                return CLEAR, h
        return BELOW, 0.0
    if touching:
        return CLEAR, h
    nearest = nearest_touch(work)
    feature, profile = nearest.feature, has_profile(system, contact)
    if curved:
        last = min(last, reach(nearest.gap, -touch_rate(contact, nearest, end), most))
    else:
        last = time_apart(system, contact, plane_of(nearest), end, bounds, -h)
    if profile and last < h:
        last = max(last, time_off_profile(system, contact, end, bounds, -h, work))
    if last >= h:
        return CLEAR, h
    if curved:
        first, most = time_over_surface(system, contact, start, bounds, h, work)
    list_touches(system, contact, start, 0.0, work)
    nearest = nearest_touch(work)
    rate0 = touch_rate(contact, nearest, start)
    if curved:
        first = min(first, reach(nearest.gap, rate0, most))
    else:
        first = time_apart(system, contact, plane_of(nearest), start, bounds, h)
    gap, name = nearest.gap, nearest.feature
    if profile and first + last < h:
        first = max(first, time_off_profile(system, contact, start, bounds, h, work))
    alike = feature == name  # the same points are nearest at both ends
    follows = alike and smooth  # the cubic between both ends describes the gap
    if follows and cubic_clears(gap, rate0, least, rate, h, tiny):
        return CLEAR, first
    # other points may be nearest at the end (faces that are parallel): none comes so far
    if smooth and min(gap, least) > greatest_travel(contact, data):
        return CLEAR, first
    bends = sag > tiny or follows or not short
    if little and max(abs(gap), abs(least)) <= tiny:
        if max(abs(rate0), abs(rate)) <= slow(contact, end):  # it slides or rolls along, unforced
            return CLEAR, first
    leaving = data.active.contact_states[c].leaving
    if first + last < h * (1.0 - 1e-12) and bends and leaving == 0:
        return UNSURE, first
    return CLEAR, first


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
def touches_already(system, active, c):
    """Return whether a row has active points, or its body has some on the same level surface."""
    contact = system.contacts[c]
    for j in range(active.count[0]):
        d = active.points[j].contact
        if d == c:
            return True
        if contact.first_level < contact.last_level and share_surface(system, c, d):
            return True
    return False


@kernel
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
    last = time_apart(system, contact, plane_of(nearest_touch(work)), end, bounds, -h)
    list_touches(system, contact, start, 0.0, work)
    first = time_apart(system, contact, plane_of(nearest_touch(work)), start, bounds, h)
    bends = 0.125 * bounds[1] * h * h > RESOLUTION * smaller(contact)
    bends = bends or way_past(contact, data) > limits.SAFE_DISPLACEMENT * smaller(contact)
    return (UNSURE, first) if first + last < h * (1.0 - 1e-12) and bends else (CLEAR, first)


@kernel
def way_past(contact, data):
    """Return the relative displacement in the trial step, from the larger relative velocity of the centres."""
    most = 0.0
    if on_half_space(contact):
        return 0.0
    for state in (data.state, data.work.trial):
        v, y = state[contact.body].v, centre_of_other(contact, state)
        most = max(most, (v[0] - y[3]) ** 2 + (v[1] - y[4]) ** 2 + (v[2] - y[5]) ** 2)
    return data.work.search[0].dt * math.sqrt(most)


@kernel
def greatest_travel(contact, data):
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
    return norm(moved) + turned + limits.CUBIC_SHARE * data.work.search[0].dt * speed


@kernel
def angle_between(start, end):
    """Return a bound of the angle between two attitudes, from the distance of their quaternions."""
    square = 0.0
    for j in range(4):
        square += (end.Q[j] - start.Q[j]) ** 2
    return limits.CHORD_ANGLE * math.sqrt(square)
