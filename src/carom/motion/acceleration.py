"""Accelerations of all bodies: applied forces, joints, and the forces of held contacts.

A held contact answers with lam = (N, T). While it slips, T = -mu N u_t/|u_t| and the normal row of
du/dt vanishes; while it sticks (or rolls) all three rows vanish. Contacts that share a mechanism are
brought together by block Gauss-Seidel.
"""

from __future__ import annotations

import math

from carom.contact.gap import slow
from carom.dispatch import only_with_joints
from carom.jit import kernel
from carom.motion.contact_point import (
    contact_acceleration,
    contact_arm,
    contact_velocity,
    effective_inverse_mass,
    reached,
    spread,
)
from carom.motion.forces import applied_wrenches
from carom.motion.friction import slip_force, stick_force
from carom.motion.joints import acceleration_bias
from carom.motion.solve import solve

OPEN, SLIP, STICK = range(3)


@kernel
def _bias_joints(system, state, work):
    """Write the bias of the relative acceleration of each joint."""
    for j in range(system.joints.shape[0]):
        acceleration_bias(system.joints[j], state, work.joint[j].bias)


@kernel
def _no_joints(system, state, work):
    """Without joints there is none."""


bias_joints = only_with_joints(_bias_joints, _no_joints)


@kernel
def acceleration(system, state, held, work, stage):
    """Write the accelerations into `rate` of `stage`; return the powers of loads and of friction."""
    applied = applied_wrenches(system, state, True, work)
    bias_joints(system, state, work)
    solve(system, state, True, work)
    for b in range(system.bodies.shape[0]):
        motion, rate = work.body[b].motion, stage[b].rate
        for k in range(6):
            rate[k] = motion[k]
    count = 0
    for c in range(held.shape[0]):
        if held[c].mode != OPEN:
            count += 1
            contact, force = system.contacts[c], held[c].force
            rx, ry, rz = contact_arm(contact, state, held[c].point)
            effective_inverse_mass(system, contact, state, rx, ry, rz, work, held[c].W)
            for k in range(3):
                force[k] = 0.0
    if count == 0:
        return applied, 0.0
    for _sweep in range(1 if count == 1 else 200):
        change, largest = 0.0, 0.0
        for c in range(held.shape[0]):
            if held[c].mode != OPEN:
                change = max(change, relax(system, system.contacts[c], held[c], state, work, stage))
                largest = max(largest, abs(held[c].force[0]))
        if not (change > 1e-15 * largest):
            break
    return applied, friction_power(system, state, held)


@kernel
def friction_power(system, state, held):
    """Return the power of friction in slipping contacts."""
    power = 0.0
    for c in range(held.shape[0]):
        if held[c].mode == SLIP:
            rx, ry, rz = contact_arm(system.contacts[c], state, held[c].point)
            u = contact_velocity(system.contacts[c], state, rx, ry, rz)
            power += held[c].force[1] * u[1] + held[c].force[2] * u[2]
    return power


@kernel
def aim(system, held, state):
    """Note the directions of slip at the start of a step."""
    for c in range(held.shape[0]):
        heading = held[c].heading
        heading[0], heading[1] = 0.0, 0.0
        if held[c].mode == SLIP:
            contact = system.contacts[c]
            rx, ry, rz = contact_arm(contact, state, held[c].point)
            u1, u2 = slip_direction(contact, held[c], state, rx, ry, rz)
            speed = math.sqrt(u1 * u1 + u2 * u2)
            if speed > 0.0:
                heading[0], heading[1] = u1 / speed, u2 / speed


@kernel
def slip_direction(contact, hold, state, rx, ry, rz):
    """Return a vector along the slip that friction opposes; 0 where slip has yet to start.

    Once slip has turned against the direction it had at the start of the step, friction goes on as before: a
    smooth force up to the end of the step, where the reversal is seen and located. (A force that turned with
    the slip would hold the slip near zero, and the end of the step would show no reversal.)
    """
    _, u1, u2 = contact_velocity(contact, state, rx, ry, rz)
    if not math.sqrt(u1 * u1 + u2 * u2) > 10.0 * slow(contact, state):
        return hold.heading[0], hold.heading[1]
    if u1 * hold.heading[0] + u2 * hold.heading[1] < 0.0:
        return -u1, -u2
    return u1, u2


@kernel
def relax(system, contact, hold, state, work, stage):
    """Change the force of one held contact so that its own rows are met; return the change."""
    f, W = hold.force, hold.W
    rx, ry, rz = contact_arm(contact, state, hold.point)
    a = contact_acceleration(contact, state, stage[contact.body].rate, hold.point, rx, ry, rz)
    # what the acceleration would be without this contact's own force
    an = a[0] - W[0, 0] * f[0] - W[0, 1] * f[1] - W[0, 2] * f[2]
    a1 = a[1] - W[1, 0] * f[0] - W[1, 1] * f[1] - W[1, 2] * f[2]
    a2 = a[2] - W[2, 0] * f[0] - W[2, 1] * f[1] - W[2, 2] * f[2]
    if hold.mode == STICK:
        n, t1, t2 = stick_force(W, an, a1, a2)
    else:
        u1, u2 = slip_direction(contact, hold, state, rx, ry, rz)
        n, t1, t2 = slip_force(W, an, a1, a2, u1, u2, contact.friction)
    change = max(abs(n - f[0]), max(abs(t1 - f[1]), abs(t2 - f[2])))
    spread(system, contact, state, rx, ry, rz, n - f[0], t1 - f[1], t2 - f[2], work)
    first, last = reached(system, contact)
    for b in range(first, last):
        rate, motion = stage[b].rate, work.body[b].motion
        for k in range(6):
            rate[k] += motion[k]
    f[0], f[1], f[2] = n, t1, t2
    return change
