"""RATTLE: symmetric, symplectic, constraints exact; order 2, and compositions of order 4 and 6.

A step is half a kick, a move by the discrete Lagrangian of the rotation group, and half a kick. P are the
linear momenta m v and the spatial angular momenta l = R J W (Hamilton-Pontryagin form; Bou-Rabee and Marsden
2009, with unit quaternions as the map):

    P_h = P_0 + h/2 f(q_0, v_0) + A(q_0)^T Lam     with Lam such that phi(q_1) = 0,
    x_1 = x_0 + h P_h/m,     Q_1 = Q_0 (a, b),     a J b + b x J b = h/2 R_0^T l_h,   a^2 + |b|^2 = 1,
    P_1 = P_h + h/2 f(q_1, v_1) + A(q_1)^T Mu      with Mu such that A(q_1) v_1 = 0.

Reactions of a joint do no work on a common motion of all bodies, so momenta of a floating system are conserved.
The map contains the free rotation of a body, so no gyroscopic torque is applied. (Mathematics page, §1.3.)

Lam comes from repeated solves in q_0: without a wrench and with the bias -phi(q_1)/h the constrained solve
gives the motion dV with M dV = A(q_0)^T dLam and A dV = -phi/h, and M dV is added to P_h. Each iteration
reduces the error by a factor of the order of the rotation angle in the step, down to round-off. Rows without
phi (nonholonomic) hold in the mean of both ends for the displacement from q_0 to q_1. Near a singular position
the rows of q_0 cannot correct those of q_1: if the iteration does not converge, or rows are left out only at
one end, the explicit method takes the step.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.dynamics.contact_impulse import clear_wrenches
from carom.dynamics.discrete_rotation import turn_by_momentum
from carom.dynamics.element_operations import driven_power, has_own_rows, write_reaction
from carom.dynamics.explicit import any_held, bound_changes, constrained, copy_state, fly
from carom.dynamics.kick import add_momentum, first_kick, second_kick
from carom.dynamics.loops import dropped_rows, solve_factored
from carom.dynamics.move_error import error_of_move
from carom.dynamics.solve import solve, solve_near
from carom.dynamics.thresholds import COORDINATE_ERROR
from carom.geometry.thresholds import LAST_DIGIT
from carom.model.arrays import LOOPS
from carom.model.parts_of_system import has_joints
from carom.status import NO_CONVERGENCE

DONE, STALLED, TOO_FAR = range(3)  # how a part of a step ended
SOLVES = 60  # solves for Lam


@inlined
def rattle_step(model, data, method, h):
    """Write the state a time h later into `work.trial`; return the work of loads, and a status.

    While contacts are active, the explicit method takes the step.
    """
    if not fly(model, data, h):
        return 0.0, 0
    if any_held(data.active):
        return constrained(model, data, method, h)
    applied, ended = whole_step(method.parts, model.system, data.state, h, data.work)
    if ended == STALLED:
        data.clocks[0].fallen += 1
        return constrained(model, data, method, h)
    return applied, NO_CONVERGENCE if ended == TOO_FAR else 0


@unit
def whole_step(parts, system, start, h, work) -> tuple[float, int]:
    """Make the parts of a step, one after the other; return the work of loads and motors, and how it ended."""
    applied, code, moment, end = 0.0, DONE, work.moment[0], work.trial
    moment.time = moment.start
    for b in range(start.shape[0]):
        bound = work.body[b].bound
        copy_state(start[b], work.part[b])
        if system.bodies[b].ballistic == 0:
            bound[0], bound[1], bound[2] = 0.0, 0.0, 0.0
    for s in range(parts.size):
        p, code = one_part(system, work.part, parts[s] * h, end, work)
        applied += p
        if code != DONE:
            break
        for b in range(start.shape[0]):
            if system.bodies[b].ballistic == 0:
                bound_changes(work.part[b], end[b], parts[s] * h, work.body[b].bound)
                copy_state(end[b], work.part[b])
    return applied, code


@kernel
def one_part(system, start, h, end, work):
    """Make one step of order 2 from `moment.time` on; return the work of loads and motors, and how it ended."""
    moment = work.moment[0]
    total = first_kick(system, start, h, work)
    lost = dropped_rows(system, 0.0)
    least, last, fine = math.inf, math.inf, round_off(system, start)
    for k in range(SOLVES):
        if not move_all(system, start, h, end, work):
            return 0.0, TOO_FAR if k == 0 else STALLED
        error = error_of_move(system, start, h, end, work)
        if error <= LAST_DIGIT or (error <= 100.0 * fine and not error < 0.5 * last):
            break
        if not error < 1e3 * least or k == SOLVES - 1:
            return 0.0, STALLED
        least, last = min(least, error), error
        correct(system, start, h, work)
        total += driven_power(system, start, work)  # of an impulse: its work
    moment.time += h
    total += second_kick(system, h, end, work)
    if dropped_rows(system, 0.0) != lost:
        return 0.0, STALLED
    return total, DONE


@kernel
def round_off(system, state):
    """Return the greatest round-off of the coordinates of a body, relative to its size."""
    most = 1.0
    for b in range(state.shape[0]):
        x = state[b].x
        most = max(most, max(abs(x[0]), max(abs(x[1]), abs(x[2]))) / system.bodies[b].extent)
    return COORDINATE_ERROR * most


@kernel
def move_all(system, start, h, end, work):
    """Move all bodies with the momenta of the middle; return False if one turns too far."""
    for b in range(start.shape[0]):
        body, push = system.bodies[b], work.body[b].push
        if body.ballistic == 1:
            continue
        for k in range(3):
            end[b].x[k] = start[b].x[k] + h * push[k] / body.mass
        if not turn_by_momentum(body, start[b].Q, h, push, end[b].Q):
            return False
    return True


@kernel
def _solve_factored(system, state, work):
    """Solve with biased joints and the present factor."""
    if system.solver.scaled.shape[0] > 0:
        solve_near(system, state, work)
        return
    solve_factored(system, state, True, work)
    keep_multipliers(system, state, work)


@kernel
def keep_multipliers(system, state, work):
    """Store the multipliers of elements that are not joints: prescribed motions do work."""
    for j in range(system.joints.shape[0]):
        if has_own_rows(system, j):
            write_reaction(
                system.joints[j], state, system.solver.rows[j].rhs, work.joint[j].reaction
            )


@inlined
def solve_again(system, state, work):
    """Solve with biased joints in the position of the last solve."""
    if system.solver.kind == LOOPS:
        _solve_factored(system, state, work)
    else:
        solve(system, state, True, work)


@unit(where=has_joints)
def correct(system, start, h, work):
    """Change the momenta of the middle by reactions at the start that remove the error."""
    for j in range(system.joints.shape[0]):
        bias = work.joint[j].bias
        for k in range(6):
            bias[k] /= h
    clear_wrenches(work)
    solve_again(system, start, work)
    for b in range(start.shape[0]):
        add_momentum(system.bodies[b], start[b].Q, 1.0, work.body[b])
