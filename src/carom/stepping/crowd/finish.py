"""The end of a step of a crowd: energies, impacts, new persistent contacts, and bodies at rest."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.gap import slow
from carom.contact.point_lists import mark
from carom.dynamics.explicit import copy_state
from carom.geometry.rotation import norm
from carom.geometry.thresholds import RESOLUTION
from carom.impact.layout import AT_END
from carom.impact.record import Blow, three, write_blow
from carom.model.actions import MODE_SLIP, MODE_STICK
from carom.model.event_rows import note_event
from carom.model.records import IMPACT, OPENS, PERSISTS, SLIPS, STICKS
from carom.model.workspace import MOTION_POINT, MOTION_ROLL
from carom.persistent.active_set import begin_point
from carom.persistent.step_control import rest_speed
from carom.persistent.thresholds import CROWD_REST, FEW_REST
from carom.stepping.crowd.response import block_of_point, velocity_of


@kernel
def finish(model, data, k, h, fall, residual):
    """Write the results of the step, and set still bodies to rest; return the energy in the ledger."""
    system, controls = model.system, model.controls
    active, start, end, crowd = data.active, data.state, data.work.trial, data.crowd
    clock = data.clocks[0]
    tolerance = rest_speed(controls, fall * h, residual, k, FEW_REST)
    impacts, pressing, rubbing = 0.0, 0.0, 0.0
    for i in range(k):
        spot, point = crowd.closed[i], crowd.points[0][i]
        p, u = spot.impulse, spot.before
        w = velocity_of(system, point, crowd, end)
        normal = 0.5 * p[0] * (u[0] + w[0]) if spot.motion == MOTION_POINT else 0.0
        tangential = 0.5 * (p[1] * (u[1] + w[1]) + p[2] * (u[2] + w[2]))
        if spot.motion == MOTION_POINT and p[0] > 0.0 and spot.strikes == 1:
            impacts += normal + tangential
            write_impact(model, data, i, k, normal, tangential)
            note_event(model, data, spot.contact, spot.feature, IMPACT, 0)
        else:
            pressing += normal
            rubbing += tangential
    # no entry gains energy: if slip or rows turn within the step, the work of friction or of normal forces is
    # less than these products; the caller assigns the rest (`carom.stepping.crowd.balance.assign_energy`)
    pressing, rubbing = min(0.0, pressing + max(0.0, rubbing)), min(0.0, rubbing)
    impacts = min(0.0, impacts)
    if k > 0 and data.work.step[0].whole == 0:
        clock.whole += 1
        data.work.step[0].whole = 1
    clock.impacts += impacts
    clock.friction += rubbing
    clock.bounces += pressing
    count = list_active(model, data, k, h, tolerance)
    still = rest_speed(controls, fall * h, residual, k, CROWD_REST)
    come_to_rest(system, still, count, start, end, crowd)
    for i in range(active.count[0]):
        mark(active, active.points[i], 0)
    for i in range(count):
        active.points[i] = crowd.active[i]
        mark(active, active.points[i], 1)
    active.count[0] = count
    for i in range(k):  # in event-driven steps these contacts are checked first
        active.contact_states[crowd.closed[i].contact].near = 1
        active.contact_states[crowd.closed[i].contact].leaving = 0
    return impacts + pressing + rubbing


@kernel
def write_impact(model, data, i, k, pressure, rubbing):
    """Write the row of an impact without duration; k points share the impulses of the step."""
    crowd, clock, records = data.crowd, data.clocks[0], data.records
    spot, end = crowd.closed[i], data.work.trial
    w = velocity_of(model.system, crowd.points[0][i], crowd, end)
    block_of_point(crowd.problem, i, records.impact[clock.struck].W)
    blow = Blow(
        together=max(2, k), before=three(spot.before, 0), after=w, impulse=three(spot.impulse, 0),
        compression=min(0.0, pressure), restitution=max(0.0, pressure), friction=-rubbing,
        change=pressure + rubbing, phases=AT_END, duration=0.0,
    )  # fmt: skip
    contact = model.system.contacts[spot.contact]
    write_blow(contact, crowd.points[0][i], end, blow, clock, records)


@kernel
def list_active(model, data, k, h, tolerance):
    """Write the loaded points that do not strike to `crowd.active`, and their events; return their number."""
    system = model.system
    active, end, crowd, clock = data.active, data.work.trial, data.crowd, data.clocks[0]
    count = 0
    for i in range(active.count[0]):
        crowd.follows[i] = 0  # 1 if a point stays active
    for i in range(k):
        spot, point = crowd.closed[i], crowd.points[1][i]
        p, c = spot.impulse, spot.contact
        contact, x = system.contacts[c], end[point.a].x
        if spot.motion != MOTION_POINT:
            take_torque(crowd, spot, point.length / h)
            continue
        spot.place = -1
        if not (p[0] > 0.0 and spot.strikes == 0) or count == crowd.active.shape[0]:
            continue
        spot.place = count
        active_point = crowd.active[count]
        _, w1, w2 = velocity_of(system, crowd.points[0][i], crowd, end)
        w1, w2 = w1 + spot.drift[1], w2 + spot.drift[2]
        slips = math.sqrt(w1 * w1 + w2 * w2) > max(tolerance, 10.0 * slow(contact, end))
        mode = MODE_SLIP if slips else MODE_STICK
        if spot.active < 0:
            note_event(model, data, c, spot.feature, PERSISTS, mode)
            clock.holds += 1
        else:
            crowd.follows[spot.active] = 1
            if active.points[spot.active].mode != mode:
                kind = SLIPS if slips else STICKS
                note_event(model, data, c, spot.feature, kind, mode)
        begin_point(active_point, contact, c, spot.feature, mode)
        block_of_point(crowd.problem, i, active_point.W)
        for a in range(3):
            active_point.point[a], active_point.force[a] = spot.point[a], p[a] / h
            active_point.anchor[a] = x[a] + point.arm_a[a]
        count += 1
    for i in range(active.count[0]):
        if crowd.follows[i] == 0:
            active_point = active.points[i]
            note_event(model, data, active_point.contact, active_point.feature, OPENS, 0)
    return count


@kernel
def take_torque(crowd, spot, factor):
    """Write the torque of rolling or of pivoting friction to its active point."""
    place, p = crowd.closed[spot.parent].place, spot.impulse
    if place < 0:
        return
    torque = crowd.active[place].torque
    if spot.motion == MOTION_ROLL:
        torque[1], torque[2] = factor * p[1], factor * p[2]
    else:
        torque[0] = factor * p[1]


@kernel
def root(parent, b):
    """Return the body that represents the set of b."""
    while parent[b] != b:
        parent[b] = parent[parent[b]]
        b = parent[b]
    return b


@kernel
def displacement(start, end, size):
    """Return the displacement of a body plus its rotation times its size [m]."""
    moved, turned = 0.0, 0.0
    for j in range(3):
        moved += (end.x[j] - start.x[j]) ** 2
    for j in range(4):
        turned += (end.Q[j] - start.Q[j]) ** 2
    return math.sqrt(moved) + 2.0 * size * math.sqrt(turned)


@kernel
def come_to_rest(system, tolerance, count, start, end, crowd):
    """Stop sets of bodies in contact or with joints exactly if all of their speeds are below the tolerance.

    Sets that were at rest at the start get their old positions, and rest from now on; except if a body was
    pushed, because another had penetrated it, or has loads or joints.
    """
    parent, speed, n, joined = crowd.parent, crowd.speed, end.shape[0], -1
    for b in range(n):
        parent[b], speed[0, b], speed[1, b] = b, 0.0, 0.0
        if system.bodies[b].isolated == 0:
            joined = b if joined < 0 else joined
            parent[b] = joined
    for i in range(count):
        if crowd.active[i].other >= 0:
            parent[root(parent, crowd.active[i].body)] = root(parent, crowd.active[i].other)
    for i in range(count):  # a surface that moves in itself works on bodies at rest
        if system.contacts[crowd.active[i].contact].moves > 0:
            speed[1, root(parent, crowd.active[i].body)] = math.inf
    for b in range(n):
        g, size = root(parent, b), system.bodies[b].extent
        speed[0, g] = max(speed[0, g], norm(start[b].v) + size * norm(start[b].w))
        if displacement(start[b], end[b], size) > RESOLUTION * size:
            speed[0, g] = math.inf
        speed[1, g] = max(speed[1, g], norm(end[b].v) + size * norm(end[b].w))
    for b in range(n):
        g = root(parent, b)
        if speed[1, g] <= tolerance:
            if speed[0, g] == 0.0:
                copy_state(start[b], end[b])
            for j in range(3):
                end[b].v[j], end[b].w[j] = 0.0, 0.0
    for b in range(n):  # loads may change with time: such a body stops, but does not rest
        if system.bodies[b].ballistic == 0:
            speed[0, root(parent, b)] = math.inf
    for i in range(count):
        active_point = crowd.active[i]
        g = root(parent, active_point.body)
        active_point.rest = 1 if speed[0, g] == 0.0 and speed[1, g] <= tolerance else 0
