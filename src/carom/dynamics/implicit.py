"""A linearly implicit step of order 2, L-stable: springs and dampers are implicit, all other forces explicit.

ROS2 of Verwer, Spee, Blom and Hundsdorfer (1999) in q and v, with g = 1 - 1/sqrt(2),

    (1 - g h J) k1 = F(u0),    (1 - g h J) k2 = F(u0 + h k1) - 2 k1,    u1 = u0 + h (3 k1 + k2)/2,

has order 2 for any J. Here J contains the stiffness k and damping c of the springs along their rows, so that
only the explicit part limits the step. Each stage is one constrained solve in which a spring is a row with a
compliance: with d = g h c + (g h)^2 k its force mu in the stage satisfies

    J a + mu/d = -(k s + c s' + g h k J r)/d,     a: the accelerations, r: the rates at the start of the stage.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.dynamics.acceleration import bias_joints
from carom.dynamics.element_operations import driven_power
from carom.dynamics.elements.stiff import along_row, stretch
from carom.dynamics.explicit import (
    any_held,
    bound_accelerations,
    constrained,
    copy_state,
    fly,
    forget_bounds,
)
from carom.dynamics.forces import applied_wrenches
from carom.dynamics.project import project_position, project_velocity, shift
from carom.dynamics.solve import solve
from carom.dynamics.thresholds import JOINT_ERROR
from carom.geometry.thresholds import RESOLUTION
from carom.status import CONSTRAINTS_LOST

GAMMA = 1.0 - math.sqrt(0.5)


@inlined
def implicit_step(model, data, method, h):
    """Write the state a time h later into `work.trial`; return the work of loads, and a status.

    While contacts are active, the explicit method takes the step.
    """
    if not fly(model, data, h):
        return 0.0, 0
    if any_held(data.active):
        return constrained(model, data, method, h)
    return whole_step(model.system, data.state, h, data.work)


@unit
def whole_step(system, start, h, work) -> tuple[float, int]:
    """Make the two stages, and return to the joints; return the same as `implicit_step`."""
    moment, stage, end, code = work.moment[0], work.stage, work.trial, 0
    moment.time = moment.start
    power = accelerate(system, start, h, 0, work)
    for b in range(start.shape[0]):
        first = work.stages[0, b]
        for k in range(3):
            first.speed[k] = start[b].v[k] + GAMMA * h * first.rate[k]
            first.speed[3 + k] = start[b].w[k] + GAMMA * h * first.rate[3 + k]
        move(start[b], h, first.speed, first.rate, stage[b])
    moment.time = moment.start + h
    power += accelerate(system, stage, h, 1, work)
    for b in range(start.shape[0]):
        if system.bodies[b].ballistic == 1:
            continue
        first, second = work.stages[0, b], work.stages[1, b]
        # k2 from y = k2 + 2 k1; then the second stage stores the mean of the step
        for k in range(6):
            second.rate[k] -= 2.0 * first.rate[k]
            speed = stage[b].v[k] if k < 3 else stage[b].w[k - 3]
            second.speed[k] = speed - 2.0 * first.speed[k] + GAMMA * h * second.rate[k]
            second.speed[k] = 1.5 * first.speed[k] + 0.5 * second.speed[k]
            second.rate[k] = 1.5 * first.rate[k] + 0.5 * second.rate[k]
        move(start[b], h, second.speed, second.rate, end[b])
    forget_bounds(work)
    bound_accelerations(system, work, 2)
    if not (project_position(system, end, False, JOINT_ERROR, work) <= RESOLUTION):
        code = CONSTRAINTS_LOST
    project_velocity(system, end, False, work)
    return 0.5 * h * power + damper_work(system, start, h, end), code


@kernel
def move(start, h, speed, rate, out):
    """Move a body for a time h."""
    copy_state(start, out)
    shift(speed, h, out)
    for k in range(3):
        out.v[k] += h * rate[k]
        out.w[k] += h * rate[3 + k]


@kernel
def accelerate(system, state, h, s, work):
    """Write the accelerations of stage s; return the power of loads and motors, without these dampers."""
    power = applied_wrenches(system, state, True, work)
    bias_joints(system, state, work)
    bias_springs(system, state, h, s, work)
    solve(system, state, True, work)
    power += driven_power(system, state, work)
    for b in range(state.shape[0]):
        motion, rate = work.body[b].motion, work.stages[s, b].rate
        for k in range(6):
            rate[k] = motion[k]
    release_springs(system, state, h, s, work)
    return power


@kernel
def bias_springs(system, state, h, s, work):
    """Add the springs as rows of the solver."""
    g = GAMMA * h
    for i in range(system.relations.stiff.shape[0]):
        one, last = system.relations.stiff[i], system.relations.memory.stiff[i]
        j, row = one.element, system.solver.rows[one.element]
        length, speed = stretch(system, one, state)
        d = g * one.damping + g * g * one.stiffness
        start, more = speed, 0.0
        if s == 1:  # subtract twice the velocities and accelerations of the first stage
            start, more = speed - 2.0 * (last.speed + g * last.gain), 2.0 * last.gain
        last.speed = speed
        force = one.stiffness * length + one.damping * speed + g * one.stiffness * start
        work.joint[j].bias[0] = more - force / d
        row.ignored, row.compliance[0] = 0, 1.0 / d


@kernel
def release_springs(system, state, h, s, work):
    """Remove the springs from the rows again, and store the accelerations of the stage along them."""
    for i in range(system.relations.stiff.shape[0]):
        one, last = system.relations.stiff[i], system.relations.memory.stiff[i]
        row, gain = system.solver.rows[one.element], along_row(system, one, state, work)
        if s == 1:  # sum of the rates of the dampers in both stages, minus the first rate
            last.speed += GAMMA * h * (gain - last.gain)
        last.gain = gain
        row.ignored, row.compliance[0] = 1, 0.0


@kernel
def damper_work(system, start, h, end):
    """Return the work of the dampers: their impulse in the step times the mean rate of its ends.

    In each stage the rate of a damper is s' + g h J a, so that its impulse is -c h/2 times the sum of both.
    (For a stiff damper, the power at the stages could be wrong by any factor.)
    """
    total = 0.0
    for i in range(system.relations.stiff.shape[0]):
        one = system.relations.stiff[i]
        _, first = stretch(system, one, start)
        _, last = stretch(system, one, end)
        rates = system.relations.memory.stiff[i].speed + first
        total -= 0.25 * h * one.damping * rates * (first + last)
    return total
