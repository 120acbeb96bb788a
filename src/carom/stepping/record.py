"""Writing the state of a run into its records."""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, inlined, kernel
from carom.contact.operations import place
from carom.dynamics.explicit import copy_state
from carom.geometry.rotation import cross
from carom.kinematics.anisotropy import lengths_of_tangents
from carom.kinematics.combination import factor_of, is_combination, term_of, terms_of
from carom.kinematics.contact_point import own_field
from carom.kinematics.coordinate import along, slides
from carom.kinematics.joints import child_arm, parent_arm
from carom.kinematics.moving_surfaces import set_surfaces
from carom.model.records import GROW
from carom.model.workspace import MOTION_STOP, MOTION_THREE
from carom.stepping.energy_balance import begin_watch, note_energies


@inlined
def finite(state):
    """Return whether all numbers of the state are finite."""
    s = 0.0
    for b in range(state.shape[0]):
        for k in range(3):
            s += state[b].x[k] + state[b].v[k] + state[b].w[k]
        s += state[b].Q[0]
    return math.isfinite(s)


@inlined
def still(state):
    """Return whether no body moves."""
    for b in range(state.shape[0]):
        for k in range(3):
            if state[b].v[k] != 0.0 or state[b].w[k] != 0.0:
                return False
    return True


@inlined
def room_of_touches(system, active):
    """Return how many rows of touches a saved state may need: a stop of a combination has one for each term."""
    return active + 2 * system.relations.terms.shape[0]


@inlined
def grow(step, what):
    """Request longer arrays: return the code with which the loop is left."""
    step.grow = what
    return GROW


@entry
def save_now(model, data):
    """Write the present state: at the start, and after a failure."""
    system, now, clock = model.system, data.state, data.clocks[0]
    note_energies(system, now, clock)
    if clock.saved == 0:
        begin_watch(system, now, clock.now, data.watch[0])
    save(model, data)


@inlined
def save(model, data):
    """Write the present state into the next row."""
    now, clock, records = data.state, data.clocks[0], data.records
    k = clock.saved
    row = records.series[k]
    row.t, row.kinetic, row.potential = clock.now, clock.kinetic, clock.potential
    row.loads, row.impacts = clock.loads, clock.impacts
    row.friction, row.bounces = clock.friction, clock.bounces
    row.residual, clock.residual = clock.residual, 0.0
    for b in range(now.shape[0]):
        copy_state(now[b], records.state[k, b])
    for i in range(records.turn.shape[1]):
        records.turn[k, i].angle = model.system.relations.memory.coordinates[i].reference
    if data.active.count[0] > 0:
        save_contacts(model, data, k)
    clock.saved += 1


@kernel
def save_contacts(model, data, k):
    """Write forces and moments of all active points at saved time k."""
    system, active, now, work = model.system, data.active, data.state, data.work
    clock, records = data.clocks[0], data.records
    set_surfaces(system, clock.now)
    for i in range(active.count[0]):
        active_point, point, touch = active.points[i], work.placed[0], records.touch[clock.touched]
        contact = system.contacts[active_point.contact]
        place(system, contact, active_point, now, point, work)
        if point.motion == MOTION_STOP or (
            point.motion == MOTION_THREE and contact.other_solid > 0
        ):
            save_stop(model, data, k, i)
            continue
        E, arm, other = point.axes, point.arm_a, point.arm_b
        f = active_point.force[0] - active_point.pull, active_point.force[1], active_point.force[2]
        touch.saved, touch.contact, touch.feature = k, contact.number, active_point.feature
        touch.mode, touch.body = active_point.mode, system.bodies[active_point.body].number
        pair = active_point.other >= 0
        touch.other = system.bodies[active_point.other].number if pair else -1
        fx = f[0] * E[0, 0] + f[1] * E[1, 0] + f[2] * E[2, 0]
        fy = f[0] * E[0, 1] + f[1] * E[1, 1] + f[2] * E[2, 1]
        fz = f[0] * E[0, 2] + f[1] * E[1, 2] + f[2] * E[2, 2]
        a, b = 1.0, 1.0
        if contact.axis_of != 0:
            a, b = lengths_of_tangents(point)
        tx, ty, tz = cross(arm[0], arm[1], arm[2], fx, fy, fz)
        sx, sy, sz = cross(other[0], other[1], other[2], -fx, -fy, -fz)
        torque = active_point.torque
        m = (torque[0], torque[1] / a, torque[2] / b)
        mx = m[0] * E[0, 0] + m[1] * E[1, 0] + m[2] * E[2, 0]
        my = m[0] * E[0, 1] + m[1] * E[1, 1] + m[2] * E[2, 1]
        mz = m[0] * E[0, 2] + m[1] * E[1, 2] + m[2] * E[2, 2]
        touch.power = 0.0
        if point.moves == 1:
            s, w = own_field(point, now, 0), point.field[1]
            touch.power = f[1] * s[1] + f[2] * s[2] + mx * w[0] + my * w[1] + mz * w[2]
        t, o, p = touch.moment, touch.other_moment, touch.push
        t[0], t[1], t[2] = tx + mx, ty + my, tz + mz
        o[0], o[1], o[2] = (sx - mx, sy - my, sz - mz) if pair else (0.0, 0.0, 0.0)
        p[0], p[1], p[2] = fx, fy, fz
        for j in range(3):
            touch.force[j], touch.point[j] = f[j], now[active_point.body].x[j] + arm[j]
        touch.force[1], touch.force[2] = a * touch.force[1], b * touch.force[2]
        clock.touched += 1


