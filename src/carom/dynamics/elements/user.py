"""User-defined rows a(q, t) v = b(q, t): up to six, on any number of bodies.

The function reads the poses (x, Q) of its bodies, in the axes of the scene, and writes rows (6 numbers for each
body, linear then angular, world axes) with b last. The change of the rows in

    a . dv/dt = b' - a' v

is a central difference along the motion, over a displacement of 1e-5 of the size of the bodies. Its relative
error is of the order 1e-10, and each step ends with a return to both levels of the constraint.
"""

from __future__ import annotations

import math

from carom._compiled.call_address import call_function
from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.elements.own_rows import clear
from carom.dynamics.thresholds import DISPLACEMENT
from carom.geometry.rotation import conjugate, multiply, turn
from carom.kinematics.rows import mass_row


@kernel
def read_poses(system, j, state, t, ahead):
    """Write the poses of the bodies after a time `ahead` at constant velocities."""
    user = system.relations.user[system.joints[j].number]
    read, i = system.relations.memory.read, 0
    for s in range(user.first, user.last):
        b = system.solver.sides[s].body
        x, Q, v, w, a = state[b].x, state[b].Q, state[b].v, state[b].w, system.bodies[b].axes
        for k in range(3):
            read[i + k] = x[k] + ahead * v[k]
        q = read[i + 3 : i + 7]
        q[0], q[1], q[2], q[3] = Q[0], Q[1], Q[2], Q[3]
        turn(q, ahead * w[0], ahead * w[1], ahead * w[2])
        q[0], q[1], q[2], q[3] = multiply(q, conjugate(a))
        i += 7
    return user


@kernel
def call_rows(system, j, state, t, ahead):
    """Call the function of the rows for the poses after a time `ahead`; return whose it is."""
    user = read_poses(system, j, state, t, ahead)
    call_function(
        user.address, t + ahead, system.relations.memory.read, system.relations.memory.write
    )
    return user


@kernel
def width_of(user):
    """Return the width of a result: six numbers for each body, and b."""
    return 6 * (user.last - user.first) + 1


@kernel
def write_speeds(system, j, state, t, ahead, out):
    """Write a v - b (rows,) with the rows of the poses after a time `ahead`, and the present velocities."""
    user = call_rows(system, j, state, t, ahead)
    result, width = system.relations.memory.write, width_of(user)
    for r in range(system.joints[j].rows):
        total = -result[(r + 1) * width - 1]
        for s in range(user.first, user.last):
            body, at = state[system.solver.sides[s].body], r * width + 6 * (s - user.first)
            for k in range(3):
                total += result[at + k] * body.v[k] + result[at + 3 + k] * body.w[k]
        out[r] = total


@unit
def write_rows(system, j, state, work):
    """Write A and A M^-1 of the user's rows."""
    user = call_rows(system, j, state, work.moment[0].time, 0.0)
    result, width = system.relations.memory.write, width_of(user)
    for r in range(system.joints[j].rows):
        for s in range(user.first, user.last):
            side, i = system.solver.sides[s], r * width + 6 * (s - user.first)
            for k in range(6):
                side.A[r, k] = result[i + k]
            mass_row(system, side, r, work)


@unit
def position_error(system, j, state, work):
    """Write phi (rows,) to the bias, 0 for rows that restrict velocities only."""
    t, out = work.moment[0].time, work.joint[j].bias
    user = read_poses(system, j, state, t, 0.0)
    clear(out)
    if user.position_address != 0:
        result = system.relations.memory.write
        call_function(user.position_address, t, system.relations.memory.read, result)
        for r in range(system.joints[j].rows):
            out[r] = result[r]


@unit
def velocity_error(system, j, state, work):
    """Write a v - b to the bias."""
    clear(work.joint[j].bias)
    write_speeds(system, j, state, work.moment[0].time, 0.0, work.joint[j].bias)


@unit
def acceleration_bias(system, j, state, work):
    """Write the required values of the rows times the accelerations."""
    t, out, workspace = work.moment[0].time, work.joint[j].bias, work.joint[j].target
    user = system.relations.user[system.joints[j].number]
    g = system.gravity
    fall, ahead = math.sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]), math.inf
    for s in range(user.first, user.last):
        b = system.solver.sides[s].body
        v, w, size = state[b].v, state[b].w, system.bodies[b].extent
        # if nothing moves, the time is relative to that of a fall by the size of the body
        ahead = min(ahead, DISPLACEMENT * (math.sqrt(size / fall) if fall > 0.0 else 1.0))
        speed = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
        speed += size * math.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
        if speed * ahead > DISPLACEMENT * size:
            ahead = DISPLACEMENT * size / speed
    write_speeds(system, j, state, t, ahead, out)
    write_speeds(system, j, state, t, -ahead, workspace)
    for r in range(system.joints[j].rows):
        out[r] = -0.5 * (out[r] - workspace[r]) / ahead


@unit
def prescribed_speeds(system, j, state, work, out):
    """Write b (rows,), the speeds that the rows prescribe."""
    clear(out)
    user = call_rows(system, j, state, work.moment[0].time, 0.0)
    result, width = system.relations.memory.write, width_of(user)
    for r in range(system.joints[j].rows):
        out[r] = result[(r + 1) * width - 1]


@unit
def add_wrenches(system, j, state, multiplier, work):
    """Add A^T multiplier to the wrenches."""
    user = call_rows(system, j, state, work.moment[0].time, 0.0)
    result, width = system.relations.memory.write, width_of(user)
    for r in range(system.joints[j].rows):
        for s in range(user.first, user.last):
            wrench = work.body[system.solver.sides[s].body].wrench
            at = r * width + 6 * (s - user.first)
            for k in range(6):
                wrench[k] += multiplier[r] * result[at + k]


@kernel
def restricts_velocities_only(system, joint):
    """Return whether the rows have no function of the position."""
    return system.relations.user[joint.number].position_address == 0
