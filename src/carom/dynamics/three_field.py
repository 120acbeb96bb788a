"""The paper's scheme: position, velocity and momentum as three fields, solved block by block. Order 2.

Over a step h the position moves along one autoparallel with the average velocity, momenta live at
the nodes (paper, Eqs. (4)-(7)):

    (P)  q1 = Exp_q0(h vbar),   vbar = (v0 + v1)/2 in the left-invariant frame
    (V)  p = M v
    (M)  p1 = transport of p0 + h (force + sum of hbar_R a^R) at the middle of the arc

In world axes the transported angular momentum is the spatial one, l1 = l0 + h torque. A block iteration
solves velocities and multipliers with the position frozen, then the position:

    [ M(q^j)   -Abar^T ] [v1 ]   [p0 + h f]
    [ A(q^j)   eps     ] [Lam] = [r       ],     Lam = h hbar,

the second row by the augmented Lagrangian: the rows at the end give the impulse A^T mu that satisfies it, and
the multipliers at the middle take it over once in each block iteration,

    Lam += (Abar M^-1 Abar^T + eps)^-1 Abar M^-1 A^T mu.

So redundant rows do no harm, and their reactions have the least norm. Where bars are in line, rows at the
middle cannot correct those at the end; what they do not take over in ten passes stays with the rows at the
end (of order 1, in the steps through such a position only). "paper" takes r = 0
and returns the position to the constraints; "paper-ode" keeps the second-order equation of each constraint,

    (m_RR phi')' + c_s phi' + k_s phi = 0:   r = (phi'_0 - (beta^2/h) phi(q^j)) / (1 + 2 zeta beta),

c_s = 2 zeta (beta/h) m_RR, k_s = (beta/h)^2 m_RR, and does not return. For a free body energy and spatial
angular momentum are exact. While contacts are active, the explicit method takes the step.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.element_operations import (
    add_wrenches,
    position_error,
    prescribed_speeds,
    row_target,
    velocity_error,
)
from carom.dynamics.energy import spin_momentum
from carom.dynamics.explicit import (
    any_held,
    bound_changes,
    constrained,
    copy_state,
    fly,
    forget_bounds,
    mark_active,
)
from carom.dynamics.forces import applied_wrenches
from carom.dynamics.loops import add_reactions, factor, substitute, subtract_rows
from carom.dynamics.project import project_position, project_velocity
from carom.dynamics.solve import free_body
from carom.dynamics.thresholds import SLOWEST
from carom.geometry.rotation import rotate, rotate_back, turn
from carom.geometry.thresholds import LAST_DIGIT
from carom.model.arrays import LOOPS
from carom.model.workspace import RESTS
from carom.status import NO_CONVERGENCE

PASSES = 10  # block iterations in which multipliers at the middle take over from rows at the end


@unit
def three_field_step(model, data, method, h) -> tuple[float, int]:
    """Write the state a time h later into `work.trial`; return the work of loads, and a status."""
    system, start, work, end = model.system, data.state, data.work, data.work.trial
    if any_held(data.active):
        if not fly(model, data, h):
            return 0.0, 0
        return constrained(model, data, method, h)
    mark_active(data.active, work)
    first_guess(system, start, h, end, work)
    if method.ode == 1:
        start_rates(system, start, work)
    change, applied = math.inf, 0.0
    for i in range(method.most):
        middle_of_arc(start, h, end, work.middle)
        work.moment[0].time = work.moment[0].start + 0.5 * h
        applied = h * applied_wrenches(system, work.middle, False, work)
        momenta(system, start, h, work)
        previous, work.moment[0].time = change, work.moment[0].start + h
        change = velocity_block(system, method, h, end, work)
        if i < PASSES and system.solver.kind == LOOPS:
            hand_over(system, method, h, work)
        change = max(change, position_block(system, method, start, h, end, work))
        # rows nearly in line amplify round-off by the inverse of their angle: the last iteration takes that
        fine = change <= 1e6 * method.tolerance and change >= 0.5 * previous
        if system.solver.kind == LOOPS and i + 1 == method.most:
            fine = fine or change <= 1e9 * method.tolerance
        if fine or change <= method.tolerance:
            if method.ode == 0 and change > method.tolerance:
                project_velocity(system, end, False, work)
            leave_for_later(system, start, h, end, work)
            return applied + driven_work(system, start, h, end, work), 0
    return applied, NO_CONVERGENCE


@kernel
def first_guess(system, start, h, end, work):
    """Start from free motion with the velocity of the beginning, and no reactions."""
    for j in range(system.joints.shape[0]):
        for k in range(6):
            work.joint[j].multiplier[k] = 0.0
    for b in range(start.shape[0]):
        copy_state(start[b], end[b])
        if work.body[b].status == RESTS:
            continue
        x, v, w = end[b].x, end[b].v, end[b].w
        for k in range(3):
            x[k] += h * v[k]
        turn(end[b].Q, h * w[0], h * w[1], h * w[2])


@kernel
def mean_turn(start, end):
    """Return the mean of the body-frame angular velocities of a body at both ends."""
    p, q = start.Q, end.Q
    W0 = rotate_back(p, start.w)
    W1 = rotate_back(q, end.w)
    return 0.5 * (W0[0] + W1[0]), 0.5 * (W0[1] + W1[1]), 0.5 * (W0[2] + W1[2])


@kernel
def move_along(start, end, h, out):
    """Write into `out` the pose Exp at `start` of h vbar, vbar the mean velocity of both records."""
    W, q = mean_turn(start, end), start.Q
    w = rotate(q, W)
    for k in range(3):
        out.x[k] = start.x[k] + 0.5 * h * (start.v[k] + end.v[k])
    for k in range(4):
        out.Q[k] = q[k]
    turn(out.Q, h * w[0], h * w[1], h * w[2])


@kernel
def middle_of_arc(start, h, end, middle):
    """Write the middle of the arc: Exp_q0(h vbar/2), with velocity vbar."""
    for b in range(start.shape[0]):
        W = mean_turn(start[b], end[b])
        move_along(start[b], end[b], 0.5 * h, middle[b])
        q, w = middle[b].Q, middle[b].w
        w[0], w[1], w[2] = rotate(q, W)
        for k in range(3):
            middle[b].v[k] = 0.5 * (start[b].v[k] + end[b].v[k])


@kernel
def take_up_momentum(body, q, w, memory):
    """Write the spatial momentum into `memory`, unless the momentum of the last step there belongs to w.

    Computed anew from Q and w at each step, it would drift by the round-off of each step, which has always the
    same sign: 2e-11 of the energy in 10^5 steps.
    """
    spin, l = memory.spin, memory.momentum
    if spin[0] == w[0] and spin[1] == w[1] and spin[2] == w[2]:
        return
    l[0], l[1], l[2] = spin_momentum(body, q, w)


@kernel
def momenta(system, start, h, work):
    """Turn the wrenches into momenta at the end, about each centre, in world axes (paper, Eqs. (4)-(7)).

    That is p0 + h f + Abar^T Lam.

    The scale of convergence is stored in `bound`: the speed that each body would have without reactions, but at
    least 1e-6 of its size per step (round-off of positions is 1e-10 of that).
    """
    for b in range(system.bodies.shape[0]):
        body, wrench, l = system.bodies[b], work.body[b].wrench, work.body[b].momentum
        J = body.inertia
        take_up_momentum(body, start[b].Q, start[b].w, work.body[b])
        for k in range(3):
            wrench[k] = h * wrench[k] + body.mass * start[b].v[k]
            wrench[3 + k] = h * wrench[3 + k] + l[k]
        bound, speed = work.body[b].bound, SLOWEST * body.extent / h
        for k in range(3):
            spin = body.extent * abs(wrench[3 + k]) / max(J[0], max(J[1], J[2]))
            speed = max(speed, max(abs(wrench[k]) / body.mass, spin))
        bound[0] = speed
    for j in range(system.joints.shape[0]):
        add_wrenches(system, j, work.middle, work.joint[j].multiplier, work)


@kernel
def set_velocities(system, end, work):
    """Write the motions as velocities v1; return the largest change, relative to the largest speed."""
    change, speed = 0.0, 0.0
    for b in range(system.bodies.shape[0]):
        if work.body[b].status == RESTS:
            continue
        size, motion, v, w = system.bodies[b].extent, work.body[b].motion, end[b].v, end[b].w
        for k in range(3):
            change = max(change, max(abs(motion[k] - v[k]), size * abs(motion[3 + k] - w[k])))
            speed = max(speed, max(abs(motion[k]), size * abs(motion[3 + k])))
            speed = max(speed, work.body[b].bound[0])  # also in equilibrium
            v[k], w[k] = motion[k], motion[3 + k]
    return change / speed if speed > 0.0 else 0.0


@kernel
def velocity_block_loops(system, method, h, end, work):
    """Write the velocities that the rows at the end allow, with the impulse of these rows."""
    factor(system, end, 0.0, work)
    for j in range(system.joints.shape[0]):
        rhs = system.solver.rows[j].rhs
        prescribed_speeds(system, j, end, work, rhs)
        if method.ode == 1:
            wanted_rate(system, j, method, h, end, work)
    subtract_rows(system, work)
    substitute(system)
    add_reactions(system, work)
    return set_velocities(system, end, work)


@kernel
def hand_over(system, method, h, work):
    """Hand the impulse of rows at the end, A^T mu, over to those at the middle: Lam += Abar^+ (A^T mu).

    Least squares of A^T mu - Abar^T dLam in the metric M^-1, with the penalty of the augmented Lagrangian.
    """
    for b in range(system.bodies.shape[0]):
        for k in range(6):
            work.body[b].motion[k] = 0.0
    add_reactions(system, work)
    work.moment[0].time = work.moment[0].start + 0.5 * h
    factor(system, work.middle, method.augment, work)
    for j in range(system.joints.shape[0]):
        for r in range(6):
            system.solver.rows[j].rhs[r] = 0.0
    subtract_rows(system, work)
    substitute(system)
    for j in range(system.joints.shape[0]):
        for r in range(system.joints[j].rows):
            work.joint[j].multiplier[r] -= system.solver.rows[j].rhs[r]
    work.moment[0].time = work.moment[0].start + h


@kernel
def driven_work(system, start, h, end, work):
    """Return the work of prescribed motions: impulse of each row times its mean speed."""
    total, moment = 0.0, work.moment[0]
    for j in range(system.joints.shape[0]):
        record = work.joint[j]
        for side in range(2):
            moment.time = moment.start + (h if side == 1 else 0.0)
            prescribed_speeds(system, j, end if side == 1 else start, work, record.reaction)
            for r in range(system.joints[j].rows):
                total += 0.5 * record.multiplier[r] * record.reaction[r]
    return total


@kernel
def velocity_block(system, method, h, end, work):
    """Write the velocities at the end; return the largest change (paper, Eqs. (4)-(7))."""
    for b in range(system.bodies.shape[0]):
        free_body(system.bodies[b], end[b].Q, work.body[b])
    if system.solver.kind == LOOPS:
        return velocity_block_loops(system, method, h, end, work)
    return set_velocities(system, end, work)


@kernel
def start_rates(system, start, work):
    """Store phi' of all rows at the start of the step."""
    for j in range(system.joints.shape[0]):
        record = work.joint[j]
        velocity_error(system, j, start, work)
        row_target(system, j, start, record.bias, record.target)


