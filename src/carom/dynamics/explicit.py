"""Explicit Runge-Kutta steps in the ambient space (x, Q, v, w), projected at the end. Default: order 4.

Stages are plain linear combinations (Q in R^4, normalised); the end of the step returns to the joints
in the kinetic metric, so that constraints hold at position and velocity level to round-off. Bodies in
free flight skip all of this (`carom.kinematics.flight`).
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.dynamics.acceleration import accelerations
from carom.dynamics.adapt import forget_misses, note_misses
from carom.dynamics.known_end import keep_end, of_state_alone, recall
from carom.dynamics.loops import dropped_rows
from carom.dynamics.project import project_position, project_velocity
from carom.dynamics.singular_positions import is_singular, pass_round, return_stage, steps
from carom.dynamics.thresholds import JOINT_ERROR, SINGULARITY, STAGE_TURN
from carom.geometry.rotation import multiply, normalize
from carom.geometry.thresholds import RESOLUTION, SMALLEST
from carom.kinematics.flexible import greatest_modal_acceleration
from carom.kinematics.flight import free_flight
from carom.model.workspace import FREE, HELD, RESTS
from carom.status import CONSTRAINTS_LOST

EVERY_ROW = 1 << 30  # more rows than any system has
MOST_PARTS = 100  # of a step, each with at most `STAGE_TURN` a stage


@inlined
def explicit_step(model, data, method, h):
    """Write the state a time h later into `work.trial`; return the work of loads, and a status."""
    if method.E.shape[0] > 0:
        forget_misses(data.work)
    return constrained(model, data, method, h) if fly(model, data, h) else (0.0, 0)


@inlined
def any_held(active):
    """Return whether a contact is active that is not at rest."""
    for i in range(active.count[0]):
        if active.points[i].rest == 0:
            return True
    return False


@inlined
def constrained(model, data, method, h):
    """Step the bodies that are joined, loaded or in contact; return the same as `explicit_step`."""
    return whole_step(model, data, method, h)


@unit
def whole_step(model, data, method, h) -> tuple[float, int]:
    """Take a step at once, or in parts in which no body turns far; return the same as `explicit_step`.

    The length of a part depends only on its start, so that the end is a continuous function of h.
    """
    work, left, first = data.work, h, data.state
    stages, estimates = method.b.size, method.E.shape[0] > 0
    applied, code = 0.0, 0
    forget_bounds(work)
    for part in range(MOST_PARTS):
        dt = left
        if not estimates and part < MOST_PARTS - 1:
            spin = fastest_spin(model.system, first, work)
            dt = min(left, STAGE_TURN * stages / max(spin, SMALLEST))
        begin = work.moment[0].start + (h - left)
        more, code = with_care(model, data, method, first, (begin, dt))
        applied += more
        left -= dt
        if not (left > 0.0 and code == 0):
            break
        data.clocks[0].parts += 1
        first = work.part
        for b in range(first.shape[0]):
            copy_state(work.trial[b], first[b])
    return applied, code


@kernel
def fastest_spin(system, state, work):
    """Return the greatest |w| of the bodies that are joined, loaded or in contact."""
    most = 0.0
    for b in range(state.shape[0]):
        status, w = work.body[b].status, state[b].w
        if status != RESTS and system.bodies[b].ballistic == 0:
            most = max(most, w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
    return math.sqrt(most)


@kernel
def with_care(model, data, method, start, span):
    """Take a step; take it again with care if a stage was near a singular position (`singular_positions`).

    `span` are the time at its start and its length. Return the work of loads, and a status.
    """
    applied, code = 0.0, 0
    for care in (False, True):
        applied, code, least, most = constrained_step(model, data, method, start, span, care)
        if not is_singular(model.system, least, most):
            break
        if not care:
            forget_misses(data.work)  # the first attempt does not count
    return applied, code


@inlined
def fly(model, data, h):
    """Move the bodies in free flight, keep those at rest; return whether joined or loaded bodies remain.

    Those in persistent contact are left to `carom.persistent.contact_step`, with all joined and loaded bodies
    if one of these is among them, or if joints have dry friction.
    """
    system, start, work = model.system, data.state, data.work
    mark_active(data.active, work)
    pending, held = False, rubs(system)
    for b in range(system.bodies.shape[0]):
        status = work.body[b].status
        if status == RESTS:
            copy_state(start[b], work.trial[b])
        elif system.bodies[b].ballistic == 0:
            pending, held = True, held or status == HELD
        elif status == FREE:
            body, end = system.bodies[b], work.trial[b]
            free_flight(body, system.gravity, h, start[b], end, work.body[b])
    return pending and not held


@inlined
def rubs(system):
    """Return whether joints have dry friction."""
    return system.relations.frictions.shape[0] > 0


@inlined
def copy_state(start, end):
    """Copy the record of a body."""
    for k in range(3):
        end.x[k], end.v[k], end.w[k] = start.x[k], start.v[k], start.w[k]
    for k in range(4):
        end.Q[k] = start.Q[k]


@inlined
def mark_active(active, work):
    """Store for each body whether it is free, in persistent contact, or at rest."""
    for b in range(work.body.shape[0]):
        work.body[b].status = FREE
    for i in range(active.count[0]):
        active_point = active.points[i]
        status = RESTS if active_point.rest == 1 else HELD
        work.body[active_point.body].status = status
        if active_point.other >= 0:
            work.body[active_point.other].status = status


@kernel
def constrained_step(model, data, method, start, span, care):
    """Step the bodies that are joined, loaded or in contact from `start`; others are in `work.trial`.

    With `care` the stages return to the joints first, and `pass_round` treats those in singular positions. A
    last stage without weight is at the end of the step (`known_end`). Return the work of loads, a status,
    and the least and the greatest number of rows that stages left out, or nearly left out.
    """
    system, work, stage = model.system, data.work, data.work.stage
    A, weight, E, (t0, h) = method.A, method.b, method.E, span
    stages, last = weight.size, stages_within(method)
    applied, power, least, most = 0.0, 0.0, EVERY_ROW, 0
    keeps = last < stages and not care and of_state_alone(system, data.active)
    for s in range(last + 1):
        combine(weight[:last] if s == last else A[s, :s], h, start, work.stages, stage)
        work.moment[0].time = t0 + h if s == last else t0 + h * node(A[s, :s])
        if s == last:
            if not return_to_joints(system, stage, work):
                return applied, CONSTRAINTS_LOST, least, most
            if s == stages:
                break
        elif care:
            return_stage(system, stage, work)
        for b in range(stage.shape[0]):
            note_velocity(stage[b], work.stages[s, b])
        if s == 0 and keeps and recall(stage, work.stages[0], work):
            applied += h * weight[0] * work.known[0].power
            continue
        power = accelerations(system, stage, work, work.stages[s])
        dropped = dropped_rows(system, SINGULARITY)
        least, most = min(least, dropped), max(most, dropped)
        if care:
            power = pass_round(system, work, work.stages[s], power)
        applied += h * weight[s] * power
    if keeps:
        keep_end(stage, work.stages[last], power, work)
    if system.contacts.shape[0] > 0 or E.shape[0] > 0:
        bound_accelerations(model.system, work, stages)
    if E.shape[0] > 0:
        note_misses(system, E, h, work)
    for b in range(stage.shape[0]):
        if steps(system, b, work):
            copy_state(stage[b], work.trial[b])
    return applied, 0, least, most


@kernel
def stages_within(method):
    """Return the number of stages without one that has no weight, which is at the end of the step."""
    stages = method.b.size
    return stages - 1 if method.b[stages - 1] == 0.0 else stages


@kernel
def return_to_joints(system, state, work):
    """Bring the end of a step to the joints and surfaces, beside the ends of other bodies in `work.trial`.

    Return whether the joints could be closed.
    """
    for b in range(state.shape[0]):
        if not steps(system, b, work):
            copy_state(work.trial[b], state[b])
    if not (project_position(system, state, True, JOINT_ERROR, work) <= RESOLUTION):
        return False
    project_velocity(system, state, False, work)
    return True


@kernel
def note_velocity(state, rates):
    """Write the velocity of a body in a stage, and the rate of its attitude, dQ/dt = 1/2 (0, w) Q."""
    speed, turn, v, w, Q = rates.speed, rates.turn, state.v, state.w, state.Q
    for k in range(3):
        speed[k], speed[3 + k] = v[k], w[k]
    turn[0], turn[1], turn[2], turn[3] = multiply((0.0, 0.5 * w[0], 0.5 * w[1], 0.5 * w[2]), Q)


@kernel
def node(weights):
    """Return the time of a stage within the step, from 0 to 1, from its weights of the stages before."""
    total = 0.0
    for r in range(weights.size):
        total += weights[r]
    return total


@kernel
def combine(weights, h, start, stages, out):
    """Write start + h sum of weights[r] * derivative of stage r, for all bodies."""
    for b in range(start.shape[0]):
        combine_body(weights, h, start[b], stages, b, out[b])


@kernel
def combine_body(weights, h, start, stages, b, out):
    """Write the same for body b, with a unit quaternion."""
    add_stages(weights, h, start, stages, b, out)
    Q = out.Q
    if weights.size > 0:
        Q[0], Q[1], Q[2], Q[3] = normalize((Q[0], Q[1], Q[2], Q[3]))


@kernel
def add_stages(weights, h, start, stages, b, out):
    """Write start + h sum of weights[r] * derivative of stage r for body b, in R^4 for its attitude."""
    x, v, w, Q = start.x, start.v, start.w, start.Q
    x0, x1, x2, v0, v1, v2, w0, w1, w2 = x[0], x[1], x[2], v[0], v[1], v[2], w[0], w[1], w[2]
    q0, q1, q2, q3 = Q[0], Q[1], Q[2], Q[3]
    for r in range(weights.size):
        a = h * weights[r]
        if a != 0.0:
            u, d, c = stages[r, b].speed, stages[r, b].turn, stages[r, b].rate
            x0, x1, x2 = x0 + a * u[0], x1 + a * u[1], x2 + a * u[2]
            q0, q1, q2, q3 = q0 + a * d[0], q1 + a * d[1], q2 + a * d[2], q3 + a * d[3]
            v0, v1, v2 = v0 + a * c[0], v1 + a * c[1], v2 + a * c[2]
            w0, w1, w2 = w0 + a * c[3], w1 + a * c[4], w2 + a * c[5]
    x, v, w, Q = out.x, out.v, out.w, out.Q
    x[0], x[1], x[2], v[0], v[1], v[2], w[0], w[1], w[2] = x0, x1, x2, v0, v1, v2, w0, w1, w2
    Q[0], Q[1], Q[2], Q[3] = q0, q1, q2, q3


@kernel
def forget_bounds(work):
    """Reset the bounds of accelerations."""
    for b in range(work.body.shape[0]):
        bound = work.body[b].bound
        bound[0], bound[1], bound[2] = 0.0, 0.0, 0.0


@kernel
def bound_accelerations(system, work, stages):
    """Raise the bounds of |linear| and |angular| acceleration and |w| of each body to those of the stages."""
    for b in range(work.body.shape[0]):
        bound_accelerations_of(system, work, b, stages)


@kernel
def bound_accelerations_of(system, work, b, stages):
    """Raise the bounds of one body; what its modes add counts as linear."""
    bound = work.body[b].bound
    linear, angular, spin = bound[0] * bound[0], bound[1] * bound[1], bound[2] * bound[2]
    for s in range(stages):
        a, u = work.stages[s, b].rate, work.stages[s, b].speed
        linear = max(linear, a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
        angular = max(angular, a[3] * a[3] + a[4] * a[4] + a[5] * a[5])
        spin = max(spin, u[3] * u[3] + u[4] * u[4] + u[5] * u[5])
    bound[0], bound[1], bound[2] = math.sqrt(linear), math.sqrt(angular), math.sqrt(spin)
    if system.bodies[b].modes > 0:
        bound[0] += greatest_modal_acceleration(system, work, b, stages)


@kernel
def bound_changes(start, end, h, bound):
    """Raise the bounds of accelerations and of spin: means over a step, doubled."""
    linear, angular, spin = 0.0, 0.0, 0.0
    for k in range(3):
        a, c = (end.v[k] - start.v[k]) / h, (end.w[k] - start.w[k]) / h
        linear += a * a
        angular += c * c
        spin += max(end.w[k] ** 2, start.w[k] ** 2)
    bound[0] = max(bound[0], 2.0 * math.sqrt(linear))
    bound[1] = max(bound[1], 2.0 * math.sqrt(angular))
    bound[2] = max(bound[2], math.sqrt(spin))
