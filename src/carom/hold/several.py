"""Several closed points of one group: which of them are held from now on, which open."""

from __future__ import annotations

import math

from carom.contact.gap import slow
from carom.coulomb.layout import SLIDING
from carom.hold.forces import pose_forces, solve_forces, take_forces
from carom.hold.one import bounces_end
from carom.hold.roster import enlist, strike_off
from carom.jit import kernel
from carom.motion.acceleration import SLIP, STICK
from carom.motion.contact_point import add_velocity, contact_velocity, spread
from carom.motion.several import factor, substitute
from carom.system.cluster import OLD, C, U
from carom.system.notes import begin_event, end_event
from carom.system.records import HOLD, OPENS

DROP = 1e-10  # of a pivot, relative to its row


@kernel
def hold_several(system, controls, held, k, group, state, horizon, cluster, work, clock, records):
    """Judge all k closed points of a group; take the new ones in, strike off those that open."""
    pose_forces(system, controls, held, k, state, cluster, work)
    judge(system, k, state, horizon, cluster)
    new, stay = -1, False
    for i in range(k):
        seat = cluster.seats[i]
        stay = stay or seat.stays == 1
        if new < 0 and seat.stays == 1 and seat.held < 0:
            new = i
        if seat.stays == 0 and cluster.v[U][3 * i] <= slow(system.contacts[seat.contact], state):
            held.brinks[seat.contact].leaving = 1  # lifts off without speed
    if new >= 0:
        seat = cluster.seats[new]
        begin_event(system, seat.contact, seat.feature, state, clock, records)
    if stay:
        drop_bounces(system, k, state, cluster, work, clock)
        set_modes(system, held, k, state, cluster, work, clock, records)
        first_forces(system, controls, held, k, state, cluster, work)
    strike_off_open(system, held, k, group, state, cluster, work, clock, records)


@kernel
def judge(system, k, state, horizon, cluster):
    """Mark the points that stay.

    First those that do not leave, as far as they press; then those whose bounces end within `horizon` under the
    acceleration that these leave them; then those for which that is so under the new ones, and so on: what lies
    on a body that falls comes to rest only with it.
    """
    for i in range(k):
        contact, u = system.contacts[cluster.seats[i].contact], cluster.v[U][3 * i]
        cluster.seats[i].stays = 1 if abs(u) <= slow(contact, state) else 0
    push = 0.0
    for i in range(3 * k):
        push = max(push, abs(cluster.v[C][i]))
    for turn in range(k + 1):
        solve_forces(k, cluster)
        more = False
        for i in range(k):
            contact, u = system.contacts[cluster.seats[i].contact], cluster.v[U][3 * i]
            a = cluster.v[OLD][3 * i]
            if cluster.seats[i].stays == 0:
                if bounces_end(contact, u, -a, slow(contact, state), horizon):
                    cluster.seats[i].stays, more = 1, True
            elif turn == 0 and not a <= 1e-10 * push:
                cluster.seats[i].stays = 0
        if not more:
            break


@kernel
def drop_bounces(system, k, state, cluster, work, clock):
    """Take out the normal velocities of the points that stay, in the kinetic metric."""
    n, L, x = k, cluster.m[1], cluster.v[OLD]
    for i in range(n):
        stays = cluster.seats[i].stays == 1
        x[i] = -cluster.v[U][3 * i] if stays else 0.0
        for j in range(n):
            both = stays and cluster.seats[j].stays == 1
            L[i, j] = cluster.m[0][3 * i, 3 * j] if both else 1.0 if i == j else 0.0
    factor(n, DROP, L)
    substitute(n, L, x)
    for i in range(n):
        if cluster.seats[i].stays == 1 and x[i] != 0.0:
            spread(system, cluster.points[0][i], state, x[i], 0.0, 0.0, work)
            add_velocity(system, cluster.points[0][i], work, state)
            # work of the impulses: half of them times the velocities before; after they are none
            clock.bounces += 0.5 * x[i] * cluster.v[U][3 * i]


@kernel
def set_modes(system, held, k, state, cluster, work, clock, records):
    """Take the new points in, slipping or sticking, with an event each; the first is begun already."""
    begun = True
    for i in range(k):
        seat = cluster.seats[i]
        if seat.stays == 0:
            continue
        contact = system.contacts[seat.contact]
        _, u1, u2 = contact_velocity(cluster.points[0][i], state)
        # as `pose_forces` has found with the velocities before
        still = 10.0 * slow(contact, state)
        mode = (
            SLIP if math.sqrt(u1 * u1 + u2 * u2) > still and cluster.kind[i] == SLIDING else STICK
        )
        if seat.held >= 0:
            held.points[seat.held].mode = mode
            continue
        if not begun:
            begin_event(system, seat.contact, seat.feature, state, clock, records)
        begun = False
        seat.held = enlist(system, held, seat, mode, state, work)
        clock.holds += 1
        end_event(system, HOLD, state, clock, records)


@kernel
def first_forces(system, controls, held, k, state, cluster, work):
    """Put the forces of the points that stay into the list, and the times at which their slip stops."""
    for i in range(k):
        if cluster.seats[i].stays == 1:
            held.points[cluster.seats[i].held].several = 1
    pose_forces(system, controls, held, k, state, cluster, work)
    solve_forces(k, cluster)
    for i in range(k):
        if cluster.seats[i].stays == 1:
            take_forces(held.points[cluster.seats[i].held], i, cluster)


@kernel
def strike_off_open(system, held, k, group, state, cluster, work, clock, records):
    """Strike off the held points of the group that do not stay."""
    for j in range(held.count[0] - 1, -1, -1):
        hold = held.points[j]
        if work.body[hold.body].group != group:
            continue
        for i in range(k):
            seat = cluster.seats[i]
            if seat.contact == hold.contact and seat.feature == hold.feature and seat.stays == 0:
                begin_event(system, seat.contact, seat.feature, state, clock, records)
                strike_off(held, j)
                end_event(system, OPENS, state, clock, records)
                break
