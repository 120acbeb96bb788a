"""Stages of a step in singular positions: there constraint rows are dependent that are usually independent.

Such rows are left out there, and the acceleration is not the limit of its neighbours: the rows would give 0/0,
and nearby (at an angle e between them) the round-off of the joints over e^3. On a path q(t) in the constraints
the limit exists, because the acceleration is smooth along it; it follows from positions outside the singular
one,

    a(0) = sum over k = 2, 3, 4 of c_k (a(k T) + a(-k T))/2 + O(T^6),    c = (12/5, -64/35, 3/7).

The path is that of constant velocities, returned to the joints in position and velocity; this is the same to
the order that is needed. A stage of a Runge-Kutta step is off the constraints by O(h^2), and nearly dependent
rows multiply this by the inverse of their angle; so all stages of the step return to the joints first. (With
the projection P, F(P(y)) is as good an extension of the motion to all y as F(y): the order does not change.)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.dynamics.acceleration import accelerations
from carom.dynamics.loops import dropped_rows
from carom.dynamics.project import project_position, project_velocity
from carom.dynamics.thresholds import JOINT_ERROR, SINGULAR_GROWTH, SINGULAR_TURN, SINGULARITY
from carom.geometry.rotation import turn
from carom.model.arrays import LOOPS
from carom.model.parts_of_system import has_loops
from carom.model.workspace import RESTS

# bodies turn by this angle in the time T; if rows still depend on each other, by more
LONGER_TIMES = 2  # greatest number of tries with larger angles


@kernel
def steps(system, b, work):
    """Return whether the stages of the step move a body: it is neither at rest nor in free flight."""
    return work.body[b].status != RESTS and system.bodies[b].ballistic == 0


@unit(where=has_loops)
def return_stage(system, stage, work):
    """Bring a stage to the joints, positions and velocities."""
    project_position(system, stage, False, JOINT_ERROR, work)
    project_velocity(system, stage, False, work)


@kernel
def _is_singular(system, least, most):
    """Return whether a step came near a singular position, from the number of rows that stages left out."""
    usual = system.solver.usual
    usual[0] = least if usual[0] < 0 else min(least, usual[0])
    return most > usual[0]


@unit
def pass_round(system, work, rates, power) -> float:
    """Write the accelerations of a stage in a singular position from those before and after it on its path.

    If all positions on the path are singular, the accelerations do not change. `power` is that of loads in the
    stage; return it for these accelerations.
    """
    dropped, usual, moment = dropped_rows(system, SINGULARITY), system.solver.usual, work.moment[0]
    if dropped <= usual[0]:
        return power
    stage, sums = work.stage, work.trial
    pace, time, reach = turning_pace(system, stage), moment.time, SINGULAR_TURN
    for _ in range(LONGER_TIMES if pace > 0.0 else 0):
        mean, most = _sum_rates(system, work, rates, reach, pace)
        moment.time = time
        if most > usual[0]:
            reach *= SINGULAR_GROWTH
            continue
        for b in range(stage.shape[0]):
            if steps(system, b, work):
                for k in range(3):
                    rates[b].rate[k], rates[b].rate[3 + k] = sums[b].v[k], sums[b].w[k]
        return mean
    usual[0] = dropped
    return accelerations(system, stage, work, rates)


@kernel
def turning_pace(system, stage):
    """Return the greatest angular velocity of a body, plus the speed of its centre over its size."""
    pace = 0.0
    for b in range(stage.shape[0]):
        v, w = stage[b].v, stage[b].w
        speed = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / system.bodies[b].extent
        pace = max(pace, speed + math.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]))
    return pace


@kernel
def _sum_rates(system, work, rates, reach, pace):
    """Write the weighted sums of the accelerations before and after, with T = reach/pace.

    They are the velocities in `work.trial` of the bodies that step, whose end is not known yet. Return the same
    sum of power, and the greatest number of rows that were left out.
    """
    stage, sums = work.stage, work.trial
    power, most, time = 0.0, 0, work.moment[0].time
    for b in range(stage.shape[0]):
        if steps(system, b, work):
            for k in range(3):
                sums[b].v[k], sums[b].w[k] = 0.0, 0.0
    for i in range(6):
        k = 2 + i // 2
        share = 6.0 / 5.0 if k == 2 else -32.0 / 35.0 if k == 3 else 3.0 / 14.0
        ahead = (k if i % 2 == 0 else -k) * reach / pace
        for b in range(stage.shape[0]):
            go_on(stage[b], ahead, work.beside[b])
        work.moment[0].time = time + ahead
        return_stage(system, work.beside, work)
        here = accelerations(system, work.beside, work, rates)
        most = max(most, dropped_rows(system, SINGULARITY))
        power += share * here
        for b in range(stage.shape[0]):
            if steps(system, b, work):
                rate = rates[b].rate
                for j in range(3):
                    sums[b].v[j] += share * rate[j]
                    sums[b].w[j] += share * rate[3 + j]
    return power, most


@kernel
def go_on(start, dt, out):
    """Write the pose of a body after a time dt at constant velocity."""
    x, v, w = start.x, start.v, start.w
    for k in range(3):
        out.x[k], out.v[k], out.w[k] = x[k] + dt * v[k], v[k], w[k]
    for k in range(4):
        out.Q[k] = start.Q[k]
    turn(out.Q, dt * w[0], dt * w[1], dt * w[2])


@inlined
def is_singular(system, least, most):
    """Return whether a step came near a singular position, from the number of rows that stages left out."""
    return system.solver.kind == LOOPS and _is_singular(system, least, most)
