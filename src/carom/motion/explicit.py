"""Explicit Runge-Kutta steps in the ambient space (x, Q, v, w), projected at the end. Default: order 4.

Stages are plain linear combinations (Q in R^4, normalised); the end of the step returns to the joints
in the kinetic metric, so that constraints hold at position and velocity level to round-off. Bodies in
free flight skip all of it (`carom.motion.free`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry.rotation import multiply, normalize
from carom.jit import kernel
from carom.motion.acceleration import acceleration
from carom.motion.free import free_flight
from carom.motion.project import project_position, project_velocity


class Explicit(NamedTuple):
    """A Runge-Kutta method: strictly lower triangular A, weights b."""

    A: np.ndarray  # (S, S)
    b: np.ndarray  # (S,)


def rk4() -> Explicit:
    """Return the classical Runge-Kutta method of order 4 (Kutta 1901)."""
    A = np.zeros((4, 4))
    A[1, 0] = A[2, 1] = 0.5
    A[3, 2] = 1.0
    return Explicit(A, np.array([1.0, 2.0, 2.0, 1.0]) / 6.0)


@kernel
def explicit_step(system, method, held, start, h, end, work):
    """Write the state a time h after `start` into `end`; return work of loads, of friction, a status."""
    bodies = system.bodies
    pending = 0
    for b in range(bodies.mass.size):
        if bodies.ballistic[b] == 1:
            free_flight(bodies, b, h, start, end)
        else:
            pending += 1
    for c in range(held.mode.size):
        pending += held.mode[c]
    if pending == 0:
        return 0.0, 0.0, 0
    A, weight = method.A, method.b
    stages = weight.size
    applied, friction = 0.0, 0.0
    stage = work.stage
    for s in range(stages):
        combine(A[s], s, h, start, work, stage)
        work.speed[s, :, :3] = stage.v
        work.speed[s, :, 3:] = stage.w
        p, f = acceleration(system, stage.x, stage.Q, stage.v, stage.w, held, work, work.rate[s])
        applied += h * weight[s] * p
        friction += h * weight[s] * f
    combine(weight, stages, h, start, work, stage)
    bound_accelerations(work, stages)
    for b in range(bodies.mass.size):
        if bodies.ballistic[b] == 0 or is_held(system, held, b):
            end.x[b], end.v[b], end.w[b] = stage.x[b], stage.v[b], stage.w[b]
            end.Q[b] = stage.Q[b]
    if system.joints.kind.size > 0:
        error = project_position(system, end.x, end.Q, work, 1e-14)
        if not (error <= 1e-9):
            return applied, friction, 7
        project_velocity(system, end.x, end.Q, end.v, end.w, work)
    return applied, friction, 0


@kernel
def is_held(system, held, b):
    """Return whether any contact holds body b."""
    for c in range(held.mode.size):
        if held.mode[c] != 0 and system.contacts.body[c] == b:
            return True
    return False


@kernel
def combine(weight, count, h, start, work, out):
    """Write start + h sum of weight[r] * derivative of stage r, r < count."""
    for b in range(start.x.shape[0]):
        for k in range(3):
            dx, dv, dw = 0.0, 0.0, 0.0
            for r in range(count):
                a = weight[r]
                if a != 0.0:
                    dx += a * work.speed[r, b, k]
                    dv += a * work.rate[r, b, k]
                    dw += a * work.rate[r, b, 3 + k]
            out.x[b, k] = start.x[b, k] + h * dx
            out.v[b, k] = start.v[b, k] + h * dv
            out.w[b, k] = start.w[b, k] + h * dw
        turn(weight, count, h, start.Q[b], b, work, out.Q[b])


@kernel
def turn(weight, count, h, q, b, work, out):
    """Write the attitude of a stage: dQ/dt = 1/2 (0, w) Q of each earlier stage, combined."""
    q0, q1, q2, q3 = q[0], q[1], q[2], q[3]
    for r in range(count):
        a = 0.5 * h * weight[r]
        if a != 0.0:
            w, p = work.speed[r, b], work.attitude[r, b]
            d = multiply(0.0, a * w[3], a * w[4], a * w[5], p[0], p[1], p[2], p[3])
            q0, q1, q2, q3 = q0 + d[0], q1 + d[1], q2 + d[2], q3 + d[3]
    out[0], out[1], out[2], out[3] = normalize(q0, q1, q2, q3)
    if count < work.attitude.shape[0]:
        for k in range(4):
            work.attitude[count, b, k] = out[k]


@kernel
def bound_accelerations(work, stages):
    """Write the greatest |linear| and |angular| acceleration and |w| of each body over the stages."""
    for b in range(work.bound.shape[0]):
        linear, angular, spin = 0.0, 0.0, 0.0
        for s in range(stages):
            a, u = work.rate[s, b], work.speed[s, b]
            linear = max(linear, a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
            angular = max(angular, a[3] * a[3] + a[4] * a[4] + a[5] * a[5])
            spin = max(spin, u[3] * u[3] + u[4] * u[4] + u[5] * u[5])
        work.bound[b, 0] = np.sqrt(linear)
        work.bound[b, 1] = np.sqrt(angular)
        work.bound[b, 2] = np.sqrt(spin)
