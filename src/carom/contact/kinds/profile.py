"""Bound of the time during which a profile, which is not convex, and another solid stay apart.

Seen from the profile, a point q of the other solid moves at a speed up to V with an acceleration up to a. Its
distance d from the curve has the second derivative

    d'' = n . q'' + kappa/(1 + kappa d) (t . q')^2.

Let K be the greatest curvature of hollows, -kappa <= K. While K d <= 1/2, d'' is at least -A with
A = a + 2 K (V + a h)^2. A distance that is larger, 1/(2 K), does not vanish within a time h for which
K (V h + a h^2/2) <= 1/8. So each foot that is nearest now stays at a positive distance as long as
d + d' t - A t^2/2 > 0, forwards and, with h < 0, backwards in time.

Corners need no more: a hollow one is where two solids meet, each with its own distance, which goes on smoothly
beyond the corner.

Points of the curve that are farthest towards a face change faster the flatter the curve is, so there only
d >= d(0) - V t - a t^2/2 is used; planes that separate the other solid from the convex hull of the profile
(`parting`) are better.

Two profiles: only points that are in the balls around both can meet, and their relative speed is at most that
of the middle of this lens and the relative spin times its radius. Points at a distance d that meet approach
each other at most as fast as that, and the spin times d more.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.collision.features import NOBODY
from carom.collision.layout import CYLINDER, PROFILE, SEGMENT
from carom.contact.continuous_detection import reach
from carom.contact.kinds import parting
from carom.contact.kinds.drift import motions_of
from carom.contact.kinds.found_points import (
    list_on_solid,
    nearest_touch,
    touch_rate,
    which_touch,
)
from carom.contact.kinds.parting import (
    bound_in_frame,
    frame_of,
    plane_of,
    time_beside,
)
from carom.contact.kinds.partner import centre_of_other, smaller
from carom.contact.kinds.profile_drift import drift_of_profile, drift_of_two_profiles
from carom.contact.kinds.rim import same_point
from carom.contact.thresholds import ACTIVE_REACH, TOOTH_REACH
from carom.geometry.thresholds import RESOLUTION
from carom.geometry.vectors import cross, dot, minus, plus
from carom.status import OUT_OF_PLANE

beside_face, stays_beside_face = parting.beside_face, parting.stays_beside_face


@unit
def time_apart(system, contact, state, bounds, h, work) -> tuple[float, float]:
    """Return how long, up to |h|, both stay apart: by a plane beside the hull of the profile, or by its curve.

    And the bound of the acceleration of their points. h < 0: in the past.
    """
    time, plane = 0.0, plane_of(nearest_touch(work))
    if hulls_apart(system, contact, plane, state):
        time = time_beside(system, contact, plane, state, bounds, h)
    if time < abs(h) and are_two(system, contact):
        time = max(time, time_off_each_other(contact, state, nearest_touch(work).gap, bounds, h))
    elif time < abs(h):
        time = max(time, time_off_profile(system, contact, state, bounds, h, work))
    return time, bounds[1]


@kernel
def active_reach(system, contact):
    """Return how far above the least gap active points are sought, in the iterations of a step.

    The time of a search goes with the square of its reach (`carom.collision.two_profiles.places_of`).
    """
    part = TOOTH_REACH if are_two(system, contact) else ACTIVE_REACH
    return part * smaller(contact)


@kernel
def touch_of_active(system, contact, feature, p, state, work):
    """Write the points of a contact; return the one that has a feature, or that replaces it.

    An active point is among the nearest; only where it is not, all within a greater reach are sought.
    """
    if are_two(system, contact):
        list_on_solid(
            system, contact, contact.other_solid, state, active_reach(system, contact), work
        )
        for i in range(work.pair.state[0].total):
            if same_point(system, contact, work.touches[i], feature, p, state):
                return i
    list_on_solid(
        system, contact, contact.other_solid, state, ACTIVE_REACH * smaller(contact), work
    )
    return which_touch(system, contact, feature, p, state, work)


@kernel
def hulls_apart(system, contact, plane, state):
    """Return whether a plane is between both convex hulls now: between gears in mesh there is none.

    Without it each time is the end of thirty halvings, each with points farthest on curves of thousands of
    rows: half of the time of gears that rattle.
    """
    frame = frame_of(contact, 2, plane[0], state)
    room = RESOLUTION * min(contact.extent, contact.other_extent)
    return parting.least_gap(system, contact, frame, state, 0.0, 0.0) >= -room


@unit
def drift(system, contact, feature, point, state, work) -> tuple[float, float, float]:
    """Return (d/dt G) v of a point of a profile and another solid."""
    if are_two(system, contact):
        return drift_of_two_profiles(system, contact, contact.other_solid, point, state)
    return drift_of_profile(system, contact, contact.other_solid, point, state)


@kernel
def are_two(system, contact):
    """Return whether both solids are profiles."""
    first, second = system.solids[contact.solid], system.solids[contact.other_solid]
    return first.kind == PROFILE and second.kind == PROFILE


@kernel
def speed_in_lens(contact, state, way):
    """Return the greatest relative speed of points of both that are at one place, or have a way to it."""
    (va, wa), (vb, wb) = motions_of(contact, state)
    x, y = state[contact.body].x, centre_of_other(contact, state)
    d = (y[0] - x[0], y[1] - x[1], y[2] - x[2])
    far, r, s = math.sqrt(dot(d, d)), contact.extent + way, contact.other_extent + way
    part, most = 0.0, min(r, s)
    if far > 0.0:
        part = 0.5 * (far * far + r * r - s * s) / far
        if 0.0 < part < far:
            most = math.sqrt(max(r * r - part * part, 0.0))
        else:  # one of the centres is in the lens
            part = 0.0 if r < s else far
        part /= far
    w, arm = minus(wa, wb), (part * d[0], part * d[1], part * d[2])
    u = plus(minus(va, vb), 1.0, cross(wa, arm))
    u = minus(u, cross(wb, minus(arm, d)))
    return math.sqrt(dot(u, u)) + most * math.sqrt(dot(w, w))


@kernel
def time_off_each_other(contact, state, gap, bounds, h):
    """Return how long, up to |h|, two profiles stay apart, from the speed of points that can meet."""
    (va, wa), (vb, wb) = motions_of(contact, state)
    u, spin = minus(va, vb), math.sqrt(dot(wa, wa)) + math.sqrt(dot(wb, wb))
    # two points that meet are at last nearer to each other than the gap; the centres move, too
    moved = math.sqrt(dot(u, u)) * abs(h) + 0.5 * bounds[1] * h * h
    speed = speed_in_lens(contact, state, max(gap, 0.0) + moved) + spin * max(gap, 0.0)
    return min(abs(h), reach(gap, -speed, bounds[1]))


@kernel
def lost_gap(contact):
    """Return the status of a contact without a gap: the profile and its partner have no sections."""
    return OUT_OF_PLANE


@kernel
def speed_past_profile(system, contact, first, state):
    """Return the greatest speed of a core point of the other solid in axes of the profile (A if `first`)."""
    (va, wa), (vb, wb) = motions_of(contact, state)
    x, y = state[contact.body].x, contact.centre
    d = (y[0] - x[0], y[1] - x[1], y[2] - x[2])
    if contact.static == 0:
        y = state[contact.other].x
        d = (y[0] - x[0], y[1] - x[1], y[2] - x[2])
    v, w = minus(vb, va), minus(wb, wa)
    v = minus(v, cross(wa, d)) if first else plus(v, -1.0, cross(wb, d))
    solid = system.solids[contact.other_solid if first else contact.solid]
    p, own = solid.x, solid.extent - solid.radius
    if (
        solid.kind <= SEGMENT or solid.kind == CYLINDER
    ):  # in the plane of the curve its axis is a point
        own = 0.0
    if contact.static == 0 or not first:
        own += math.sqrt(dot(p, p))
    else:
        own = contact.other_extent
    return math.sqrt(dot(v, v)) + own * math.sqrt(dot(w, w))


@kernel
def time_off_profile(system, contact, state, bounds, h, work):
    """Return how long, up to h, a profile and another solid stay apart; h < 0: in the past."""
    first = system.solids[contact.solid].kind == PROFILE
    bend = system.solids[contact.solid if first else contact.other_solid].bend
    a = bound_in_frame(system, contact, 0 if first else 1, bounds, state, h)
    speed, sign = speed_past_profile(system, contact, first, state), 1.0 if h > 0.0 else -1.0
    most = speed + a * abs(h)
    way = (speed + 0.5 * a * abs(h)) * abs(h)
    curved = bend * way <= 0.125
    bent = a + 2.0 * bend * most * most if bend > 0.0 else a
    list_on_solid(system, contact, contact.other_solid, state, way, work)
    time = abs(h)
    for i in range(work.pair.state[0].total):
        touch = work.touches[i]
        if curved and touch.owner == NOBODY:
            t = reach(touch.gap, sign * touch_rate(contact, touch, state), bent)
        else:
            t = reach(touch.gap, -speed, a)
        time = min(time, t)
    return time
