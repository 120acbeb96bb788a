"""Several closed points of one group: which of them persist from now on, which open."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.closed_points import gather_held
from carom.contact.gap import slow
from carom.contact.groups import members
from carom.dynamics.acceleration import SLIP, STICK
from carom.dynamics.contact_impulse import (
    add_velocity,
    alone,
    spread,
)
from carom.dynamics.elements import driven_power
from carom.dynamics.several_points import factor, substitute
from carom.friction.layout import CONE, SLIDING
from carom.impact.workspace import OLD, C, P, U
from carom.kinematics.contact_point import contact_velocity
from carom.model.event_rows import begin_event, end_event
from carom.model.records import HOLD, OPENS, SLIPS, STICKS
from carom.persistent.active_set import enlist, set_anchor, strike_off
from carom.persistent.forces import pose_forces, solve_forces, take_forces, time_to_stop
from carom.persistent.jam import jams_among, note_jam
from carom.persistent.one_point import bounces_end, name_work, spare

DROP = 1e-10  # of a pivot, relative to its row
ROUNDS = 60  # of friction with what it does to the normal impulses


@kernel
def hold_several(model, data, k, group, horizon):
    """Judge all k closed points of a group; take the new ones in, strike off those that open."""
    system, controls = model.system, model.controls
    held, state, cluster, work, clock, records = (
        data.held,
        data.state,
        data.cluster,
        data.work,
        data.clocks[0],
        data.records,
    )
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
        drop_bounces(model, data, k, group, horizon)
        set_modes(model, data, k)
    strike_off_open(model, data, k, group)
    look_again(system, held, k, state, cluster)
    if stay:
        first_forces(model, data, group)


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
        solve_forces(system, k, cluster)
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
def stops(cluster, i):
    """Return whether row i is one that drops out: the normal of a point that stays, its slip if it has none."""
    return cluster.seats[i // 3].stays == 1 and (i % 3 == 0 or cluster.kind[i // 3] == CONE)


@kernel
def speed_of(system, state, count, member):
    """Return the greatest speed of the bodies, that of their turning at their size."""
    speed = 0.0
    for m in range(count):
        b = member[m]
        for r in range(3):
            turning = system.bodies[b].extent * abs(state[b].w[r])
            speed = max(speed, max(abs(state[b].v[r]), turning))
    return speed


@kernel
def drop_bounces(model, data, k, group, horizon):
    """Take out the normal velocities of the points that stay, in the kinetic metric.

    A point without slip keeps none: else it would stick with the slip that this gives it. With slip that lasts
    friction goes with the impulse (`carom.persistent.one_point.begin_hold`). Where that leaves nothing but
    round-off it leaves nothing.
    """
    system, controls = model.system, model.controls
    state, cluster, work, clock = data.state, data.cluster, data.work, data.clocks[0]
    count = members(work, group, cluster.member)
    still = 1e-12 * speed_of(system, state, count, cluster.member)
    for i in range(3 * k):
        still = max(still, controls.rest * controls.step * abs(cluster.v[C][i]))
    for i in range(k):
        cluster.seats[i].stopped = 0 if time_to_stop(i, cluster) > horizon else 1
    x = cluster.v[OLD]
    find_pull(k, 1, cluster)
    normal, tangential = work_of_pull(k, cluster)
    if not normal + tangential <= spare(
        clock
    ):  # points that are next to each other push each other out
        find_pull(k, 0, cluster)
        normal, tangential = work_of_pull(k, cluster)
    name_work(normal, tangential, clock)
    for i in range(k):
        n, t1, t2 = x[3 * i], x[3 * i + 1], x[3 * i + 2]
        if n != 0.0 or t1 != 0.0 or t2 != 0.0:
            spread(system, cluster.points[0][i], state, n, t1, t2, work)
            add_velocity(system, cluster.points[0][i], work, state)
            if not alone(system, cluster.points[0][i]):
                clock.loads += driven_power(system, state, work)  # of an impulse: its work
    if speed_of(system, state, count, cluster.member) <= still:
        for m in range(count):
            b = cluster.member[m]
            for r in range(3):
                state[b].v[r], state[b].w[r] = 0.0, 0.0


@kernel
def work_of_pull(k, cluster):
    """Return the work of the impulses in `old`: half of each times its velocities before and after."""
    x, u, W = cluster.v[OLD], cluster.v[U], cluster.m[0]
    normal, tangential = 0.0, 0.0
    for i in range(3 * k):
        if x[i] == 0.0:
            continue
        after = 0.0
        if not stops(cluster, i):
            after = u[i]
            for j in range(3 * k):
                after += W[i, j] * x[j]
        if i % 3 > 0 and not stops(cluster, i):
            tangential += 0.5 * x[i] * (u[i] + after)
        else:
            normal += 0.5 * x[i] * (u[i] + after)
    return normal, tangential


@kernel
def find_pull(k, friction, cluster):
    """Write the impulses that take the velocities out into `old`: with friction (1), if rounds find that."""
    n, L, x, last = 3 * k, cluster.m[1], cluster.v[OLD], cluster.v[P]
    for i in range(n):
        for j in range(n):
            both = stops(cluster, i) and stops(cluster, j)
            L[i, j] = cluster.m[0][i, j] if both else 1.0 if i == j else 0.0
    factor(n, DROP, L)
    first = 0.0
    for with_friction in range(friction, -1, -1):
        for i in range(n):
            last[i] = 0.0
        before = math.inf
        for turn in range(ROUNDS):
            change, largest = pull_once(k, with_friction, cluster)
            for i in range(n):
                last[i] = x[i]
            first = largest if turn == 0 else first  # without friction
            if not change < before:
                break
            before = change
        if with_friction == 0 or before <= 1e-9 * first:
            return


@kernel
def pull_once(k, with_friction, cluster):
    """Solve for the impulses with the friction of those of the last round; return their change and size."""
    n, W, x, last = 3 * k, cluster.m[0], cluster.v[OLD], cluster.v[P]
    for i in range(k):  # friction of the points that slip
        slides = (
            with_friction == 1 and cluster.seats[i].stays == 1 and cluster.seats[i].stopped == 0
        )
        for r in range(2):
            q = 3 * i + 1 + r
            if not stops(cluster, q):
                last[q] = -cluster.mu[i] * cluster.heading[i, r] * last[3 * i] if slides else 0.0
    for i in range(n):
        x[i] = 0.0
        if stops(cluster, i):
            x[i] = -cluster.v[U][i]
            for j in range(n):
                x[i] -= W[i, j] * last[j] if not stops(cluster, j) else 0.0
    substitute(n, cluster.m[1], x)
    change, largest = 0.0, 0.0
    for i in range(n):
        if stops(cluster, i):
            change, largest = max(change, abs(x[i] - last[i])), max(largest, abs(x[i]))
        else:
            x[i] = last[i]
    return change, largest


@kernel
def mode_of(system, i, state, cluster):
    """Return whether point i slips or sticks, now that its bounces are out."""
    _, u1, u2 = contact_velocity(cluster.points[0][i], state)
    # as `pose_forces` has found with the velocities before
    still = 10.0 * slow(system.contacts[cluster.seats[i].contact], state)
    slips = math.sqrt(u1 * u1 + u2 * u2) > still and cluster.kind[i] == SLIDING
    return SLIP if slips else STICK


@kernel
def set_modes(model, data, k):
    """Take the new points in, with an event each, the first is begun already; note what others do now."""
    system = model.system
    held, state, cluster, work, clock, records = (
        data.held,
        data.state,
        data.cluster,
        data.work,
        data.clocks[0],
        data.records,
    )
    begun, before = True, held.count[0]
    for i in range(k):
        seat = cluster.seats[i]
        if seat.stays == 0 or seat.held >= 0:
            continue
        if not begun:
            begin_event(system, seat.contact, seat.feature, state, clock, records)
        begun = False
        mode = mode_of(system, i, state, cluster)
        seat.held = enlist(system, held, seat, mode, state, work)
        clock.holds += 1
        records.event[clock.event].mode = mode
        end_event(system, HOLD, state, clock, records)
    for i in range(k):
        seat = cluster.seats[i]
        if seat.stays == 0 or seat.held >= before:
            continue
        hold, mode = held.points[seat.held], mode_of(system, i, state, cluster)
        if mode == STICK:  # from where it has slid to, before the impact
            set_anchor(system, hold, state, work)
        if hold.mode != mode:
            hold.mode = mode
            begin_event(system, seat.contact, seat.feature, state, clock, records)
            end_event(system, SLIPS if mode == SLIP else STICKS, state, clock, records)


@kernel
def first_forces(model, data, group):
    """Note the forces of all held points of the group, and the times at which their slip stops."""
    system, controls = model.system, model.controls
    held, state, cluster, work = data.held, data.state, data.cluster, data.work
    k = gather_held(system, held, group, state, cluster, work)
    for i in range(k):
        held.points[cluster.seats[i].held].several = 1
        cluster.seats[i].stays = 1
    pose_forces(system, controls, held, k, state, cluster, work)
    status = solve_forces(system, k, cluster)
    for i in range(k):
        hold = held.points[cluster.seats[i].held]
        take_forces(hold, i, cluster)
        if jams_among(hold, i, status, cluster) == 1:
            note_jam(held, hold)


@kernel
def look_again(system, held, k, state, cluster):
    """Mark contacts to be checked where a closed point still approaches; the others were judged just now."""
    for i in range(k):
        held.brinks[cluster.seats[i].contact].near = 0
    for i in range(k):
        seat = cluster.seats[i]
        contact = system.contacts[seat.contact]
        if contact_velocity(cluster.points[0][i], state)[0] < -slow(contact, state):
            if seat.stays == 0:
                held.brinks[seat.contact].near = 1


@kernel
def strike_off_open(model, data, k, group):
    """Remove the held points of the group that do not stay."""
    system = model.system
    held, state, cluster, work, clock, records = (
        data.held,
        data.state,
        data.cluster,
        data.work,
        data.clocks[0],
        data.records,
    )
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
