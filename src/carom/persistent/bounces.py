"""The bounces of a contact that are not resolved: their number is infinite, and their height negligible.

After an impact with exit speed u_n, a contact whose free acceleration of approach is g_i bounces for the time

    t_i = 2 u_n / (g_i (1 - e)),

which is exact if g_i and e are constant. Where e depends on the speed, the times 2 v_k/g_i of bounces are added
up, v_0 = u_n and v_{k+1} = e(v_k) v_k, and the formula gives what is left after some. The sum is finite even
where e -> 1 for v -> 0: with 1 - e = c v^(1/5), v_k falls as k^-5. With a given step, bounces that end within
the step are not resolved. With tolerances, those that end within the time of one bounce as high as the
tolerance,

    t_i < (8 tol / g_i)^1/2,   tol = atol + rtol L,   so   u_n^2 / (2 g_i) < (1 - e)^2 tol,

with the acceleration of the contact at that moment and the size L of its smaller body.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.gap import slow
from carom.contact.groups import members
from carom.contact.kinds.partner import smaller
from carom.contact.operations import located_within
from carom.dynamics.delassus import on_drive
from carom.dynamics.element_operations import driven_power
from carom.friction.layout import CONE, SLIDING
from carom.geometry.thresholds import REMAINDER, ROUND_OFF, SUM_ERROR
from carom.kinematics.contact_point import power_of_surface
from carom.law.restitution import depends_on_approach, restitution_at
from carom.law.turning import arm_of_torque
from carom.model.laws import STRIKES
from carom.model.workspace import MOTION_PIVOT, MOTION_ROLL
from carom.persistent.margins import time_to_stop
from carom.persistent.return_to_surfaces import (
    factor_given,
    give,
    greatest_speed,
    solve_rows,
    velocity_after,
)
from carom.persistent.settle import greatest
from carom.persistent.springs import given, place_forces
from carom.persistent.thresholds import MOST_BOUNCES, PLASTIC_SPEED, REST_SHARE


@kernel
def horizon_of(system, contact, controls, g, horizon, state):
    """Return the time within which bounces must end to be left out: `horizon`, or by the tolerance.

    What goes no higher than a gap is known has no time at which it falls back.
    """
    if controls.order == 0:
        return horizon
    tolerance = controls.atol + controls.rtol * smaller(contact)
    if system.laws.table[contact.law[STRIKES]].restitution == 0.0:
        tolerance = max(PLASTIC_SPEED * tolerance, 2.0 * located_within(controls, contact, state))
    return math.sqrt(8.0 * tolerance / g) if g > 0.0 else 0.0


@kernel
def bounces_end(system, contact, rate, g, still, horizon):
    """Return whether the bounces of a contact with exit speed `rate` and acceleration g end by `horizon`."""
    if not (g > 0.0 and rate >= -still):
        return False
    return rate <= still or time_of_bounces(system, contact, rate, g) < horizon


@kernel
def time_of_bounces(system, contact, rate, g):
    """Return the time 2 u/(g (1 - e)) that bounces take; with a law of restitution, the sum of their times."""
    time, laws, law = 0.0, system.laws, contact.law[STRIKES]
    e = restitution_at(laws, law, rate)
    if depends_on_approach(laws, law):
        for _ in range(MOST_BOUNCES):
            time += 2.0 * rate / g
            rate *= e
            e = restitution_at(laws, law, rate)
    return time + 2.0 * rate / (g * (1.0 - e)) if e < 1.0 else math.inf


@kernel
def spare(clock, step):
    """Return the energy that dropped bounces may add: the loss by impacts of the step minus the energy owed."""
    return max(0.0, step.impacts - clock.impacts - step.owed)


@kernel
def name_work(normal, tangential, clock, step):
    """Add the work of the impulse that removes bounces to the ledger.

    A gain belongs to friction. It is less than the loss by friction in persistent contact until the time at
    which the bounces would have ended, and is owed until then (`carom.stepping.time_loop.charge_impacts`).
    """
    if normal + tangential <= 0.0:
        clock.bounces += normal + tangential
    else:
        clock.bounces += normal
        clock.friction += tangential
        step.owed += tangential


@kernel
def time_without_torque(system, contact, rate, g, state):
    """Return the time of bounces that are left out, in which rolling and pivoting friction do not act."""
    rolls = arm_of_torque(system.laws, contact, MOTION_ROLL) > 0.0
    pivots = arm_of_torque(system.laws, contact, MOTION_PIVOT) > 0.0
    bounces = (rolls or pivots) and rate > slow(contact, state)
    return time_of_bounces(system, contact, rate, g) if bounces else 0.0


@kernel
def end_bounces(model, data, k, label, horizon):
    """Remove the normal velocities of the points that stay, in the kinetic metric.

    The slip of a point without slip is removed too; otherwise the point would stick with the slip that the
    impulse gives it. If slip lasts, friction acts with the impulse. Velocities of round-off
    size, a small fraction of the speed before, become 0, however large the forces are (the point of a rim that
    is nearly flat moves along the rim with 1e13 m/s^2).
    """
    system, controls = model.system, model.controls
    state, group, work, clock = data.state, data.group, data.work, data.clocks[0]
    count = members(work, label, group.bodies.member)
    speed = greatest_speed(system, state, count, group.bodies.member)
    still = ROUND_OFF * speed
    for i in range(3 * k):
        still = max(still, controls.rest * controls.step * abs(group.problem.c[i]))
    still = min(still, REST_SHARE * speed)
    for i in range(k):
        contact = system.contacts[group.closed[i].contact]
        end = horizon_of(system, contact, controls, -group.problem.c[3 * i], horizon, state)
        if not time_to_stop(i, group) > end:  # friction ends with the slip
            group.problem.heading[i, 0], group.problem.heading[i, 1] = 0.0, 0.0
    find_pull(k, 1, SUM_ERROR * speed, group)
    normal, tangential = work_of_pull(k, group)
    if normal > 0.0 or not normal + tangential <= spare(
        clock, work.step[0]
    ):  # neighbours push each other out
        find_pull(k, 0, SUM_ERROR * speed, group)
        normal, tangential = work_of_pull(k, group)
    name_work(normal, tangential, clock, work.step[0])
    x = group.back
    for i in range(k):
        clock.loads += power_of_surface(group.points[0][i], state, x[3 * i : 3 * i + 3])
    if give(system, k, count, state, group, work):
        clock.loads += driven_power(system, state, work)  # of an impulse: its work
    slow_enough = greatest_speed(system, state, count, group.bodies.member) <= still
    if slow_enough and not on_drive(k, group.points[0]):
        for m in range(count):
            b = group.bodies.member[m]
            for r in range(3):
                state[b].v[r], state[b].w[r] = 0.0, 0.0


@kernel
def work_of_pull(k, group):
    """Return the work of the impulses in RETURN: half of each times its velocities before and after."""
    x, u = group.back, group.u
    normal, tangential = 0.0, 0.0
    for i in range(3 * k):
        if x[i] == 0.0:
            continue
        if given(group, i):
            normal += 0.5 * x[i] * u[i]
        else:
            tangential += 0.5 * x[i] * (u[i] + after_pull(i, k, group))
    return normal, tangential


@kernel
def find_pull(k, friction, tiny, group):
    """Write the impulses that remove the velocities to RETURN: with friction (1) if they exist."""
    x = group.back
    for i in range(k):  # the normal of a point that stays is removed, and its tangents if it sticks
        closed_point = group.closed[i]
        closed_point.rows = (
            0 if closed_point.stays == 0 else 3 if group.problem.kind[i] == CONE else 1
        )
    for with_friction in range(friction, -1, -1):
        n = factor_given(k, with_friction == 1, group)
        for i in range(3 * k):
            x[i] = group.u[i]
        left = solve_rows(k, n, tiny, group, x)
        for i in range(k if with_friction == 1 else 0):
            if group.closed[i].rows == 1 and group.problem.kind[i] == SLIDING:
                for r in range(2):
                    x[3 * i + 1 + r] = -group.problem.mu[i] * group.problem.heading[i, r] * x[3 * i]
        place_forces(k, x, group)
        if left <= max(tiny, REMAINDER * greatest(3 * k, group.u)):
            return


@kernel
def after_pull(row, k, group):
    """Return the velocity in a row after the impulses in RETURN, which `find_pull` has written."""
    return velocity_after(k, row, group.back, group)
