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
from carom.motion.acceleration import OPEN, SLIP, STICK, acceleration, stick_force
from carom.motion.contact_point import (
    add_velocity,
    contact_acceleration,
    contact_arm,
    contact_velocity,
    effective_inverse_mass,
    spread,
)
from carom.system.records import HANDOVER, HOLDS


@kernel
def approach_acceleration(system, held, c, state, work):
    """Return g_i, the acceleration towards the half-space that contact c would have if it were open."""
    mode = held.mode[c]
    held.mode[c] = OPEN
    acc = work.rate[0]
    acceleration(system, state.x, state.Q, state.v, state.w, held, work, acc)
    held.mode[c] = mode
    p = held.point[c]
    rx, ry, rz = contact_arm(system, c, state.Q, p[0], p[1], p[2])
    a = contact_acceleration(system, c, state.Q, state.w, acc, p[0], p[1], p[2], rx, ry, rz)
    return -a[0]


@kernel
def try_hold(system, controls, held, c, state, horizon, work, clock):
    """Hold contact c, which is closed at `held.point[c]` and does not approach, if the rule says so."""
    if controls.hold == 0:
        return False
    p = held.point[c]
    rx, ry, rz = contact_arm(system, c, state.Q, p[0], p[1], p[2])
    rate = contact_velocity(system, c, state.v, state.w, rx, ry, rz)[0]
    g = approach_acceleration(system, held, c, state, work)
    if not g > 0.0:
        return False
    e = system.contacts.restitution[c]
    if rate > slow(system, c, state.x, state.v, state.w) and not (
        e < 1.0 and 2.0 * rate < g * (1.0 - e) * horizon
    ):
        return False
    W = work.small
    effective_inverse_mass(system, c, state.x, state.Q, rx, ry, rz, work, W)
    clock.ledger[HANDOVER] -= 0.5 * rate * rate / W[0, 0]
    clock.count[HOLDS] += 1
    spread(system, c, state.x, state.Q, rx, ry, rz, -rate / W[0, 0], 0.0, 0.0, work)
    add_velocity(system, c, work, state.v, state.w)
    settle(system, held, c, state, 0.0, work, clock)
    return True


@kernel
def settle(system, held, c, state, stop, work, clock):
    """Set the mode of a closed contact without normal speed. Slip below `stop` [m/s] has ended."""
    p = held.point[c]
    b = system.contacts.body[c]
    rx, ry, rz = contact_arm(system, c, state.Q, p[0], p[1], p[2])
    u = contact_velocity(system, c, state.v, state.w, rx, ry, rz)
    held.leaving[c] = 0
    held.mode[c] = SLIP
    slip = math.sqrt(u[1] * u[1] + u[2] * u[2])
    if slip <= max(stop, 10.0 * slow(system, c, state.x, state.v, state.w)):
        W = work.small
        effective_inverse_mass(system, c, state.x, state.Q, rx, ry, rz, work, W)
        n, t1, t2 = stick_force(W, u[0], u[1], u[2])
        spread(system, c, state.x, state.Q, rx, ry, rz, n, t1, t2, work)
        add_velocity(system, c, work, state.v, state.w)
        clock.ledger[HANDOVER] += 0.5 * (n * u[0] + t1 * u[1] + t2 * u[2])
        held.mode[c] = STICK
    acc = work.rate[0]
    acceleration(system, state.x, state.Q, state.v, state.w, held, work, acc)
    f = held.force[c]
    if held.mode[c] == STICK and not (
        math.sqrt(f[1] * f[1] + f[2] * f[2]) <= system.contacts.friction[c] * f[0]
    ):
        held.mode[c] = SLIP
    mark_anchor(system, held, c, state)
    if held.mode[c] == STICK and system.bodies.isolated[b] == 1:
        rest_if_still(system, held, c, state, acc, f[0])


@kernel
def mark_anchor(system, held, c, state):
    """Note where the core point of contact c is in the world."""
    b, p = system.contacts.body[c], held.point[c]
    q = state.Q[b]
    r = rotate(q[0], q[1], q[2], q[3], p[0], p[1], p[2])
    for k in range(3):
        held.anchor[c, k] = state.x[b, k] + r[k]


@kernel
def rest_if_still(system, held, c, state, acc, normal):
    """Put the body of contact c to rest, exactly, if neither speed nor acceleration is left.

    No speed: round-off of the speeds that gravity gives it over its own size. No acceleration: round-off
    of what the contact force does to it.
    """
    bodies = system.bodies
    b = system.contacts.body[c]
    size = system.contacts.size[c]
    push = normal / bodies.mass[b]
    speed, rate = 0.0, 0.0
    for k in range(3):
        speed = max(speed, max(abs(state.v[b, k]), size * abs(state.w[b, k])))
        rate = max(rate, max(abs(acc[b, k]), size * abs(acc[b, 3 + k])))
    if rate <= 1e-9 * push and speed <= 1e-9 * math.sqrt(push * size):
        for k in range(3):
            state.v[b, k] = 0.0
            state.w[b, k] = 0.0
        held.rest[c] = 1
