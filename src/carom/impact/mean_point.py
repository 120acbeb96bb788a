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
from carom.contact.operations import is_fixed
from carom.dynamics.delassus import inverse_masses
from carom.geometry.thresholds import ROUND_OFF
from carom.kinematics.contact_point import contact_velocity, copy_point, place


@kernel
def as_one(system, k, state, group, work):
    """Return whether the k closed points move as one contact; then `work` has its point, W and u.

    If there are several, `group` has the W and u of all of them.
    """
    hit, point, closed = work.hit[0], work.struck[0], group.closed
    contact, core = system.contacts[closed[0].contact], hit.point
    for i in range(1, k):
        if not is_fixed(contact) or closed[i].contact != closed[0].contact:
            return False
    if not is_fixed(contact):
        copy_point(group.points[0][0], point)
    else:
        for r in range(3):
            core[r] = 0.0
            for i in range(k):
                core[r] += closed[i].point[r] / k
        place(contact, core, state, point)
    inverse_masses(system, 1, work.struck, state, work, hit.W)
    hit.u[0], hit.u[1], hit.u[2] = contact_velocity(system, point, state)
    return k == 1 or move_alike(k, group.u, group.problem.W, hit, 10.0 * slow(contact, state))


@kernel
def move_alike(k, u, all_W, hit, still):
    """Return whether k points, with the velocities `u` and `all_W`, move as their mean point in `hit`."""
    for a in range(3 * k):
        if not abs(u[a] - hit.u[a % 3]) <= still:
            return False
    W, tiny = hit.W, ROUND_OFF * hit.W[0, 0]
    # impulses to compare: along the normal; then along both tangents, or, in the plane, along slip only
    if not answers_alike(k, all_W, W, (1.0, 0.0, 0.0)):
        return False
    if answers_alike(k, all_W, W, (0.0, 1.0, 0.0)) and answers_alike(k, all_W, W, (0.0, 0.0, 1.0)):
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
    return planar and answers_alike(k, all_W, W, (0.0, d1, d2))


@kernel
def answers_alike(k, all_W, W, impulse):
    """Return whether an impulse, shared by k points, changes the velocity of each as that of the mean point."""
    for a in range(3 * k):
        difference = 0.0
        for r in range(3):
            shared = 0.0
            for j in range(k):
                shared += all_W[a, 3 * j + r] / k
            difference += (shared - W[a % 3, r]) * impulse[r]
        if not abs(difference) <= ROUND_OFF * W[0, 0]:
            return False
    return True
