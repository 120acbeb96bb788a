"""The scale of time of an island in a run with tolerances, from the forces that act on it.

The time of a bounce as high as the tolerance, T = (8 tol / a)^1/2, is a negligible time: within it a body that
starts at rest moves by less than the tolerance. It replaces the length of the step where this is a measure of
time. Its acceleration a is the greatest of the island: of gravity, and of what the applied forces give to its
bodies with their joints at the start of a step. Without both it is V^2 / L with the greatest speed V of the
bodies by their kinetic energies, which free flight does not change, and their least size L. So T does not
depend on the length of a step or of the run, nor on other bodies.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.elements.relation import prescribed
from carom.dynamics.energy import kinetic_energy
from carom.dynamics.forces import applied_wrenches
from carom.dynamics.solve import solve
from carom.dynamics.thresholds import LOAD_STEP
from carom.geometry.rotation import norm, rotate_back
from carom.geometry.thresholds import SUM_ERROR
from carom.kinematics.combination import push, rate
from carom.law.friction import bound_of_stick
from carom.model.controls import Controls


@kernel
def note_scale(system, controls, state, work):
    """Write the scale of time and the acceleration of an island to `work.step`, at its start."""
    step = work.step[0]
    step.scale, step.pull, step.able = controls.step, controls.pull, 0.0
    step.longest = math.inf
    if controls.order == 0 or system.contacts.shape[0] == 0:
        if step.begin == 0.0:  # where loads and friction hold each other, the round-off of energies
            pull_of(system, 0.0, SUM_ERROR, state, work)
        return
    size = least_size(system)
    length = 8.0 * (controls.atol + controls.rtol * size)
    step.scale = controls.interval
    step.pull = pull_of(system, controls.atol, controls.rtol, state, work)
    if step.pull > 0.0:
        step.scale = math.sqrt(length / step.pull)
        if step.able > 0.0:
            step.longest = LOAD_STEP * math.sqrt(2.0 * size / step.pull)
        return
    speed = greatest_speed(system, state)
    if speed > 0.0:
        step.scale = math.sqrt(length * size) / speed


@kernel
def local_controls(controls, step):
    """Return the settings with the scale of time and the acceleration of the present island."""
    return Controls(
        step=step.scale, pull=step.pull, interval=controls.interval, duration=controls.duration,
        location=controls.location, gap=controls.gap, tie=controls.tie, hold=controls.hold, rest=controls.rest,
        layer_steps=controls.layer_steps, layer_time=controls.layer_time, max_impacts=controls.max_impacts,
        max_cuts=controls.max_cuts, retry=controls.retry, order=controls.order, rtol=controls.rtol,
        atol=controls.atol,
    )  # fmt: skip


@kernel
def least_size(system):
    """Return the least size of the bodies with contacts [m]."""
    size = math.inf
    for c in range(system.contacts.shape[0]):
        size = min(size, system.bodies[system.contacts[c].body].extent)
        if system.contacts[c].other >= 0:
            size = min(size, system.bodies[system.contacts[c].other].extent)
    return size


@kernel
def pull_of(system, atol, rtol, state, work):
    """Return the greatest acceleration of the bodies by gravity and applied forces [m/s^2]."""
    pull = norm(system.gravity)
    for b in range(state.shape[0]):
        if system.bodies[b].ballistic == 0:
            return max(pull, greatest_pull(system, atol, rtol, state, work))
    return pull


@unit
def greatest_pull(system, atol, rtol, state, work) -> float:
    """Return the greatest acceleration that applied forces give to a body, also of points by its rotation.

    The work that these forces could do over the allowed errors of the positions is `step.able`: their sizes
    times atol + rtol L, and torques times the angle of this length at the distance L. Joints are kept:
    the torque of a damper moves the links on both sides, and the rotor of its motor, not a hand alone.
    """
    step, pull = work.step[0], 0.0
    work.moment[0].time = step.begin
    applied_wrenches(system, state, False, work)
    push_by_drives(system, state, work)
    for b in range(state.shape[0]):
        body, f = system.bodies[b], work.body[b].wrench
        error = atol + rtol * body.extent
        step.able += error * (norm(f[:3]) + norm(f[3:]) / body.extent)
    solve(system, state, False, work)
    for b in range(state.shape[0]):
        body, a, q, J = system.bodies[b], work.body[b].motion, state[b].Q, system.bodies[b].inertia
        w = rotate_back(q, a[3:])
        turning = math.sqrt((J[0] * w[0]) ** 2 + (J[1] * w[1]) ** 2 + (J[2] * w[2]) ** 2)
        turning *= body.extent / max(J[0], max(J[1], J[2]))  # a turn about a thin axis moves little
        pull = max(pull, norm(a[:3]) + turning)
    return pull


@kernel
def push_by_drives(system, state, work):
    """Add the greatest forces of drives with a limit, towards their rates."""
    relations = system.relations
    for i in range(relations.frictions.shape[0]):
        one = relations.frictions[i]
        if one.drives == 1:
            c = relations.coordinates[one.coordinate]
            goal = prescribed(relations, one, work.moment[0].time)[1]
            limit = bound_of_stick(system.laws, one.law)
            push(system, c, state, math.copysign(limit, goal - rate(system, c, state)), work)


@kernel
def greatest_speed(system, state):
    """Return the speed of the bodies by their kinetic energy and the least of their masses [m/s]."""
    least = math.inf
    for b in range(state.shape[0]):
        least = min(least, system.bodies[b].mass)
    return math.sqrt(2.0 * kinetic_energy(system, state) / least)
