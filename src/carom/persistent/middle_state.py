"""The middle of a step, angular momenta, and the power of loads over a step."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.dynamics.forces import applied_wrenches
from carom.geometry.rotation import exp, log, multiply, normalize, rotate, rotate_back
from carom.kinematics.coordinate import rate


@kernel
def halfway(start, end, out):
    """Write the middle state of a body: mean position and velocities, half the rotation."""
    p, q, Q = start.Q, end.Q, out.Q
    t = multiply(q[0], q[1], q[2], q[3], p[0], -p[1], -p[2], -p[3])
    a = log(t[0], t[1], t[2], t[3])
    r = exp(0.5 * a[0], 0.5 * a[1], 0.5 * a[2])
    q = multiply(r[0], r[1], r[2], r[3], p[0], p[1], p[2], p[3])
    Q[0], Q[1], Q[2], Q[3] = normalize(q[0], q[1], q[2], q[3])
    for k in range(3):
        out.x[k] = 0.5 * (start.x[k] + end.x[k])
    mean_velocity(start, end, out)


@kernel
def mean_velocity(start, end, out):
    """Write the mean of the velocities of a body."""
    for k in range(3):
        out.v[k] = 0.5 * (start.v[k] + end.v[k])
        out.w[k] = 0.5 * (start.w[k] + end.w[k])


@kernel
def spin_momentum(body, q, w0, w1, w2):
    """Return the angular momentum J w about the centre, world axes."""
    J = body.inertia
    a = rotate_back(q[0], q[1], q[2], q[3], w0, w1, w2)
    return rotate(q[0], q[1], q[2], q[3], J[0] * a[0], J[1] * a[1], J[2] * a[2])


@kernel
def friction_power(system, state):
    """Return the power of friction in joints, with the forces of the last contact step."""
    relations, power = system.relations, 0.0
    for i in range(relations.frictions.shape[0]):
        one = relations.frictions[i]
        power += one.force * rate(relations.coordinates[one.coordinate], state)
    return power


@kernel
def power_of_path(system, h, start, end, work):
    """Return 4 P_middle + P_end of loads, and of friction in joints, on a path with linear velocities.

    The difference of the works on two paths from the same start is h/6 times the difference of these: the power
    of dampers is quadratic in time (Simpson's rule).
    """
    result = work.result[0]
    for b in range(start.shape[0]):
        halfway(start[b], end[b], work.stage[b])
    result.time = result.start + 0.5 * h
    loads = 4.0 * applied_wrenches(system, work.stage, False, work)
    friction = 4.0 * friction_power(system, work.stage)
    result.time = result.start + h
    loads += applied_wrenches(system, end, False, work)
    return loads, friction + friction_power(system, end)
