"""The rows of a group in a state: W, and velocities and accelerations of its points without their forces.

    du/dt = W lam + c,    c = G a + (d/dt G) v,

with the accelerations a of the bodies under all other forces and joints. One right-hand side for all groups: a
body on the ground, bodies on bodies, trees and loops of joints, stops.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.contact.gap import slow
from carom.contact.groups import members
from carom.contact.operations import drift_of_row, is_fixed
from carom.dynamics.acceleration import accelerate, acceleration
from carom.dynamics.delassus import accelerations, inverse_masses, spread_all, velocities
from carom.dynamics.element_operations import driven_power
from carom.friction.layout import CONE, SLIDING
from carom.geometry.thresholds import REMAINDER
from carom.kinematics.contact_point import power_of_surface
from carom.kinematics.flight import free_rates
from carom.kinematics.moving_surfaces import set_surfaces
from carom.law.friction import bound_of_stick
from carom.law.piecewise import any_depends_on_speed
from carom.model.workspace import MOTION_JOINT, MOTION_POINT
from carom.persistent.adhesion import pull_rows, take_pulls, write_pulls
from carom.persistent.by_bodies import knows_arms, note_arms
from carom.persistent.joint_load import begin_loads, has_loads, note_reactions, note_responses
from carom.persistent.joint_rows import (
    drift_of_coordinate,
    is_driven,
    rounding_of_rate,
    set_bound,
    size_of_slip,
)
from carom.persistent.memory import is_torque, law_of, slip_at_start
from carom.persistent.points import find_points
from carom.persistent.slip_law import follow_laws
from carom.persistent.springs import bound_per_force, note_own
from carom.persistent.thresholds import SLIP_COSINE, STOPPED_SLIP

TURNED, PASSED, SAME = range(3)  # what became of directions of slip within a step (`set_modes`)


@kernel
def bodies_of(model, data, label):
    """List the bodies of a group; return their number, and whether one has joints or loads."""
    count, loaded = members(data.work, label, data.group.bodies.member), False
    for m in range(count):
        loaded = loaded or model.system.bodies[data.group.bodies.member[m]].ballistic == 0
    return count, loaded


@kernel
def accelerate_freely(model, data, loaded, count, s):
    """Write the accelerations of the bodies of a group in `work.stage` without its rows, as stage s.

    Return the power of loads.
    """
    system, work = model.system, data.work
    if loaded:
        power = acceleration(system, work.stage, work, work.stages[s])
        if has_loads(data.group):
            note_reactions(system, work.stage, 0, work, data.group)
        return power
    for m in range(count):
        b = data.group.bodies.member[m]
        free_rates(system.bodies[b], system.gravity, work.stage[b], work.stages[s, b].rate)
    return 0.0


@unit
def write_rows(model, data, label, s) -> int:
    """Find the points of a group in `work.stage`, and write W, u and c for the accelerations of stage s.

    Return the number of points, with the entries of rolling and pivoting.
    """
    system, group, work = model.system, data.group, data.work
    points, state = group.points[0], work.stage
    set_surfaces(system, work.moment[0].time)
    k = find_points(system, data, label)
    note_arms(system, data, members(work, label, group.bodies.member), k, state)
    if not knows_arms(group.equations):
        if k > group.idle.shape[1]:  # no room for matrices: the step ends with TOO_MANY_POINTS
            group.count[1], k = k - group.idle.shape[1], group.idle.shape[1]
        inverse_masses(system, k, points, state, work, group.problem.W)
        note_own(k, group)
    if has_loads(group):
        note_responses(system, k, state, work, group)
    write_pulls(system, data.active, k, state, group)
    write_motion(system, k, state, work.stages[s], group, work)
    if any_depends_on_speed(system.laws):
        follow_laws(system, data.active, k, group)
    return k


@kernel
def write_motion(system, k, state, rates, group, work):
    """Write u, c and the friction of k points of a group in a state with given accelerations."""
    points = group.points[0]
    velocities(system, k, points, state, group.u)
    accelerations(system, k, points, state, rates, group.problem.c)
    pull_rows(k, 1.0, group, group.problem.c)
    begin_loads(k, group)
    for i in range(k):
        closed_point = group.closed[i]
        if is_torque(closed_point):
            group.problem.mu[i] = bound_per_force(system, points[i], closed_point)
            continue
        set_bound(i, bound_of_stick(system.laws, law_of(system, closed_point)), group)
        if closed_point.motion == MOTION_JOINT:
            group.problem.c[3 * i + 1] += drift_of_coordinate(
                system, closed_point.active, state, work
            )
            continue
        contact = system.contacts[closed_point.contact]
        if not is_fixed(contact):
            d = drift_of_row(system, contact, closed_point.feature, points[i], state, work)
            for r in range(3):
                group.problem.c[3 * i + r] += d[r]


@kernel
def set_modes(system, active, k, group):
    """Write which of k points slide, and where to; return what became of the directions of slip at the start.

    They are the `SAME`, or a slip `PASSED` its stop, and keeps its heading, or `TURNED`. All springs press at
    first.
    """
    directions, fastest = SAME, 0.0
    for i in range(k):
        u1, u2 = group.u[3 * i + 1], group.u[3 * i + 2]
        fastest = max(fastest, math.sqrt(u1 * u1 + u2 * u2))
    for i in range(k):
        closed_point = group.closed[i]
        slips, d1, d2, speed = slip_at_start(system, active, closed_point)
        u1, u2 = group.u[3 * i + 1], group.u[3 * i + 2]
        slip = math.sqrt(u1 * u1 + u2 * u2)
        # what is not listed slips by its own velocity
        if closed_point.listed == 0 and closed_point.motion == MOTION_POINT:
            slips = slip > REMAINDER * fastest
        closed_point.presses = 1 if closed_point.weight > 0.0 else 0
        group.problem.kind[i] = SLIDING if slips or group.problem.mu[i] == 0.0 else CONE
        group.problem.heading[i, 0], group.problem.heading[i, 1] = d1, d2
        if is_driven(group, i):
            group.problem.kind[i] = SLIDING
            speed = group.u[3 * i + 1]
            group.problem.heading[i, 0] = 1.0 if speed > 0.0 else -1.0 if speed < 0.0 else 0.0
            continue
        if not slips or group.problem.mu[i] == 0.0:
            continue
        if closed_point.listed == 1 and not slip > STOPPED_SLIP * speed:
            continue
        if closed_point.listed == 1 and u1 * d1 + u2 * d2 < -SLIP_COSINE * slip:
            directions = min(directions, PASSED)
            continue
        if closed_point.listed == 1 and not u1 * d1 + u2 * d2 > SLIP_COSINE * slip:
            directions = TURNED
        if slip > 0.0:
            group.problem.heading[i, 0], group.problem.heading[i, 1] = u1 / slip, u2 / slip
    return directions


@kernel
def beyond_stop(system, active, i, group):
    """Return the speed [m/s] that a point has against its slip at the start of the step, 0 if none."""
    point, u = group.points[0][i], group.u
    slips, d1, d2, _ = slip_at_start(system, active, group.closed[i])
    speed = -(u[3 * i + 1] * d1 + u[3 * i + 2] * d2)
    if not (slips and speed > 0.0):
        return 0.0
    return speed * size_of_slip(system, point)


@kernel
def slip_of(system, data, i, still):
    """Return direction and speed of the slip of a point; no direction below `still`, or round-off."""
    group, closed_point, state = data.group, data.group.closed[i], data.state
    u1, u2 = group.u[3 * i + 1], group.u[3 * i + 2]
    speed = math.hypot(u1, u2)
    if closed_point.motion == MOTION_JOINT:
        rounding = rounding_of_rate(system, closed_point.active, state)
    else:
        rounding = 10.0 * slow(system.contacts[closed_point.contact], state)
    if speed > max(rounding, still):
        return u1 / speed, u2 / speed, speed
    return 0.0, 0.0, speed


@unit
def push_bodies(model, data, loaded, k, count, s) -> tuple[float, float]:
    """Add the accelerations by the forces in `p` to stage s; return the powers of drives and friction."""
    system, group, work = model.system, data.group, data.work
    u, p, power, driven = group.u, group.p, 0.0, 0.0
    take_pulls(k, 1.0, group)
    spread_all(system, group.points[0, :k], p, group.bodies.member[:count], work.stage, work)
    take_pulls(k, -1.0, group)
    if loaded:
        driven = driven_power(system, work.stage, work)
    for m in range(count):
        b = group.bodies.member[m]
        accelerate(work.body[b].motion, work.stages[s, b].rate)
    for i in range(k):
        driven += power_of_surface(group.points[0][i], work.stage, p[3 * i : 3 * i + 3])
        if group.problem.kind[i] == SLIDING:
            power += p[3 * i + 1] * u[3 * i + 1] + p[3 * i + 2] * u[3 * i + 2]
    return driven, power
