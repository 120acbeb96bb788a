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
from carom.dispatch import by_address
from carom.jit import kernel, unit
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
from carom.system.records import HOLD, SLIPS, STICKS


@unit
def hold_unit(system, controls, held, c, state, horizon, settle, work, clocks, records):
    """Hold contact c, closed at its point, if it does not approach and the rule says so.

    With `settle` it is held already and slip has come to a stop or has turned: only its mode is found anew.
    """
    contact, hold, clock = system.contacts[c], held[c], clocks[0]
    rx, ry, rz = contact_arm(contact, state, hold.point)
    u = contact_velocity(contact, state, rx, ry, rz)
    still, stop = slow(contact, state), 0.0
    hold.heading[0], hold.heading[1] = 0.0, 0.0
    # once with the contact open: would it approach? once held: does it stick? if not: it slips
    for look in range(3):
        f = hold.force
        if look == 0:
            if settle:
                # slip below what friction does in a thousandth of a step has stopped
                stop = 1e-3 * controls.step * abs(f[0]) * hold.W[1, 1]
            else:
                hold.mode = OPEN
        elif look == 1:
            begin_event(c, state, clock, records)
            if not begin_hold(system, contact, hold, state, u, stop, still, work, clock):
                return
        elif hold.mode == STICK and not (
            math.sqrt(f[1] * f[1] + f[2] * f[2]) <= contact.friction * f[0]
        ):
            hold.mode = SLIP
        else:
            break
        acceleration(system, state, held, work, work.stages[0])
        if look == 0 and not settle:
            rate = work.stages[0, contact.body].rate
            p = hold.point
            g = -contact_acceleration(contact, state, rate, p, rx, ry, rz)[0]
            if not bounces_end(contact, u[0], g, still, horizon):
                return
    body = system.bodies[contact.body]
    if hold.mode == STICK and body.isolated == 1:
        rate = work.stages[0, contact.body].rate
        rest_if_still(contact, hold, state[contact.body], rate, hold.force[0] / body.mass)
    kind = HOLD if not settle else (STICKS if hold.mode == STICK else SLIPS)
    clock.holds += 0 if settle else 1
    end_event(kind, state, clock, records)


#: hold_contact(address, system, controls, held, c, state, horizon, settle, work, clocks, records)
hold_contact = by_address(hold_unit)


@kernel
def bounces_end(contact, rate, g, still, horizon):
    """Return whether a contact leaving at `rate` and drawn back by g is closed for good by `horizon`."""
    if not (g > 0.0 and rate >= -still):
        return False
    e = contact.restitution
    return rate <= still or (e < 1.0 and 2.0 * rate < g * (1.0 - e) * horizon)


@kernel
def begin_hold(system, contact, hold, state, u, stop, still, work, clock):
    """Take out the normal velocity, and slip that has stopped; set the mode to try first.

    Slip has stopped when all of it is below `stop` (or round-off). Returns False if a contact that was
    to settle goes on slipping.
    """
    rx, ry, rz = contact_arm(contact, state, hold.point)
    W = work.hit[0].W
    effective_inverse_mass(system, contact, state, rx, ry, rz, work, W)
    n, t1, t2 = -u[0] / W[0, 0], 0.0, 0.0
    s1, s2 = u[1] + W[1, 0] * n, u[2] + W[2, 0] * n  # slip once the normal velocity is out
    slip = math.sqrt(s1 * s1 + s2 * s2)
    stops = slip <= max(stop, 10.0 * still)
    if stop > 0.0 and not stops:
        return False
    if stops:
        n, t1, t2 = stick_force(W, u[0], u[1], u[2])
        s1, s2 = 0.0, 0.0
    hold.mode = STICK if stops else SLIP
    hold.leaving = 0
    spread(system, contact, state, rx, ry, rz, n, t1, t2, work)
    add_velocity(system, contact, work, state)
    # work of the impulse: half of it times the sum of the velocities before and after
    clock.bounces += 0.5 * (n * u[0] + t1 * (u[1] + s1) + t2 * (u[2] + s2))
    return True


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
