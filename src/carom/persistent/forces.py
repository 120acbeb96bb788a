"""Forces of several held points in one state: the contact problem at the level of accelerations.

    a = W f + c,    0 <= f_n _|_ a_n >= 0,    Coulomb's law for f_t:

against the slip where there is slip, in the cone against the acceleration of slip where there is none. Forces
need not be unique (four corners of a box); accelerations are.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.gap import slow
from carom.contact.place import drift_of
from carom.dynamics.acceleration import acceleration
from carom.dynamics.several_points import accelerations, inverse_masses, velocities
from carom.friction.layout import CONE, ENOUGH, SLIDING
from carom.friction.solve import solve_cones
from carom.impact.workspace import OLD, C, P, U
from carom.persistent.rolling_friction import bound_turning, take_torque


@kernel
def pose_forces(system, controls, held, k, state, cluster, work):
    """Write W, u, and c = du/dt without contact forces, of the k points of the cluster, and how each slips."""
    acceleration(system, state, held, work, work.stages[0])
    inverse_masses(system, k, cluster.points[0], state, work, cluster.m[0])
    velocities(k, cluster.points[0], state, cluster.v[U])
    accelerations(k, cluster.points[0], state, work.stages[0], cluster.v[C])
    for i in range(k):
        seat = cluster.seats[i]
        contact = system.contacts[seat.contact]
        if contact.touches != 0 and seat.turns == 0:
            d = drift_of(
                system, contact, seat.feature, seat.point, cluster.points[0][i], state, work
            )
            for r in range(3):
                cluster.v[C][3 * i + r] += d[r]
    push = 0.0
    for i in range(3 * k):
        push = max(push, abs(cluster.v[C][i]))
    for i in range(k):
        contact = system.contacts[cluster.seats[i].contact]
        cluster.mu[i] = contact.friction_held if cluster.seats[i].turns == 0 else 1.0
        still = max(10.0 * slow(contact, state), controls.rest * push * controls.step)
        set_heading(cluster, i, cluster.v[U][3 * i + 1], cluster.v[U][3 * i + 2], still)


@kernel
def set_heading(cluster, i, u1, u2, still):
    """Let point i slide along (u1, u2), or look for its direction where that is below `still`."""
    speed = math.sqrt(u1 * u1 + u2 * u2)
    if speed > still:
        cluster.kind[i] = SLIDING
        cluster.heading[i, 0], cluster.heading[i, 1] = u1 / speed, u2 / speed
    else:
        cluster.kind[i] = CONE
        cluster.heading[i, 0], cluster.heading[i, 1] = 0.0, 0.0


@kernel
def solve_forces(system, k, cluster):
    """Write the forces of the points that stay into p, and the accelerations of all k into `old`."""
    turning = False
    for i in range(k):
        turning = turning or cluster.seats[i].turns > 0
    for i in range(3 * k):
        cluster.v[P][i] = 0.0
    status = solve_once(k, cluster)
    for _ in range(50 if turning else 0):
        if not bound_turning(system, k, cluster) > 1e-14:
            break
        status = solve_once(k, cluster)
    return status


@kernel
def solve_once(k, cluster):
    """Write forces and accelerations, for bounds of torques that are known."""
    W, M, b, p = cluster.m[0], cluster.m[1], cluster.v[OLD], cluster.v[P]
    n = 3 * k
    for i in range(n):
        stays = cluster.seats[i // 3].stays == 1
        for j in range(n):
            both = stays and cluster.seats[j // 3].stays == 1
            M[i, j] = W[i, j] if both else 1.0 if i == j else 0.0
        b[i] = cluster.v[C][i] if stays else 1.0 if i % 3 == 0 else 0.0
    cluster.cone.mismatch[ENOUGH] = 0.0  # to round-off
    status, _, _ = solve_cones(k, M, b, cluster.mu, cluster.kind, cluster.heading, p, cluster.cone)
    for i in range(n):
        a = cluster.v[C][i]
        for j in range(n):
            a += W[i, j] * p[j]
        b[i] = a
    return status


@kernel
def time_to_stop(i, cluster):
    """Return when slip of point i stops, going on as it does: speed over the deceleration along it."""
    d1, d2 = cluster.heading[i, 0], cluster.heading[i, 1]
    speed = cluster.v[U][3 * i + 1] * d1 + cluster.v[U][3 * i + 2] * d2
    rate = cluster.v[OLD][3 * i + 1] * d1 + cluster.v[OLD][3 * i + 2] * d2
    return speed / -rate if cluster.kind[i] == SLIDING and rate < 0.0 else math.inf


@kernel
def take_forces(hold, i, cluster):
    """Put the force of point i into the list, its W, and when its slip stops; or its torque."""
    turns = cluster.seats[i].turns
    if turns > 0:
        hold.turn_stop[turns - 1] = time_to_stop(i, cluster)
        take_torque(hold, i, cluster)
        return
    hold.stop = time_to_stop(i, cluster)
    for r in range(3):
        hold.force[r] = cluster.v[P][3 * i + r]
        for j in range(3):
            hold.W[r, j] = cluster.m[0][3 * i + r, 3 * i + j]
