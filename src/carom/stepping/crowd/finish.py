"""The end of a step of a heap: energies, impacts, what is held from now on, and what has come to rest."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.gap import slow
from carom.dynamics.acceleration import SLIP, STICK
from carom.dynamics.explicit import keep
from carom.friction.solve import inverse_mass_of
from carom.geometry.rotation import norm
from carom.kinematics.contact_point import contact_velocity
from carom.model.event_rows import note_event
from carom.model.records import HOLD, IMPACT, OPENS, SLIPS, STICKS
from carom.persistent.active_set import begin_point
from carom.persistent.step_control import rest_speed


@kernel
def finish(model, data, k, h, fall, residual):
    """Write what the step has done, and put to rest what moves no more; return the energy that has a name."""
    system, controls = model.system, model.controls
    held, start, end, heap, clock, records = (
        data.held,
        data.state,
        data.work.trial,
        data.heap,
        data.clocks[0],
        data.records,
    )
    tolerance = rest_speed(controls, fall * h, residual, k)
    blows, pressing, rubbing = 0.0, 0.0, 0.0
    for i in range(k):
        spot, point = heap.spots[i], heap.points[0][i]
        p, u = spot.impulse, spot.before
        w = contact_velocity(point, end)
        normal = 0.5 * p[0] * (u[0] + w[0]) if spot.turns == 0 else 0.0
        tangential = 0.5 * (p[1] * (u[1] + w[1]) + p[2] * (u[2] + w[2]))
        if spot.turns == 0 and p[0] > 0.0 and spot.strikes == 1:
            blows += normal + tangential
            write_impact(model, data, i, k, w, normal, tangential)
            note_event(system, spot.contact, spot.feature, IMPACT, 0, clock, records)
        else:
            pressing += normal
            rubbing += tangential
    # none gains: where slip has turned within the step friction has done less than these products, and where
    # rows turn what presses has; the caller sees to the rest (`carom.stepping.crowd.step.take_over`)
    pressing, rubbing = min(0.0, pressing + max(0.0, rubbing)), min(0.0, rubbing)
    blows = min(0.0, blows)
    clock.impacts += blows
    clock.friction += rubbing
    clock.bounces += pressing
    count = list_held(model, data, k, h, tolerance)
    settle(system, tolerance, count, start, end, heap)
    for i in range(held.count[0]):
        if held.points[i].touches == 0:
            held.carries[held.points[i].feature] = 0
    for i in range(count):
        held.points[i] = heap.held[i]
        if held.points[i].touches == 0:
            held.carries[held.points[i].feature] = 1
    held.count[0] = count
    for i in range(k):  # in a smaller island it is looked at first
        held.brinks[heap.spots[i].contact].near = 1
        held.brinks[heap.spots[i].contact].leaving = 0
    return blows + pressing + rubbing


@kernel
def write_impact(model, data, i, k, w, pressure, rubbing):
    """Write the row of an impact; it has no duration, and its point is one of all that press."""
    end, heap, clock, records = data.work.trial, data.heap, data.clocks[0], data.records
    spot, point = heap.spots[i], heap.points[0][i]
    row, x, contact = (
        records.impact[clock.struck],
        end[point.a].x,
        model.system.contacts[spot.contact],
    )
    row.time, row.contact, row.together = clock.now, contact.number, max(2, k)
    inverse_mass_of(heap.problem.link[i], heap.problem.contact[i], row.W)
    for a in range(3):
        row.point[a], row.normal[a] = x[a] + point.arm_a[a], point.axes[0, a]
        row.before[a], row.after[a], row.impulse[a] = spot.before[a], w[a], spot.impulse[a]
    row.energy_change = pressure + rubbing
    row.compression_work, row.restitution_work = min(0.0, pressure), max(0.0, pressure)
    row.friction_loss, row.duration, row.phases = -rubbing, 0.0, 0
    clock.struck += 1


@kernel
def list_held(model, data, k, h, tolerance):
    """Write the points that press without a strike into `heap.held`, and their events; return how many."""
    system = model.system
    held, end, heap, clock, records = (
        data.held,
        data.work.trial,
        data.heap,
        data.clocks[0],
        data.records,
    )
    count = 0
    for i in range(held.count[0]):
        heap.follows[i] = 0  # 1 where a point goes on
    for i in range(k):
        spot, point = heap.spots[i], heap.points[1][i]
        p, c = spot.impulse, spot.contact
        contact, x = system.contacts[c], end[point.a].x
        if spot.turns > 0:
            take_torque(heap, spot, point.length / h)
            continue
        spot.place = -1
        if not (p[0] > 0.0 and spot.strikes == 0) or count == heap.held.shape[0]:
            continue
        spot.place = count
        hold = heap.held[count]
        _, w1, w2 = contact_velocity(heap.points[0][i], end)
        w1, w2 = w1 + spot.drift[1], w2 + spot.drift[2]
        slips = math.sqrt(w1 * w1 + w2 * w2) > max(tolerance, 10.0 * slow(contact, end))
        mode = SLIP if slips else STICK
        if spot.held < 0:
            note_event(system, c, spot.feature, HOLD, mode, clock, records)
            clock.holds += 1
        else:
            heap.follows[spot.held] = 1
            if held.points[spot.held].mode != mode:
                kind = SLIPS if slips else STICKS
                note_event(system, c, spot.feature, kind, mode, clock, records)
        begin_point(hold, contact, c, spot.feature, mode)
        inverse_mass_of(heap.problem.link[i], heap.problem.contact[i], hold.W)
        for a in range(3):
            hold.point[a], hold.force[a] = spot.point[a], p[a] / h
            hold.anchor[a] = x[a] + point.arm_a[a]
        count += 1
    for i in range(held.count[0]):
        if heap.follows[i] == 0:
            hold = held.points[i]
            note_event(system, hold.contact, hold.feature, OPENS, 0, clock, records)
    return count


@kernel
def take_torque(heap, spot, factor):
    """Put the torque of rolling or of pivoting into the list."""
    place, p = heap.spots[spot.parent].place, spot.impulse
    if place < 0:
        return
    torque = heap.held[place].torque
    if spot.turns == 1:
        torque[1], torque[2] = factor * p[1], factor * p[2]
    else:
        torque[0] = factor * p[1]


@kernel
def root(parent, b):
    """Return the body that the set of b is named after."""
    while parent[b] != b:
        parent[b] = parent[parent[b]]
        b = parent[b]
    return b


@kernel
def settle(system, tolerance, count, start, end, heap):
    """Stop the bodies of each set that presses on each other, exactly, where all are slower than the tolerance.

    Those that did not move at the start are where they were, and rest from now on.
    """
    parent, speed, n = heap.parent, heap.speed, end.shape[0]
    for b in range(n):
        parent[b], speed[0, b], speed[1, b] = b, 0.0, 0.0
    for i in range(count):
        if heap.held[i].other >= 0:
            parent[root(parent, heap.held[i].body)] = root(parent, heap.held[i].other)
    for b in range(n):
        g, size = root(parent, b), system.bodies[b].extent
        speed[0, g] = max(speed[0, g], norm(start[b].v) + size * norm(start[b].w))
        speed[1, g] = max(speed[1, g], norm(end[b].v) + size * norm(end[b].w))
    for b in range(n):
        g = root(parent, b)
        if speed[1, g] <= tolerance:
            if speed[0, g] == 0.0:
                keep(start[b], end[b])
            for j in range(3):
                end[b].v[j], end[b].w[j] = 0.0, 0.0
    for i in range(count):
        hold = heap.held[i]
        g = root(parent, hold.body)
        hold.rest = 1 if speed[0, g] == 0.0 and speed[1, g] <= tolerance else 0
