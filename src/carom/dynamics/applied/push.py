"""Springs, dampers, forces and motors along coordinates of joints.

Q = -k (q - rest) - c q' + F,       U = k (q - rest)^2 / 2

A motor with limits has the nearest value of low (1 + q'/n) <= Q <= high (1 - q'/n), n its rate without a load,
and no potential. A strand pulls only: it has Q <= 0, and U = 0 for q < rest.
"""

from __future__ import annotations

import math

from carom._compiled.call_address import call_function
from carom._compiled.decorators import kernel
from carom.kinematics import combination
from carom.kinematics.combination import first_of, rate, value
from carom.kinematics.coordinate import slides
from carom.kinematics.joints import child_arm
from carom.scene.strand_force import PULLS


@kernel
def push_force(relations, one, q, speed, t):
    """Return the force along a coordinate, and the part of it that has no potential."""
    free = one.force - one.damping * speed
    if one.address != 0:
        relations.memory.read[0], relations.memory.read[1] = q, speed
        call_function(one.address, t, relations.memory.read, relations.memory.write)
        free += relations.memory.write[0]
    force = free - one.stiffness * (q - one.rest)
    if one.limited == PULLS:
        force = min(force, 0.0)
        return force, force + one.stiffness * max(q - one.rest, 0.0)
    if one.limited == 1:
        fallen = speed / one.no_load if one.no_load > 0.0 else 0.0
        force = min(max(force, one.low * (1.0 + fallen)), one.high * (1.0 - fallen))
        return force, force
    return force, free


@kernel
def add(system, one, state, power, work):
    """Add a force along a coordinate; return `power` with that of its part without potential, and the force."""
    t = work.moment[0].time
    c = system.relations.coordinates[one.coordinate]
    speed = rate(system, c, state)
    force, free = push_force(system.relations, one, value(system, c, state), speed, t)
    combination.push(system, c, state, force, work)
    return power + free * speed, force, math.nan, math.nan


@kernel
def acts_along(c, state):
    """Return the arm of the child to where a force along a coordinate acts; 0 for a torque."""
    if slides(c):
        return child_arm(c, state)
    return 0.0, 0.0, 0.0


@kernel
def acts_at(system, one, state):
    """Return the arm of the child to where it acts."""
    c = system.relations.coordinates[one.coordinate]
    return acts_along(first_of(system, c), state)


@kernel
def energy(system, one, state, t):
    """Return the energy of a spring along a coordinate [J]; a motor with limits has none."""
    if one.limited == 1:
        return 0.0
    stretch = value(system, system.relations.coordinates[one.coordinate], state) - one.rest
    if one.limited == PULLS and stretch < 0.0:
        return 0.0
    return 0.5 * one.stiffness * stretch * stretch


@kernel
def unit_force(system, one, n, state, work):
    """Add the wrenches of a unit force along the coordinate; return this and its rate."""
    c = system.relations.coordinates[one.coordinate]
    combination.push(system, c, state, 1.0, work)
    return value(system, c, state), rate(system, c, state)