@kernel
def wanted_rate(system, j, method, h, end, work):
    """Add r = (phi'_0 - (beta^2/h) phi)/(1 + 2 zeta beta) of the rows of an element to their rhs."""
    record, rhs = work.joint[j], system.solver.rows[j].rhs
    position_error(system, j, end, work)
    row_target(system, j, end, record.bias, record.reaction)
    divisor = 1.0 + 2.0 * method.zeta * method.beta
    first, phi = record.target, record.reaction
    for r in range(system.joints[j].rows):
        rhs[r] += (first[r] - method.beta * method.beta / h * phi[r]) / divisor


@kernel
def position_block(system, method, start, h, end, work):
    """Move to q1 = Exp_q0(h vbar) and return to the joints (paper, Eqs. (4)-(7)).

    Returns the largest move, relative to the body.
    """
    last, change = work.iterate, 0.0
    for b in range(start.shape[0]):
        copy_state(end[b], last[b])
        if work.body[b].status != RESTS:
            move_along(start[b], last[b], h, end[b])
    if method.ode == 0 and system.joints.shape[0] > 0:
        project_position(system, end, False, LAST_DIGIT, work)
    for b in range(start.shape[0]):
        size = system.bodies[b].extent
        for k in range(3):
            change = max(change, abs(end[b].x[k] - last[b].x[k]) / size)
        for k in range(4):
            change = max(change, abs(end[b].Q[k] - last[b].Q[k]))
    return change


@kernel
def leave_for_later(system, start, h, end, work):
    """Store the momentum of free bodies, and bounds of accelerations."""
    forget_bounds(work)
    for b in range(start.shape[0]):
        memory = work.body[b]
        bound_changes(start[b], end[b], h, memory.bound)
        if system.bodies[b].isolated == 1:  # the next step uses this momentum, not a new one
            for k in range(3):
                memory.spin[k], memory.momentum[k] = end[b].w[k], memory.wrench[3 + k]
