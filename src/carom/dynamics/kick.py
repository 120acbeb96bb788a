"""Half kicks of a symplectic step: to the momenta at its middle, and to the velocities at its end.

Momenta (m v, l) of the middle are in `push`; l is spatial, and about each centre.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.dynamics.acceleration import bias_joints
from carom.dynamics.element_operations import driven_power
from carom.dynamics.energy import spin_momentum
from carom.dynamics.forces import applied_wrenches
from carom.dynamics.project import project_velocity
from carom.dynamics.solve import free_body, solve
from carom.geometry.rotation import cross
from carom.geometry.thresholds import ROUND_OFF

SUBSTITUTIONS = 60  # for the velocities at the end


@kernel
def first_kick(system, start, h, work):
    """Write P_h, with the present reactions as a first guess, into `push`; return the work done.

    M a is the sum of the applied forces, the reactions and -w x l, which rotates l with the body and is no
    kick.
    """
    power = applied_wrenches(system, start, True, work)
    bias_joints(system, start, work)
    solve(system, start, True, work)
    for b in range(start.shape[0]):
        body, push, w = system.bodies[b], work.body[b].push, start[b].w
        l = spin_momentum(body, start[b].Q, w)
        t = cross(w[0], w[1], w[2], l[0], l[1], l[2])
        for k in range(3):
            push[k], push[3 + k] = body.mass * start[b].v[k], l[k] + 0.5 * h * t[k]
        add_momentum(body, start[b].Q, 0.5 * h, work.body[b])
    return 0.5 * h * (power + driven_power(system, start, work))


@kernel
def add_momentum(body, q, factor, memory):
    """Add factor times M motion to the momenta of a body."""
    motion, push = memory.motion, memory.push
    l = spin_momentum(body, q, motion[3:])
    for k in range(3):
        push[k] += factor * body.mass * motion[k]
        push[3 + k] += factor * l[k]


@kernel
def second_kick(system, h, end, work):
    """Write v_1 from the momenta of the middle; return the work of loads and motors.

    With dampers it is an equation for v_1, solved by repeated substitution (the adjoint of the first half, so
    that the step is symmetric).
    """
    power, driven, change = 0.0, 0.0, math.inf
    for k in range(SUBSTITUTIONS):
        if k == 0:
            set_velocities(system, 0.0, end, work)
        power = applied_wrenches(system, end, False, work)
        previous, change = change, note_kick(system, k, work)
        if change == 0.0 or (change <= ROUND_OFF and not change < 0.5 * previous):
            break
        set_velocities(system, 0.5 * h, end, work)
        project_velocity(system, end, False, work)
        driven = driven_power(system, end, work)  # of an impulse: its work
    return 0.5 * h * power + driven


@kernel
def note_kick(system, k, work):
    """Store the wrenches; return their greatest change since the last call, relative to the greatest wrench."""
    change, size = 0.0, 0.0
    for b in range(system.bodies.shape[0]):
        wrench, kept = work.body[b].wrench, work.stages[0, b].rate
        length = system.bodies[b].extent
        for i in range(6):
            unit_of = 1.0 if i < 3 else length
            size = max(size, abs(wrench[i]) / unit_of)
            if not abs(wrench[i] - kept[i]) / unit_of <= change and change == change:
                change = abs(wrench[i] - kept[i]) / unit_of
            kept[i] = wrench[i]
    if k == 0:
        return math.inf
    return change / size if size > 0.0 else 0.0


@kernel
def set_velocities(system, factor, end, work):
    """Write v = M(q_1)^-1 (P_h + factor * kick)."""
    for b in range(end.shape[0]):
        if system.bodies[b].ballistic == 1:
            continue
        memory, v, w = work.body[b], end[b].v, end[b].w
        for i in range(6):
            memory.wrench[i] = memory.push[i] + factor * work.stages[0, b].rate[i]
        free_body(system.bodies[b], end[b].Q, memory)
        for i in range(3):
            v[i], w[i] = memory.motion[i], memory.motion[3 + i]
