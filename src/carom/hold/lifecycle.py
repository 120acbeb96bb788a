"""When a contact is held, whether it slips or sticks, and when it is at rest.

After an impact with exit speed u_n, a contact whose free acceleration of approach is g_i bounces on for

    t_i = 2 u_n / (g_i (1 - e)),

exactly, as long as g_i is constant. If that ends within the present step the contact is held from now
on: u_n is taken out in the kinetic metric and the energy this drops, u_n^2/(2 W_nn), goes to the ledger.
There is no threshold of speed: a smaller step holds later.
"""

from __future__ import annotations

import math

from carom.contact.gap import slow
from carom.geometry.rotation import rotate
from carom.jit import kernel
from carom.motion.acceleration import OPEN, SLIP, STICK, acceleration
from carom.motion.contact_point import (
    add_velocity,
    contact_acceleration,
    contact_arm,
    contact_velocity,
    effective_inverse_mass,
    spread,
)
from carom.motion.friction import stick_force
from carom.system.notes import begin_event, end_event
from carom.system.records import HOLD


@kernel
def approach_acceleration(system, held, c, state, work):
    """Return g_i, the acceleration towards the half-space that contact c would have if it were open."""
    contact, mode = system.contacts[c], held[c].mode
    held[c].mode = OPEN
    acceleration(system, state, held, work, work.stages[0])
    held[c].mode = mode
    p = held[c].point
    rx, ry, rz = contact_arm(contact, state, p)
    rate = work.stages[0, contact.body].rate
    return -contact_acceleration(contact, state, rate, p, rx, ry, rz)[0]


@kernel
def try_hold(system, controls, held, c, state, horizon, work, clock, records):
    """Hold contact c, which is closed at its point and does not approach, if the rule says so."""
    if controls.hold == 0:
        return False
    contact = system.contacts[c]
    rx, ry, rz = contact_arm(contact, state, held[c].point)
    rate = contact_velocity(contact, state, rx, ry, rz)[0]
    g = approach_acceleration(system, held, c, state, work)
    if not g > 0.0:
        return False
    e = contact.restitution
    if rate > slow(contact, state) and not (
        e < 1.0 and 2.0 * rate < g * (1.0 - e) * horizon
    ):
        return False
    W = work.hit[0].W
    effective_inverse_mass(system, contact, state, rx, ry, rz, work, W)
    clock.bounces -= 0.5 * rate * rate / W[0, 0]
    clock.holds += 1
    begin_event(c, state, clock, records)
    spread(system, contact, state, rx, ry, rz, -rate / W[0, 0], 0.0, 0.0, work)
    add_velocity(system, contact, work, state)
    settle(system, held, c, state, 0.0, work, clock)
    end_event(HOLD, state, clock, records)
    return True


@kernel
def settle(system, held, c, state, stop, work, clock):
    """Set the mode of a closed contact without normal speed. Slip below `stop` [m/s] has ended."""
    contact, hold = system.contacts[c], held[c]
    rx, ry, rz = contact_arm(contact, state, hold.point)
    u = contact_velocity(contact, state, rx, ry, rz)
    hold.leaving = 0
    hold.mode = SLIP
    if math.sqrt(u[1] * u[1] + u[2] * u[2]) <= max(stop, 10.0 * slow(contact, state)):
        W = work.hit[0].W
        effective_inverse_mass(system, contact, state, rx, ry, rz, work, W)
        n, t1, t2 = stick_force(W, u[0], u[1], u[2])
        spread(system, contact, state, rx, ry, rz, n, t1, t2, work)
        add_velocity(system, contact, work, state)
        clock.bounces += 0.5 * (n * u[0] + t1 * u[1] + t2 * u[2])
        hold.mode = STICK
    acceleration(system, state, held, work, work.stages[0])
    f = hold.force
    if hold.mode == STICK and not (
        math.sqrt(f[1] * f[1] + f[2] * f[2]) <= contact.friction * f[0]
    ):
        hold.mode = SLIP
    mark_anchor(contact, hold, state)
    if hold.mode == STICK and system.bodies[contact.body].isolated == 1:
        mass, rate = system.bodies[contact.body].mass, work.stages[0, contact.body].rate
        rest_if_still(contact, hold, state[contact.body], rate, f[0] / mass)


@kernel
def mark_anchor(contact, hold, state):
    """Note where the core point of the contact is in the world."""
    q, x, p = state[contact.body].Q, state[contact.body].x, hold.point
    r = rotate(q[0], q[1], q[2], q[3], p[0], p[1], p[2])
    for k in range(3):
        hold.anchor[k] = x[k] + r[k]


@kernel
def rest_if_still(contact, hold, body, rate, push):
    """Put a body to rest, exactly, if neither speed nor acceleration is left.

    No speed: round-off of the speeds that gravity gives it over its own size. No acceleration: round-off
    of `push`, what the contact force does to it.
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
        hold.rest = 1
