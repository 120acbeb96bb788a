"""Accelerations of all bodies under applied forces and joints; `carom.persistent.rows` adds contacts."""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.dynamics.elements import acceleration_bias, driven_power
from carom.dynamics.forces import applied_wrenches
from carom.dynamics.joint_friction import joint_friction
from carom.dynamics.solve import solve
from carom.dynamics.stiff import add_stiff

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
def acceleration_unit(system, state, work, stage):
    """Write the accelerations into `rate` of `stage`, the powers of loads and of friction to work.result."""
    accelerations(system, state, work, stage)


@unit
def acceleration_without_friction(system, state, work, stage):
    """Do the same without friction in joints, which is among the rows of a group in contact."""
    applied = applied_wrenches(system, state, True, work)
    applied += add_stiff(system, state, work)
    bias_joints(system, state, work)
    note_accelerations(system, state, applied, 0.0, work, stage)


@kernel
def accelerations(system, state, work, stage):
    """Do the same as `acceleration_unit`, compiled as a part of the caller."""
    applied = applied_wrenches(system, state, True, work)
    applied += add_stiff(system, state, work)
    bias_joints(system, state, work)
    friction = joint_friction(system, state, work)
    note_accelerations(system, state, applied, friction, work, stage)


@kernel
def note_accelerations(system, state, applied, friction, work, stage):
    """Solve for the accelerations under the wrenches of all bodies, and note them and the powers."""
    solve(system, state, True, work)
    applied += driven_power(system, state, work)
    for b in range(system.bodies.shape[0]):
        motion, rate = work.body[b].motion, stage[b].rate
        for k in range(6):
            rate[k] = motion[k]
    work.result[0].power, work.result[0].drag = applied, friction


@inlined
def acceleration(system, state, work, stage):
    """Write the accelerations into `rate` of `stage`; return the powers of loads and of friction."""
    acceleration_unit(system, state, work, stage)
    return work.result[0].power, work.result[0].drag


@kernel
def accelerate(motion, rate):
    """Add a motion to the accelerations of a body."""
    for k in range(6):
        rate[k] += motion[k]
