"""The operations of a contact, whatever its kind: what the rest of the library asks of it.

Each is stated in the form of two convex solids; a kind with another form has it in its file of
`carom.contact.kinds`, by the same name. Points that are *found* anew in each state are written to
`work.touches`; those of the other kinds are known.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.continuous_detection import reach as reach_within
from carom.contact.gap import round_off, slow
from carom.contact.kinds import by_kind
from carom.contact.kinds.curvature import curvature, place_and_axes
from carom.contact.kinds.drift import drift_of_solids
from carom.contact.kinds.found_points import (
    list_on_solid,
    nearest_touch,
    own_point,
    touch_rate,
    which_touch,
    write_touch,
)
from carom.contact.kinds.level_surfaces import keep_counting
from carom.contact.kinds.parting import (
    plane_of,
    time_beside,
)
from carom.contact.kinds.partner import (
    balls,
    centre_of_other,
    closed_within,
    round_off_of_both,
    smaller,
    solids_stay_far,
)
from carom.contact.kinds.rim import closed_rim, most_of_rim, place_of
from carom.contact.point_lists import write_closed
from carom.contact.thresholds import ACTIVE_REACH, REACH
from carom.geometry.rotation import norm
from carom.geometry.vectors import dot, minus
from carom.kinematics.flexible import greatest_ringing
from carom.model.actions import NOTHING, PERSIST, STRIKE
from carom.model.contact_kinds import FOUND
from carom.status import NOT_FINITE

# how far


@by_kind("contact")
def room(system, contact, state, pieces):
    """Return a lower bound of the gap [m], by the balls around both, or around the `pieces` that may touch."""
    x, y, radii = balls(system, contact, state, pieces)
    d = minus(x, y)
    return math.sqrt(dot(d, d)) - radii


@by_kind("contact")
def distance(system, contact, state, work):
    """Return a lower bound of the gap [m], by the nearest points where they are known to be that."""
    return room(system, contact, state, False)


@kernel
def apart(system, contact, state, near):
    """Return whether the room around both bodies, or around two pieces of them, is larger than `near`."""
    for pieces in range(1 + contact.part):
        if room(system, contact, state, pieces == 1) > near:
            return True
    return False


@by_kind("contact")
def beside_face(system, contact, state, near):
    """Return whether a face of a box shows that the gap is above `near`."""
    return False


@by_kind("contact")
def closing_speed(system, contact, state, work):
    """Return a bound of the speed at which any points of both approach each other [m/s]."""
    a, b = state[contact.body], contact.other
    s, v0, v1, v2 = contact.extent * norm(a.w), a.v[0], a.v[1], a.v[2]
    if contact.bends == 1:
        s += greatest_ringing(system, contact.body, b, state)
    if b >= 0:
        s += contact.other_extent * norm(state[b].w)
        v0, v1, v2 = v0 - state[b].v[0], v1 - state[b].v[1], v2 - state[b].v[2]
    return s + math.sqrt(v0 * v0 + v1 * v1 + v2 * v2)


@by_kind("contact")
def turning_radius(system, contact):
    """Return the way across its normal over which a contact turns round [m]; inf where a body turns it."""
    return math.inf


# which points


@by_kind("contact")
def list_touches(system, contact, state, reach, work):
    """Find all points with gaps up to the least plus `reach`, also hidden ones; return how many, at least 1."""
    return list_on_solid(system, contact, contact.other_solid, state, reach, work)


@kernel
def find_touches(system, contact, state, reach, work):
    """Find the points that count, which no level surface hides; return how many, perhaps none."""
    list_touches(system, contact, state, reach, work)
    return keep_counting(system, contact, state, work)


@by_kind("contact")
def active_reach(system, contact):
    """Return how far above the least gap active points are sought, in the iterations of a step."""
    return ACTIVE_REACH * smaller(contact)


@by_kind("contact")
def touch_of_active(system, contact, feature, p, state, work):
    """Find the points; return which has a feature, or replaces the one that was at p (body axes)."""
    list_touches(system, contact, state, active_reach(system, contact), work)
    return which_touch(system, contact, feature, p, state, work)


@unit
def find_active_touch(system, contact, feature, p, state, work) -> int:
    """Return the place of an active touch in `work.touches`: the kinds are one unit."""
    return touch_of_active(system, contact, feature, p, state, work)


@by_kind("contact")
def place(system, contact, known, state, point, work):
    """Write an active or a listed point, or the point that replaces it, in a state."""
    i = find_active_touch(system, contact, known.feature, known.point, state, work)
    write_touch(contact, work.touches[i], state, point)


@by_kind("model.system.contacts[c]")
def add_points(model, data, c, state, within, spots):
    """Add the points within a distance to a list; return whether there is room.

    `within` is the distance, and a time: a rim that is flat within it counts as flat, with all its points.
    """
    system, work, (near, rim_time) = model.system, data.work, within
    near = find_closed(system, system.contacts[c], near, rim_time, state, work)
    return add_touches(system.contacts[c], c, near, state, spots, work)


@kernel
def find_closed(system, contact, near, rim_time, state, work):
    """Find the points that may be within `near`; return the gap up to which they are closed.

    It is `near`, or more for a rim that is flat within `rim_time`.
    """
    if beside_face(system, contact, state, max(near, most_of_rim(contact, state, rim_time))):
        work.pair.state[0].total = 0
        return near
    count = find_touches(system, contact, state, max(near, REACH * smaller(contact)), work)
    if rim_time > 0.0 and count > 0:
        near = max(near, closed_rim(system, contact, work.touches[0].normal, state, rim_time))
    return near


@kernel
def add_touches(contact, c, near, state, spots, work):
    """Add the found points that are within `near` to a list; return whether there is room."""
    for i in range(work.pair.state[0].total):
        k, touch = spots.count[0], work.touches[i]
        if touch.gap <= near:
            if k == spots.closed.shape[0]:
                return False
            add_touch(contact, c, touch, state, k, spots)
            spots.count[0] = k + 1
    return True


@kernel
def add_touch(contact, c, touch, state, k, group):
    """Write a found point as point k of a list."""
    own_point(contact, touch, state, group.closed[k].point)
    write_closed(c, touch.feature, group.closed[k].point, k, group.closed[k])
    write_touch(contact, touch, state, group.points[0][k])


@by_kind("contact")
def is_fixed(contact):
    """Return whether the points stay where they are on the body."""
    return False


@kernel
def is_found(contact):
    """Return whether the points are found anew in each state."""
    return contact.kind in FOUND


@by_kind("contact")
def forms_faces(contact):
    """Return whether points of one plane belong together, so that all corners of a face carry."""
    return True


@by_kind("contact")
def are_sharp(system, contact):
    """Return whether the normal may jump where an edge passes an edge."""
    return False


# gaps and rates


@kernel
def worst_of_touches(work):
    """Return the least gap below 0 of the found points; -inf if a function of a surface has no value."""
    least = 0.0
    for i in range(work.pair.state[0].total):
        gap = work.touches[i].gap
        least = min(least, gap if gap == gap else -math.inf)
    return least


@unit
def least_of_touches(system, contact, state, work) -> float:
    """Return the least gap of the points that count, if it is below 0."""
    find_touches(system, contact, state, 0.0, work)
    return worst_of_touches(work)


@by_kind("contact")
def least_gap(system, contact, state, work):
    """Return the least gap [m], negative inside; 0 for two solids outside of each other."""
    return least_of_touches(system, contact, state, work)


@by_kind("contact")
def bulge(system, contact, state, work):
    """Return how deep the other side is in a face turned to it, beyond its points, relative to the body."""
    return 0.0


@kernel
def lowest_open(system, data, c, state):
    """Return the least gap of the points in work.touches that are not active, and its rate.

    It is nan where a contact has no gap (`lost_gap`): the search for this event ends the run.
    """
    least, rate, work = math.inf, 0.0, data.work
    for i in range(work.pair.state[0].total):
        touch = work.touches[i]
        if not touch.gap >= least and place_of(system, data.active, c, touch, state) < 0:
            least, rate = touch.gap, touch_rate(system.contacts[c], touch, state)
    return least, rate


@unit
def lowest_found(system, data, c, state) -> tuple[float, float]:
    """Return the least gap of the found points that are not active, and its rate."""
    contact = system.contacts[c]
    find_touches(system, contact, state, REACH * smaller(contact), data.work)
    return lowest_open(system, data, c, state)


@by_kind("system.contacts[c]")
def event_gap(system, data, c, state):
    """Return the gap whose zero is an impact, and its rate: active points are left out."""
    return lowest_found(system, data, c, state)


@by_kind("contact")
def lost_gap(contact):
    """Return the number of the status of a run in which a contact has no gap."""
    return NOT_FINITE


@by_kind("contact")
def rounding(contact, state):
    """Return the round-off of a gap [m]."""
    return 4.0 * round_off_of_both(contact, state)


@by_kind("contact")
def located_within(controls, contact, state):
    """Return the gap within which an impact is located [m]."""
    return 4.0 * max(
        max(controls.gap * smaller(contact), round_off(contact, state)),
        round_off_of_both(contact, state),
    )


@by_kind("system.contacts[c]")
def first_inside(system, data, c):
    """Return a guess of the time when the first point passes the other side in the trial step; inf for none."""
    return math.inf


@by_kind("contact")
def strike_point(system, contact, state, tie, out):
    """Write the point of the core that strikes, by which a body returns to the surface; its gap and rate.

    Found points are within the tolerance of a located gap, and need no return.
    """
    return 0.0, 0.0


@by_kind("model.system.contacts[c]")
def due(model, data, c):
    """Return whether a closed point that is not active is to be struck or made persistent."""
    return due_of_found(model, data, c)


@unit
def due_of_found(model, data, c) -> int:
    """Return this for points that are found."""
    system, now, active, work = model.system, data.state, data.active, data.work
    contact, action = system.contacts[c], NOTHING
    near, still = closed_within(model.controls, contact, now), slow(contact, now)
    if apart(system, contact, now, near) or beside_face(system, contact, now, near):
        return NOTHING
    for i in range(find_touches(system, contact, now, REACH * smaller(contact), work)):
        touch = work.touches[i]
        if touch.gap <= near:
            rate = touch_rate(contact, touch, now)
            if rate < -still:
                return STRIKE
            if rate <= still and place_of(system, active, c, touch, now) < 0:
                action = PERSIST
    return action


# how rows and surfaces change


@by_kind("contact")
def drift(system, contact, feature, point, state, work):
    """Return (d/dt G) v, contact axes: the change of the velocity at the point for constant velocities.

    The point must have been written for this state.
    """
    return drift_of_solids(system, contact, contact.other_solid, point, state)


@unit
def drift_of_row(system, contact, feature, point, state, work) -> tuple[float, float, float]:
    """Return (d/dt G) v of a point of a contact, for all kinds in one unit."""
    return drift(system, contact, feature, point, state, work)


@by_kind("contact")
def curvatures(system, contact, point, state):
    """Return the sums of the curvatures of both surfaces at a point, t t, t s and s s [1/m]."""
    frame = place_and_axes(point, state)
    a11, a12, a22 = curvature(system, contact.solid, contact.body, state, frame)
    b11, b12, b22 = curvature(system, contact.other_solid, contact.other, state, frame)
    return a11 + b11, a12 + b12, a22 + b22


# a trial step


@by_kind("contact")
def stays_far(system, data, contact):
    """Return the bounds of `relative_bound`, and whether balls around both stay apart in the trial step."""
    return solids_stay_far(system, data, contact)


@by_kind("contact")
def stays_beside_face(system, data, contact, smooth, tiny, bounds):
    """Return whether faces of boxes show that both stay apart in the trial step."""
    return False


@by_kind("contact")
def time_apart(system, contact, state, bounds, h, work):
    """Return how long, up to |h|, both stay apart, from the found points of a state; h < 0: in the past.

    And a bound of the acceleration with which a gap may close; `bounds` are those of `relative_bound`.
    """
    nearest = nearest_touch(work)
    if contact.bends == 1:  # a plane beside an undeformed body says nothing of its modes
        speed = closing_speed(system, contact, state, work)
        return min(abs(h), reach_within(nearest.gap, -speed, bounds[1])), bounds[1]
    return time_beside(system, contact, plane_of(nearest), state, bounds, h), bounds[1]


@by_kind("contact")
def way_past(contact, data):
    """Return the relative displacement in the trial step, from the larger relative velocity of the centres."""
    most = 0.0
    for state in (data.state, data.work.trial):
        v, y = state[contact.body].v, centre_of_other(contact, state)
        most = max(most, (v[0] - y[3]) ** 2 + (v[1] - y[4]) ** 2 + (v[2] - y[5]) ** 2)
    return data.work.search[0].dt * math.sqrt(most)
