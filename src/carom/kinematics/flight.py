"""Free flight of one body, exact: translation on a parabola, rotation as a torque-free top in closed form.

With equal moments w is constant and the rotation is exp(h w). Otherwise the constants of a flight are computed
at its beginning (`carom.kinematics.torque_free_top`). They are stored with two states at known times: the start
and the end of the last step. A step from either state continues this flight, so that no round-off accumulates;
any other state, for instance after an impact, begins another flight.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import inlined, kernel
from carom.geometry.rotation import multiply, renormalize, rotate, rotate_back, turn
from carom.kinematics.torque_free_top import attitude, begin_top
from carom.model.workspace import FREE, RESTS


@inlined
def free_flight(body, g, h, start, end, memory):
    """Write into the record `end` the state of a body a time h after the record `start`."""
    x0, v0, w0, q0 = start.x, start.v, start.w, start.Q
    x1, v1, w1, q1 = end.x, end.v, end.w, end.Q
    for k in range(3):
        x1[k] = x0[k] + h * (v0[k] + 0.5 * h * g[k])
        v1[k] = v0[k] + h * g[k]
    if body.isotropic == 1:
        q1[0], q1[1], q1[2], q1[3] = q0[0], q0[1], q0[2], q0[3]
        turn(q1, h * w0[0], h * w0[1], h * w0[2])
        w1[0], w1[1], w1[2] = w0[0], w0[1], w0[2]
        return
    q, w = tumble(body.inertia, h, q0, w0, memory)
    q1[0], q1[1], q1[2], q1[3] = q
    w1[0], w1[1], w1[2] = w


@kernel
def knows(memory, i, q, w):
    """Return whether a state is known state i of the flight in `memory`."""
    a, s = memory.known_attitude, memory.known_spin
    return (
        a[i, 0] == q[0] and a[i, 1] == q[1] and a[i, 2] == q[2] and a[i, 3] == q[3]
        and s[i, 0] == w[0] and s[i, 1] == w[1] and s[i, 2] == w[2]
    )  # fmt: skip


@kernel
def note(memory, i, q, w, age, more):
    """Store a state, at the time age + more, as known state i of the flight."""
    a, s = memory.known_attitude, memory.known_spin
    a[i, 0], a[i, 1], a[i, 2], a[i, 3] = q[0], q[1], q[2], q[3]
    s[i, 0], s[i, 1], s[i, 2] = w[0], w[1], w[2]
    memory.age[i, 0], memory.age[i, 1] = age, more


@kernel
def board(J, q, w, memory):
    """Make a state known state 0 of its flight: the flight in `memory` if it is known there, or a new one."""
    if knows(memory, 0, q, w):
        return
    attitude_now, spin_now = (q[0], q[1], q[2], q[3]), (w[0], w[1], w[2])
    if knows(memory, 1, q, w):
        note(memory, 0, attitude_now, spin_now, memory.age[1, 0], memory.age[1, 1])
        return
    W = rotate_back(q, w)
    begin_top(J, q, W, memory)
    note(memory, 0, attitude_now, spin_now, 0.0, 0.0)


@kernel
def tumble(J, h, q0, w0, memory):
    """Return attitude and angular velocity (world) after a time h; momentum and energy are conserved."""
    board(J, q0, w0, memory)
    age, more = memory.age[0, 0], memory.age[0, 1] + h
    t = age + more
    more -= t - age  # round-off of the sum if age is larger; else a part of the round-off of h
    turn, b = attitude(memory, t)
    q = renormalize(multiply(memory.turn, turn))
    L = memory.magnitude
    w = rotate(q, (L * b[0] / J[0], L * b[1] / J[1], L * b[2] / J[2]))
    note(memory, 1, q, w, t, more)
    return q, w


@kernel
def point_bound(body, q, w, memory):
    """Return a bound of |W x (W x r) + W' x r|/|r| in free flight, for the accelerations of points."""
    if body.isotropic == 1:
        return w[0] * w[0] + w[1] * w[1] + w[2] * w[2]
    board(body.inertia, q, w, memory)
    return memory.fastest


@kernel
def free_rates(body, g, state, rate):
    """Write the accelerations (linear, angular; world) of a body in free flight: J dW/dt = (J W) x W."""
    q, J = state.Q, body.inertia
    W = rotate_back(q, state.w)
    a, b = (J[1] - J[2]) * W[1] * W[2] / J[0], (J[2] - J[0]) * W[2] * W[0] / J[1]
    a = rotate(q, (a, b, (J[0] - J[1]) * W[0] * W[1] / J[2]))
    for k in range(3):
        rate[k], rate[3 + k] = g[k], a[k]


@kernel
def turning_bound(system, b, state, work):
    """Return bounds of the acceleration of points of a body about its centre, per distance, and of its spin.

    They hold along the whole flight. To ask again in another state of it would begin another flight.
    """
    if b < 0 or work.body[b].status == RESTS:
        return 0.0, 0.0
    body, memory = system.bodies[b], work.body[b]
    if body.ballistic == 1 and memory.status == FREE:
        most = point_bound(body, state[b].Q, state[b].w, memory)
        return most, math.sqrt(most)
    return 2.0 * (memory.bound[1] + memory.bound[2] * memory.bound[2]), memory.bound[2]


@kernel
def core_extent(solid):
    """Return the greatest distance of a core point from the mass centre; the ball around it does not turn."""
    x = solid.x
    return math.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) + solid.extent - solid.radius


@kernel
def relative_bound(system, contact, state, work):
    """Return bounds of the relative acceleration of the two centres, of any two points, and of both spins."""
    a, b, g = contact.body, contact.other, system.gravity
    free_a = system.bodies[a].ballistic == 1 and work.body[a].status == FREE
    free_b = b >= 0 and system.bodies[b].ballistic == 1 and work.body[b].status == FREE
    fall = math.sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2])
    centres = 0.0
    if not (free_a and free_b):  # two bodies in free flight have the same acceleration
        for body, free in ((a, free_a), (b, free_b)):
            if body >= 0 and work.body[body].status != RESTS:
                centres += fall if free else 2.0 * work.body[body].bound[0]
    turn, spin = turning_bound(system, a, state, work)
    other_turn, other_spin = turning_bound(system, b, state, work)
    most = centres + turn * core_extent(system.solids[contact.solid])
    most += other_turn * core_extent(system.solids[contact.other_solid])
    return centres, most, turn, spin, other_turn, other_spin