@kernel
def save_stop(model, data, k, i):
    """Write the force of a stop at saved time k, a row for each joint of its coordinate."""
    system, active_point, point = model.system, data.active.points[i], data.work.placed[0]
    c = system.relations.coordinates[point.coordinate]
    force = point.length * active_point.force[0]
    if not is_combination(c):
        save_along(model, data, (k, i), c, force)
        return
    first, last = terms_of(system, c)
    rubs, slip = point.grip * active_point.force[1], 0
    if point.motion == MOTION_THREE:  # the terms of its slip are those of its length
        slip, _ = terms_of(system, system.relations.coordinates[point.coordinate + 1])
    for t in range(first, last):
        along_term = factor_of(system, t) * force
        if point.motion == MOTION_THREE:
            along_term += factor_of(system, slip + t - first) * rubs
        save_along(model, data, (k, i), term_of(system, t), along_term)
        touch = data.records.touch[data.clocks[0].touched - 1]
        if t > first:  # the first row has the force of the stop
            touch.force[0] = 0.0
        elif point.motion == MOTION_THREE:
            touch.force[1] = rubs


@kernel
def save_along(model, data, row, c, force):
    """Write the wrenches on both bodies of a joint by the force of a stop along its coordinate."""
    system, now, clock, (k, i) = model.system, data.state, data.clocks[0], row
    active_point, point, touch = (
        data.active.points[i],
        data.work.placed[0],
        data.records.touch[clock.touched],
    )
    touch.saved, touch.contact = k, system.contacts[active_point.contact].number
    touch.feature, touch.mode, touch.power = active_point.feature, active_point.mode, 0.0
    child, parent, s = c.child, c.parent, 1.0
    if child < 0:
        child, parent, s = parent, -1, -1.0
    touch.body = system.bodies[child].number
    touch.other = system.bodies[parent].number if parent >= 0 else -1
    n, slide = along(system, c, now), slides(c)
    f = (s * force * n[0], s * force * n[1], s * force * n[2])
    r = child_arm(c, now) if s > 0.0 else parent_arm(c, now)
    q = parent_arm(c, now) if parent >= 0 else (0.0, 0.0, 0.0)
    t, o = f, (-f[0], -f[1], -f[2])
    if slide:
        t, o = cross(r[0], r[1], r[2], f[0], f[1], f[2]), cross(q[0], q[1], q[2], o[0], o[1], o[2])
    for j in range(3):
        touch.push[j], touch.moment[j] = f[j] if slide else 0.0, t[j]
        touch.other_moment[j] = o[j] if parent >= 0 else 0.0
        touch.force[j], touch.point[j] = 0.0, now[child].x[j] + r[j]
    touch.force[0] = abs(point.length) * active_point.force[0]
    clock.touched += 1
