"""Vertices of a body, perhaps enlarged by a ball, on a half-space: points that stay where they are."""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.contact import gap as gaps
from carom.contact.continuous_detection import (
    BELOW,
    CLEAR,
    UNSURE,
    arrives,
    cubic_clears,
    cubic_root,
    reach,
    time_of_hop,
)
from carom.contact.gap import round_off, slow
from carom.contact.kinds import half_space
from carom.contact.kinds.half_space import along_normal, ball_clears, greatest_acceleration
from carom.contact.point_lists import write_closed
from carom.geometry.rotation import cross, rotate_back
from carom.geometry.thresholds import RESOLUTION, ROUND_OFF
from carom.kinematics import contact_point
from carom.model.actions import NOTHING, PERSIST, STRIKE
from carom.model.workspace import FREE, RESTS

room, located_within = half_space.room, gaps.located_within
rounding = round_off


@kernel
def plane_in_body(contact, state):
    """Return the plane in body axes: n and n x w, and the height and speed of the mass centre.

    A core point p then has the gap height + n.p and the rate speed + (n x w).p, because (w x R p).n =
    R p.(n x w). This needs two products for each vertex instead of two rotations.
    """
    body, n = state[contact.body], contact.axes
    q, w = body.Q, body.w
    nx, ny, nz = rotate_back(q, n[0])
    wx, wy, wz = rotate_back(q, w)
    cx, cy, cz = cross(nx, ny, nz, wx, wy, wz)
    height = along_normal(contact, body.x) - contact.offset - contact.radius
    return nx, ny, nz, cx, cy, cz, height, along_normal(contact, body.v)


@kernel
def gap_and_rate(plane, p):
    """Return the gap of the core point p (body axes) and its rate; `plane` is from `plane_in_body`."""
    return (
        plane[6] + plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2],
        plane[7] + plane[3] * p[0] + plane[4] * p[1] + plane[5] * p[2],
    )


@kernel
def lowest(contact, vertices, state):
    """Return rho, the least distance of the body from the half-space (negative inside), and its rate."""
    plane = plane_in_body(contact, state)
    least, its_rate = math.inf, 0.0
    for i in range(contact.first, contact.last):
        z, rate = gap_and_rate(plane, vertices[i])
        if z < least:
            least, its_rate = z, rate
    return least, its_rate


@kernel
def is_fixed(contact):
    """Return True."""
    return True


@kernel
def least_gap(system, contact, state, work):
    """Return the least gap of all vertices."""
    return lowest(contact, system.vertices, state)[0]


@kernel
def event_gap(system, data, c, state):
    """Return the least gap of the vertices that carry no persistent contact, and its rate."""
    contact, least, its_rate = system.contacts[c], math.inf, 0.0
    plane = plane_in_body(contact, state)
    for i in range(contact.first, contact.last):
        z, rate = gap_and_rate(plane, system.vertices[i])
        if z < least and data.active.carries[i] == 0:
            least, its_rate = z, rate
    return least, its_rate


@kernel
def strike_point(system, contact, state, tie, out):
    """Write the lowest core point (3,), in body axes; return its gap and its rate.

    Vertices within `tie` of the lowest form one contact at their mean point: an edge or a face strikes at its
    centre, so that planar motion stays planar. If only some of them approach, only these count.
    """
    plane, vertices = plane_in_body(contact, state), system.vertices
    still = slow(contact, state)
    least, approaching = lowest(contact, vertices, state)[0], False
    for i in range(contact.first, contact.last):
        z, rate = gap_and_rate(plane, vertices[i])
        if z <= least + tie and rate < -still:
            approaching = True
    count, z_mean, rate_mean = 0, 0.0, 0.0
    p0, p1, p2 = 0.0, 0.0, 0.0
    for i in range(contact.first, contact.last):
        z, rate = gap_and_rate(plane, vertices[i])
        if z <= least + tie and (rate < -still or not approaching):
            count += 1
            z_mean += z
            rate_mean += rate
            p0, p1, p2 = p0 + vertices[i, 0], p1 + vertices[i, 1], p2 + vertices[i, 2]
    f = 1.0 / count
    out[0], out[1], out[2] = f * p0, f * p1, f * p2
    return f * z_mean, f * rate_mean


@kernel
def place(system, contact, known, state, point, work):
    """Write the contact point of a vertex."""
    contact_point.place(contact, known.point, state, point)


@kernel
def drift(system, contact, feature, point, state, work):
    """Return zeros: the vertex stays where it is on its body."""
    return 0.0, 0.0, 0.0


@inlined
def passage(model, data, c):
    """Return CLEAR, BELOW (a vertex is inside at the end) or UNSURE, and a time before any contact.

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
    still = slow(contact, end)
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
            pushed = pushed and time_of_hop(z0, rate0, z1, rate1, h, tiny) == 0.0
            if not (z0 <= tiny and (pushed or (z0 < -tiny and z1 >= z0))):
                verdict = BELOW
        elif (
            verdict == CLEAR
            and t0 + reach(z1, -rate1, a) < h * (1.0 - ROUND_OFF)
            and sag > tiny  # what could be missed is more than the tolerance
            and data.active.contact_states[c].leaving == 0
            and not (smooth and cubic_clears(z0, rate0, z1, rate1, h, tiny))
        ):
            verdict = UNSURE
        if arrives(z0, rate0, z1, rate1, tiny, still):
            data.active.contact_states[c].near = 1
    return verdict, first


@inlined
def due(model, data, c):
    """Return whether a closed vertex is to be struck or made persistent."""
    system, now, active = model.system, data.state, data.active
    contact = system.contacts[c]
    near, still = model.controls.tie * contact.extent, slow(contact, now)
    plane = plane_in_body(contact, now)
    action = NOTHING
    for i in range(contact.first, contact.last):
        z, rate = gap_and_rate(plane, system.vertices[i])
        if z <= near and rate < -still:
            return STRIKE
        if z <= near and rate <= still and active.carries[i] == 0:
            action = PERSIST
    return action


@kernel
def add_points(model, data, c, state, within, spots):
    """Add the vertices within a distance, or active, to a list; return whether there is room."""
    system, (near, _) = model.system, within
    contact = system.contacts[c]
    plane = plane_in_body(contact, state)
    for i in range(contact.first, contact.last):
        z, _ = gap_and_rate(plane, system.vertices[i])
        if z <= near or data.active.carries[i] == 1:
            k = spots.count[0]
            if k == spots.closed.shape[0]:
                return False
            write_closed(c, i, system.vertices[i], k, spots.closed[k])
            contact_point.place(contact, spots.closed[k].point, state, spots.points[0][k])
            spots.count[0] = k + 1
    return True


@kernel
def curvatures(system, contact, point, state):
    """Return those of the ball that enlarges a vertex: t t, t s, s s."""
    return 1.0 / contact.radius, 0.0, 1.0 / contact.radius


@kernel
def first_inside(system, data, c):
    """Return a guess of the time when the first vertex passes the plane, by the cubic of each one inside."""
    contact, search, first = system.contacts[c], data.work.search[0], math.inf
    before, after = plane_in_body(contact, data.state), plane_in_body(contact, data.work.trial)
    for i in range(contact.first, contact.last):
        z, rate = gap_and_rate(after, system.vertices[i])
        if z < -search.tolerance and data.active.carries[i] == 0:
            z0, rate0 = gap_and_rate(before, system.vertices[i])
            first = min(first, cubic_root(0.0, z0, rate0, search.dt, z, rate))
    return first
