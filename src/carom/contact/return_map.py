"""The return map: back to the boundary along an autoparallel that is normal to it in the kinetic metric.

    xi = kappa P G_n^T(q_e),   q_e = Exp_q(xi),   rho(q_e) = 0

kappa is found by Newton's method, kappa -= rho/(G_n P G_n^T), with G_n and P at the current q_e and the
whole arc taken from q again. (Paper, contact detection; Eq. (10).)
"""

from __future__ import annotations

from carom.contact.gap import strike_point
from carom.geometry.rotation import exp, multiply, normalize
from carom.jit import kernel
from carom.motion.contact_point import contact_arm, spread
from carom.motion.project import project_position


@kernel
def return_map(system, c, x, Q, origin, work, tie, tolerance):
    """Move (x, Q) onto the surface of contact c; `origin` is scratch. Returns iterations, or -1."""
    joints = system.joints.kind.size
    b = system.contacts.body[c]
    origin.x[:], origin.Q[:] = x, Q
    origin.v[:], origin.w[:] = 0.0, 0.0
    kappa = 0.0
    for iteration in range(50):
        rho, _ = strike_point(system, c, x, Q, origin.v, origin.w, tie, work.point)
        if abs(rho) <= tolerance:
            return iteration
        p = work.point
        rx, ry, rz = contact_arm(system, c, Q, p[0], p[1], p[2])
        spread(system, c, x, Q, rx, ry, rz, 1.0, 0.0, 0.0, work)
        d = work.delta[b]
        w_nn = normal_row(system, c, d, rx, ry, rz)
        if not w_nn > 0.0:
            return -1
        if joints > 0:  # the arc through jointed positions: step on from here, joints polished
            carry(system, b, -rho / w_nn, x, Q, x, Q, work)
            if not (project_position(system, x, Q, work, 1e-14) <= 1e-9):
                return -1
        else:
            kappa -= rho / w_nn
            carry(system, b, kappa, origin.x, origin.Q, x, Q, work)
    return -1


@kernel
def normal_row(system, c, d, rx, ry, rz):
    """Return G_n d for a motion d (6,) of the body of contact c."""
    n = system.contacts.axes[c]
    ux = d[0] + d[4] * rz - d[5] * ry
    uy = d[1] + d[5] * rx - d[3] * rz
    uz = d[2] + d[3] * ry - d[4] * rx
    return n[0, 0] * ux + n[0, 1] * uy + n[0, 2] * uz


@kernel
def carry(system, body, kappa, x0, Q0, x, Q, work):
    """Write (x, Q) = Exp at (x0, Q0) of kappa work.delta, for all bodies that the contact moves."""
    alone = system.bodies.isolated[body] == 1
    first, last = (body, body + 1) if alone else (0, x.shape[0])
    for b in range(first, last):
        d = work.delta[b]
        for k in range(3):
            x[b, k] = x0[b, k] + kappa * d[k]
        r = exp(kappa * d[3], kappa * d[4], kappa * d[5])
        q = multiply(r[0], r[1], r[2], r[3], Q0[b, 0], Q0[b, 1], Q0[b, 2], Q0[b, 3])
        Q[b, 0], Q[b, 1], Q[b, 2], Q[b, 3] = normalize(q[0], q[1], q[2], q[3])


