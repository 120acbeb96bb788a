"""Closed points that move alike become one contact at their mean point: an edge or a face that strikes flat.

If all points of a contact have the same velocity u, and an impulse at their mean point changes all their
velocities equally, then their velocities stay equal in the whole boundary layer, and they share the impulse.
In planar motion only impulses in the plane count: those along n and along the slip d, if neither moves a body
out of the plane.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.gap import slow
from carom.dynamics.contact_impulse import effective_inverse_mass, spread
from carom.dynamics.several_points import inverse_masses_of_one, of_one_body
from carom.kinematics.contact_point import contact_motion, contact_velocity, copy_point, place

SAME = 1e-12  # relative to W_nn: round-off of a difference of two velocities


@kernel
def as_one(system, k, state, group, work):
    """Return whether the k closed points move as one contact; then `work` has its point, W and u."""
    hit, point, closed = work.hit[0], work.point[0], group.closed
    c = closed[0].contact
    contact, core = system.contacts[c], hit.point
    if contact.touches != 0:
        if k > 1:
            return False
        copy_point(group.points[0][0], point)
        _inverse_mass(system, state, work)
        hit.u[0], hit.u[1], hit.u[2] = contact_velocity(point, state)
        return True
    for r in range(3):
        core[r] = 0.0
        for i in range(k):
            core[r] += closed[i].point[r] / k
    for i in range(k):
        if closed[i].contact != c:
            return False
    place(contact, core, state, point)
    _inverse_mass(system, state, work)
    hit.u[0], hit.u[1], hit.u[2] = contact_velocity(point, state)
    if k == 1:
        return True
    still = 10.0 * slow(contact, state)
    for i in range(k):
        u = contact_velocity(group.points[0][i], state)
        for r in range(3):
            if not abs(u[r] - hit.u[r]) <= still:
                return False
    W, tiny = hit.W, SAME * hit.W[0, 0]
    # impulses to compare: along the normal; then along both tangents, or, in the plane, along slip only
    if not answers_alike(system, k, (1.0, 0.0, 0.0), state, group, work):
        return False
    if answers_alike(system, k, (0.0, 1.0, 0.0), state, group, work) and answers_alike(
        system, k, (0.0, 0.0, 1.0), state, group, work
    ):
        return True
    d1, d2 = hit.u[1], hit.u[2]
    speed = math.sqrt(d1 * d1 + d2 * d2)
    if not speed > still:
        d1, d2 = W[1, 0], W[2, 0]  # slip starts along the coupling with the normal
        speed = math.sqrt(d1 * d1 + d2 * d2)
        if not speed > tiny:
            return True  # slip never begins: impulses are normal
    d1, d2 = d1 / speed, d2 / speed
    t1, t2 = W[1, 1] * d1 + W[1, 2] * d2, W[2, 1] * d1 + W[2, 2] * d2
    planar = abs(W[2, 0] * d1 - W[1, 0] * d2) <= tiny and abs(t2 * d1 - t1 * d2) <= tiny
    return planar and answers_alike(system, k, (0.0, d1, d2), state, group, work)


@kernel
def _inverse_mass(system, state, work):
    """Write W of the point in `work`; for one free body it is in closed form."""
    points, W = work.point, work.hit[0].W
    if of_one_body(system, 1, points):
        inverse_masses_of_one(system.bodies[points[0].a], 1, points, state, W)
    else:
        effective_inverse_mass(system, points[0], state, work, W)


@kernel
def answers_alike(system, k, impulse, state, group, work):
    """Return whether an impulse at the mean point changes the velocity of all points equally."""
    point, tiny = work.point[0], SAME * work.hit[0].W[0, 0]
    spread(system, point, state, impulse[0], impulse[1], impulse[2], work)
    mean = contact_motion(point, work)
    for i in range(k):
        u = contact_motion(group.points[0][i], work)
        for r in range(3):
            if not abs(u[r] - mean[r]) <= tiny:
                return False
    return True
