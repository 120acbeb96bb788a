"""Persistent contact of one body at one point: from its last bounce to slip, stick or rest."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.gap import slow
from carom.contact.pair_point import drift
from carom.contact.place import place_active
from carom.dynamics.acceleration import SLIP, STICK, acceleration
from carom.dynamics.contact_impulse import (
    add_velocity,
    alone,
    effective_inverse_mass,
    spread,
)
from carom.dynamics.elements import driven_power
from carom.dynamics.friction import slip_force, stick_force
from carom.kinematics.contact_point import (
    contact_acceleration,
    contact_velocity,
)
from carom.model.event_rows import begin_event, end_event
from carom.model.records import PERSIST, SLIPS, STICKS
from carom.persistent.active_set import activate
from carom.persistent.bounces import bounces_end, horizon_of
from carom.persistent.events import braked
from carom.persistent.jam import JAMMED, note_jam, presses, yields


@kernel
def activate_one(model, data, horizon):
    """Make the only closed point persistent if it does not approach and satisfies the rule."""
    system = model.system
    active, state, group, work, clock, records = (
        data.active,
        data.state,
        data.group,
        data.work,
        data.clocks[0],
        data.records,
    )
    closed_point, point = group.closed[0], group.points[0][0]
    contact = system.contacts[closed_point.contact]
    u, still = contact_velocity(point, state), slow(contact, state)
    acceleration(system, state, active, work, work.stages[0])
    a = contact_acceleration(point, state, work.stages[0])
    if contact.touches != 0:
        d = drift(system, contact, closed_point.feature, closed_point.point, point, state, work)
        a = (a[0] + d[0], a[1] + d[1], a[2] + d[2])
    horizon = horizon_of(contact, model.controls, -a[0], horizon)
    if not bounces_end(contact, u[0], -a[0], still, horizon):
        return
    begin_event(system, closed_point.contact, closed_point.feature, state, clock, records)
    i = activate(system, active, closed_point, STICK, state, work)
    active_point = active.points[i]
    begin_contact(model, data, contact, active_point, 0.0, a, horizon)
    find_mode(model, data, contact, active_point)
    clock.holds += 1
    records.event[clock.event].mode = active_point.mode
    end_event(system, PERSIST, state, clock, records)


@kernel
def renew_mode_of_one(model, data, active_point):
    """Find the new mode of a point whose slip has stopped or turned."""
    system, controls = model.system, model.controls
    active, state, work, clock, records = (
        data.active,
        data.state,
        data.work,
        data.clocks[0],
        data.records,
    )
    contact = system.contacts[active_point.contact]
    stop = braked(contact, active_point, 1e-3 * controls.step)  # in a thousandth of a step
    active_point.heading[0], active_point.heading[1] = 0.0, 0.0
    acceleration(system, state, active, work, work.stages[0])
    begin_event(system, active_point.contact, active_point.feature, state, clock, records)
    if begin_contact(model, data, contact, active_point, stop, (0.0, 0.0, 0.0), math.inf):
        find_mode(model, data, contact, active_point)
    end_event(system, STICKS if active_point.mode == STICK else SLIPS, state, clock, records)


@kernel
def begin_contact(model, data, contact, active_point, stop, a, horizon):
    """Remove the normal velocity, and slip that has stopped; set the mode to try first.

    Slip has stopped if it is below `stop` (or round-off). Return False if a contact that should stick continues
    to slip. If slip lasts, under the acceleration `a`, as long as the dropped bounces, t = 2 u_n/(g (1 - e)),
    the impulse that removes u_n has friction: the normal impulse of the bounces is (g t - u_n)/k, and that of
    persistent contact in the same time is g t/k.
    """
    system = model.system
    state, work, clock = data.state, data.work, data.clocks[0]
    point, still = work.point[0], slow(contact, state)
    place_active(system, active_point, state, point, work)
    u = contact_velocity(point, state)
    W = work.hit[0].W
    effective_inverse_mass(system, point, state, work, W)
    n, t1, t2 = -u[0] / W[0, 0], 0.0, 0.0
    s1, s2 = u[1] + W[1, 0] * n, u[2] + W[2, 0] * n  # slip after the normal velocity is removed
    slip = math.sqrt(s1 * s1 + s2 * s2)
    stops = slip <= max(stop, 10.0 * still)
    if math.sqrt(u[1] * u[1] + u[2] * u[2]) <= 10.0 * still:
        stops = stops or sticks(W, a, contact.friction_held)  # bounces with stick leave no slip
    if stop > 0.0 and not stops:
        return False
    if stops:
        n, t1, t2 = stick_force(W, u[0], u[1], u[2])
        s1, s2 = 0.0, 0.0
    active_point.mode = STICK if stops else SLIP
    if active_point.mode == SLIP and yields(W, contact.friction, u[1], u[2]) > 0.0:
        f, f1, f2 = slip_force(W, u[0], u[1], u[2], u[1], u[2], contact.friction)
        v1, v2 = u[1] + moved(W, 1, f, f1, f2), u[2] + moved(W, 2, f, f1, f2)
        given = 0.5 * (f * u[0] + f1 * (u[1] + v1) + f2 * (u[2] + v2))
        if given <= spare(clock) and lasts(W, a, u, v1, v2, contact.friction, horizon):
            n, t1, t2, s1, s2 = f, f1, f2, v1, v2
    spread(system, point, state, n, t1, t2, work)
    add_velocity(system, point, work, state)
    if not alone(system, point):
        clock.loads += driven_power(system, state, work)  # the work of an impulse
    # work of the impulse: half of it times the sum of the velocities before and after
    name_work(0.5 * n * u[0], 0.5 * (t1 * (u[1] + s1) + t2 * (u[2] + s2)), clock)
    return True


@kernel
def spare(clock):
    """Return the energy that dropped bounces may add: the loss by impacts of the step minus the energy owed."""
    return max(0.0, clock.before - clock.impacts - clock.owed)


@kernel
def name_work(normal, tangential, clock):
    """Add the work of the impulse that removes bounces to the ledger.

    A gain belongs to friction. It is less than the loss by friction in persistent contact until the time at
    which the bounces would have ended, and is owed until then (`carom.stepping.time_loop.charge_impacts`).
    """
    if normal + tangential <= 0.0:
        clock.bounces += normal + tangential
    else:
        clock.bounces += normal
        clock.friction += tangential
        clock.owed += tangential


@kernel
def sticks(W, a, mu):
    """Return whether a point sticks under the free acceleration a."""
    n, t1, t2 = stick_force(W, a[0], a[1], a[2])
    return math.sqrt(t1 * t1 + t2 * t2) <= mu * n


@kernel
def lasts(W, a, u, v1, v2, mu, horizon):
    """Return whether a contact with velocity u and free acceleration a slips along u_t for the time `horizon`.

    Both the slip u_t and (v1, v2), the slip after the impulse with friction, must last.
    """
    speed = math.sqrt(u[1] * u[1] + u[2] * u[2])
    if not (speed > 0.0 and horizon < math.inf):
        return False
    e1, e2 = u[1] / speed, u[2] / speed
    n, t1, t2 = slip_force(W, a[0], a[1], a[2], e1, e2, mu)
    rate = e1 * (a[1] + moved(W, 1, n, t1, t2)) + e2 * (a[2] + moved(W, 2, n, t1, t2))
    least = min(speed, e1 * v1 + e2 * v2)
    return least > 0.0 and least + rate * horizon > 0.0


@kernel
def moved(W, r, n, t1, t2):
    """Return the change of component r of the velocity by an impulse (n, t1, t2)."""
    return W[r, 0] * n + W[r, 1] * t1 + W[r, 2] * t2


@kernel
def find_mode(model, data, contact, active_point):
    """Let a contact slip if its friction does not suffice; set its body to rest if no motion is left."""
    system = model.system
    active, state, work = data.active, data.state, data.work
    acceleration(system, state, active, work, work.stages[0])
    f = active_point.force
    if active_point.mode == STICK and not (
        math.sqrt(f[1] * f[1] + f[2] * f[2]) <= contact.friction_held * f[0]
    ):
        active_point.mode = SLIP
        acceleration(system, state, active, work, work.stages[0])
    if active_point.mode == SLIP:
        _, u1, u2 = contact_velocity(work.point[0], state)
        k = yields(active_point.W, contact.friction_held, u1, u2)
        if k <= JAMMED * active_point.W[0, 0] and presses(active_point, k):
            note_jam(active, active_point)
    body = system.bodies[contact.body]
    if active_point.mode == STICK and body.isolated == 1:
        rate = work.stages[0, contact.body].rate
        rest_if_still(
            contact, active_point, state[contact.body], rate, active_point.force[0] / body.mass
        )


@kernel
def rest_if_still(contact, active_point, body, rate, push):
    """Set a body exactly to rest if neither speed nor acceleration is left.

    The bound for the speed is round-off of the speed of a fall over its own size. The bound for the
    acceleration is round-off of `push`, the acceleration by the contact force.
    """
    size = contact.extent
    speed, change = 0.0, 0.0
    for k in range(3):
        speed = max(speed, max(abs(body.v[k]), size * abs(body.w[k])))
        change = max(change, max(abs(rate[k]), size * abs(rate[3 + k])))
    if change <= 1e-9 * push and speed <= 1e-9 * math.sqrt(push * size):
        for k in range(3):
            body.v[k] = 0.0
            body.w[k] = 0.0
        active_point.rest = 1
