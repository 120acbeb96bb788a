"""Return to the joints: the shortest displacement and the smallest velocity change, in the kinetic metric.

    xi = -M^-1 A^T (A M^-1 A^T)^+ phi,   q <- Exp_q(xi);    v <- v - M^-1 A^T (A M^-1 A^T)^+ A v

both by the one constrained solve with the error as its bias.
"""

from __future__ import annotations

from carom.geometry.rotation import exp, multiply, normalize
from carom.jit import kernel
from carom.motion.joints import position_error, velocity_error
from carom.motion.solve import solve


@kernel
def displace(xi, x, Q):
    """Move all bodies by xi (N, 6), world axes: x + xi_x, exp(xi_theta) Q."""
    for b in range(x.shape[0]):
        for k in range(3):
            x[b, k] += xi[b, k]
        r = exp(xi[b, 3], xi[b, 4], xi[b, 5])
        q = multiply(r[0], r[1], r[2], r[3], Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3])
        Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3] = normalize(q[0], q[1], q[2], q[3])


@kernel
def largest_position_error(system, x, Q, bias):
    """Fill `bias` with minus the errors of position and return the largest, as a length [m]."""
    joints, size = system.joints, system.bodies.size
    largest = 0.0
    for j in range(joints.kind.size):
        position_error(joints, j, x, Q, bias)
        length = size[joints.child[j]]
        for k in range(6):
            e = abs(bias[j, k]) * (length if k < 3 else 1.0)
            if not (e <= largest):
                largest = e
            bias[j, k] = -bias[j, k]
    return largest


@kernel
def project_position(system, x, Q, work, tolerance):
    """Bring (x, Q) back to the joints; return the error left, relative to the largest body."""
    scale = 0.0
    for b in range(system.bodies.size.size):
        scale = max(scale, system.bodies.size[b])
    error = 0.0
    for _ in range(8):
        error = largest_position_error(system, x, Q, work.bias) / scale
        if error <= tolerance:
            break
        work.wrench[:] = 0.0
        solve(system, x, Q, work.wrench, work.bias, work.delta, work.reaction)
        displace(work.delta, x, Q)
    return error


@kernel
def project_velocity(system, x, Q, v, w, work):
    """Take from the velocities what the joints forbid."""
    joints = system.joints
    for j in range(joints.kind.size):
        velocity_error(joints, j, x, Q, v, w, work.bias)
        for k in range(6):
            work.bias[j, k] = -work.bias[j, k]
    work.wrench[:] = 0.0
    solve(system, x, Q, work.wrench, work.bias, work.delta, work.reaction)
    for b in range(v.shape[0]):
        for k in range(3):
            v[b, k] += work.delta[b, k]
            w[b, k] += work.delta[b, 3 + k]
