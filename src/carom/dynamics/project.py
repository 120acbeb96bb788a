"""Return to the joints: the shortest displacement and the smallest velocity change, in the kinetic metric.

    xi = -M^-1 A^T (A M^-1 A^T)^+ phi,   q <- Exp_q(xi);    v <- v - M^-1 A^T (A M^-1 A^T)^+ A v

Both are results of the constrained solve with the error as its bias.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import entry, kernel
from carom._compiled.units import unit
from carom.dynamics.contact_impulse import clear_wrenches, gain
from carom.dynamics.element_operations import position_error, velocity_error
from carom.dynamics.rotors import keep_rates
from carom.dynamics.solve import solve, solve_near
from carom.dynamics.thresholds import JOINT_ERROR, JOINT_NOISE, START_ERROR
from carom.geometry.rotation import turn
from carom.geometry.thresholds import EPSILON
from carom.kinematics.curve import seek_feet
from carom.model.parts_of_system import has_joints


@kernel
def shift(xi, part, body):
    """Move one body by a part of a displacement in world axes: x + xi_x, exp(xi_theta) Q."""
    for k in range(3):
        body.x[k] += part * xi[k]
    turn(body.Q, part * xi[3], part * xi[4], part * xi[5])


@kernel
def largest_position_error(system, state, work):
    """Write minus the errors of position as biases of all joints; return the largest, relative to its body.

    The round-off of the coordinates is subtracted from lengths: far from the origin they cannot be more exact.
    """
    largest = 0.0
    for j in range(system.joints.shape[0]):
        bias, child = work.joint[j].bias, system.joints[j].child
        size, x = 1.0 / system.bodies[child].extent, state[child].x
        near = 2.0 * EPSILON * (abs(x[0]) + abs(x[1]) + abs(x[2]))
        position_error(system, j, state, work)
        for k in range(6):
            e = abs(bias[k]) if k < 3 else (abs(bias[k]) - near) * size
            if not e <= largest and largest == largest:  # NaN replaces any number, and stays
                largest = e
            bias[k] = -bias[k]
    return largest


@unit(where=has_joints, otherwise=0.0)
def project_position(system, state, near, tolerance, work) -> float:
    """Bring the positions back to the joints; return the remaining relative error.

    With `near`, the last solve was in a position nearby, and its factor serves for the first correction.
    """
    error, before = 0.0, math.inf
    for _ in range(8):
        error = largest_position_error(system, state, work)
        # an error that decreases no more is round-off of the coordinates, far from the origin
        if error <= tolerance or (error <= JOINT_NOISE and error >= 0.5 * before):
            break
        before = error
        clear_wrenches(work)
        if near:
            solve_near(system, state, work)
            near, before = False, math.inf  # a slow decrease is allowed once
        else:
            solve(system, state, True, work)
        for b in range(state.shape[0]):
            shift(work.body[b].motion, 1.0, state[b])
    return error


@unit(where=has_joints)
def project_velocity(system, state, carried, work):
    """Remove the velocities that the joints forbid.

    With `carried`, the velocities are from the momenta of bodies, and rotors keep the rates that `rotors` has
    stored.
    """
    for j in range(system.joints.shape[0]):
        bias = work.joint[j].bias
        velocity_error(system, j, state, work)
        for k in range(6):
            bias[k] = -bias[k]
    clear_wrenches(work)
    if carried:
        keep_rates(system, state, work)
    solve(system, state, True, work)
    for b in range(state.shape[0]):
        gain(work.body[b].motion, state[b])


@entry
def project_start(system, state, work):
    """Bring an initial state to the joints, for `Options.project_start`; return the remaining error."""
    error = 1.0
    seek_feet(system, state)
    for _ in range(20):
        error = project_position(system, state, False, JOINT_ERROR, work)
        if error <= START_ERROR:
            break
    project_velocity(system, state, False, work)
    return error
