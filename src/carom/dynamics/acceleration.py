"""Accelerations of all bodies: applied forces, joints, and the force of a contact at one point.

A persistent contact has the force lam = (N, T). While it slips, T = -mu N u_t/|u_t| and the normal row of
du/dt vanishes; while it sticks (or rolls) all three rows vanish. Points that share their bodies with others are
left out here: `carom.persistent.contact_step` treats them.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.contact.gap import slow
from carom.contact.pair_point import drift
from carom.contact.place import place_active
from carom.dynamics.contact_impulse import (
    alone,
    effective_inverse_mass,
    spread,
)
from carom.dynamics.elements import acceleration_bias, driven_power
from carom.dynamics.forces import applied_wrenches
from carom.dynamics.friction import slip_force, stick_force
from carom.dynamics.joint_friction import joint_friction
from carom.dynamics.solve import solve
from carom.dynamics.stiff import add_stiff
from carom.kinematics.contact_point import (
    contact_acceleration,
    contact_velocity,
)

OPEN, SLIP, STICK = range(3)


@unit
def _bias_joints(system, state, work):
    """Write the bias of the relative acceleration of each joint."""
    for j in range(system.joints.shape[0]):
        acceleration_bias(system, j, state, work)


@inlined
def bias_joints(system, state, work):
    """Write the bias of the relative acceleration of each joint."""
    if system.joints.shape[0] > 0:
        _bias_joints(system, state, work)


@unit
def acceleration_unit(system, state, active, work, stage):
    """Write the accelerations into `rate` of `stage`, the powers of loads and of friction to work.result."""
    accelerations(system, state, active, work, stage)


@kernel
def accelerations(system, state, active, work, stage):
    """Do the same as `acceleration_unit`, compiled as a part of the caller."""
    applied = applied_wrenches(system, state, True, work)
    applied += add_stiff(system, state, work)
    bias_joints(system, state, work)
    friction = joint_friction(system, state, work)
    solve(system, state, True, work)
    applied += driven_power(system, state, work)
    for b in range(system.bodies.shape[0]):
        motion, rate = work.body[b].motion, stage[b].rate
        for k in range(6):
            rate[k] = motion[k]
    for i in range(active.count[0]):
        active_point = active.points[i]
        if active_point.mode != OPEN and active_point.several == 0 and active_point.rest == 0:
            contact, point = system.contacts[active_point.contact], work.point[0]
            place_active(system, active_point, state, point, work)
            effective_inverse_mass(system, point, state, work, active_point.W)
            applied += add_contact_force(system, contact, active_point, point, state, work, stage)
            if active_point.mode == SLIP:
                _, u1, u2 = contact_velocity(point, state)
                friction += active_point.force[1] * u1 + active_point.force[2] * u2
    work.result[0].power, work.result[0].drag = applied, friction


@inlined
def acceleration(system, state, active, work, stage):
    """Write the accelerations into `rate` of `stage`; return the powers of loads and of friction."""
    acceleration_unit(system, state, active, work, stage)
    return work.result[0].power, work.result[0].drag


@kernel
def note_slip_directions(system, active, state, work):
    """Store directions and speeds of slip at the start of a step."""
    for i in range(active.count[0]):
        active_point = active.points[i]
        heading = active_point.heading
        heading[0], heading[1], active_point.speed = 0.0, 0.0, 0.0
        if active_point.mode == SLIP:
            contact, point = system.contacts[active_point.contact], work.point[0]
            place_active(system, active_point, state, point, work)
            u1, u2 = slip_direction(contact, active_point, point, state)
            speed = math.sqrt(u1 * u1 + u2 * u2)
            if speed > 0.0:
                heading[0], heading[1], active_point.speed = u1 / speed, u2 / speed, speed


@kernel
def slip_direction(contact, active_point, point, state):
    """Return a vector along the slip that friction opposes; 0 if slip has not started yet.

    If slip reverses within the step, friction keeps its direction: the force is smooth up to the end of the
    step, where the reversal is detected and located. (A force that turned with the slip would keep the slip
    near zero, and the end of the step would show no reversal.)
    """
    _, u1, u2 = contact_velocity(point, state)
    if not math.sqrt(u1 * u1 + u2 * u2) > 10.0 * slow(contact, state):
        return active_point.heading[0], active_point.heading[1]
    if u1 * active_point.heading[0] + u2 * active_point.heading[1] < 0.0:
        return -u1, -u2
    return u1, u2


@kernel
def add_contact_force(system, contact, active_point, point, state, work, stage):
    """Find the force that satisfies the rows of one active point, and add its effect to the accelerations.

    Return the power that this force causes in prescribed motions.
    """
    f, W = active_point.force, active_point.W
    an, a1, a2 = contact_acceleration(point, state, stage)
    if contact.touches != 0:
        d = drift(system, contact, active_point.feature, active_point.point, point, state, work)
        an, a1, a2 = an + d[0], a1 + d[1], a2 + d[2]
    if active_point.mode == STICK:
        n, t1, t2 = stick_force(W, an, a1, a2)
    else:
        u1, u2 = slip_direction(contact, active_point, point, state)
        n, t1, t2 = slip_force(W, an, a1, a2, u1, u2, contact.friction_held)
        if (
            active_point.speed == 0.0
            and active_point.heading[0] == 0.0
            and active_point.heading[1] == 0.0
        ):
            size = math.sqrt(t1 * t1 + t2 * t2)
            if size > 0.0:  # direction in which slip starts
                active_point.heading[0], active_point.heading[1] = -t1 / size, -t2 / size
    f[0], f[1], f[2] = n, t1, t2
    spread(system, point, state, n, t1, t2, work)
    if alone(system, point):
        accelerate(work.body[point.a].motion, stage[point.a].rate)
        return 0.0
    for b in range(stage.shape[0]):
        accelerate(work.body[b].motion, stage[b].rate)
    return driven_power(system, state, work)


@kernel
def accelerate(motion, rate):
    """Add a motion to the accelerations of a body."""
    for k in range(6):
        rate[k] += motion[k]
