"""Accelerations of all bodies under applied forces and joints.

`carom.persistent.rows` adds contacts and dry friction in joints.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.element_operations import acceleration_bias, driven_power
from carom.dynamics.elements.stiff import add_stiff
from carom.dynamics.forces import applied_wrenches
from carom.dynamics.solve import solve
from carom.model.parts_of_system import has_joints


@unit(where=has_joints)
def bias_joints(system, state, work):
    """Write the bias of the relative acceleration of each joint."""
    for j in range(system.joints.shape[0]):
        acceleration_bias(system, j, state, work)


@unit
def acceleration(system, state, work, stage) -> float:
    """Write the accelerations into `rate` of `stage`; return the power of loads."""
    return accelerations(system, state, work, stage)


@kernel
def accelerations(system, state, work, stage):
    """Do the same as `acceleration`, compiled as a part of the caller."""
    applied = applied_wrenches(system, state, True, work)
    applied += add_stiff(system, state, work)
    bias_joints(system, state, work)
    solve(system, state, True, work)
    power = applied + driven_power(system, state, work)
    for b in range(system.bodies.shape[0]):
        motion, rate = work.body[b].motion, stage[b].rate
        for k in range(6):
            rate[k] = motion[k]
    return power


@kernel
def accelerate(motion, rate):
    """Add a motion to the accelerations of a body."""
    for k in range(6):
        rate[k] += motion[k]
