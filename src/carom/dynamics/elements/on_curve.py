"""A point of one body on a curve of another: two rows across the curve (`carom.kinematics.curve`)."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.kinematics.curve import (
    curve_bias,
    curve_error,
    curve_rows,
    curve_speed,
    find_foot,
    foot_of,
    force_across,
    push_across,
)
from carom.kinematics.rows import mass_row


@kernel
def foot(system, joint, state):
    """Return the foot of a joint on a curve in this state."""
    c = system.relations.coordinates[joint.number]
    find_foot(system, c, state)
    return foot_of(system, c)


@unit
def write_rows(system, j, state, work):
    """Write A and A M^-1 of a joint on a curve."""
    solver, joint = system.solver, system.joints[j]
    at, first, last = foot(system, joint, state), solver.rows[j].first, solver.rows[j].last
    for s in range(first, last):
        curve_rows(joint, at, state, solver.sides[s])
        for r in range(joint.rows):
            mass_row(system, solver.sides[s], r, work)


@unit
def position_error(system, j, state, work):
    """Write the place beside the curve to the bias."""
    joint = system.joints[j]
    curve_error(joint, foot(system, joint, state), work.joint[j].bias)


@unit
def velocity_error(system, j, state, work):
    """Write the speed across the curve to the bias."""
    joint = system.joints[j]
    curve_speed(joint, foot(system, joint, state), state, work.joint[j].bias)


@unit
def acceleration_bias(system, j, state, work):
    """Write the accelerations across the curve that its bend requires."""
    joint = system.joints[j]
    curve_bias(joint, foot(system, joint, state), state, work.joint[j].bias)


@kernel
def row_target(system, j, state, relative, out):
    """Write the errors of the rows: they are lengths, and not angles."""
    for r in range(system.joints[j].rows):
        out[r] = relative[3 + r]


@unit
def add_wrenches(system, j, state, multiplier, work):
    """Add the wrenches of the multipliers."""
    joint = system.joints[j]
    push_across(joint, foot(system, joint, state), state, multiplier, work)


@unit
def report_wrench(system, j, state, reaction):
    """Turn the multipliers of a joint on a curve into the wrench on its child at the point."""
    f = force_across(foot(system, system.joints[j], state), reaction)
    for k in range(3):
        reaction[k], reaction[3 + k] = f[k], 0.0
