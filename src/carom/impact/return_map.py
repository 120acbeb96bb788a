"""The return map moves back to the boundary along an autoparallel that is normal to it in the kinetic metric.

    xi = kappa P G_n^T(q_e),   q_e = Exp_q(xi),   rho(q_e) = 0

kappa is found by Newton's method, kappa -= rho/(G_n P G_n^T), with G_n and P at the current q_e. For a free
body each iteration starts again from q; a body with joints continues from the current q_e, and its position is
projected on the joints after each iteration. (Paper, contact detection; Eq. (10).)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.gap import strike_point
from carom.dynamics.contact_impulse import alone, spread
from carom.dynamics.project import project_position
from carom.geometry.rotation import exp, multiply, normalize
from carom.kinematics.contact_point import contact_motion, place


@kernel
def return_map(system, contact, state, work, tie, tolerance):
    """Move `state` onto the surface of the contact; return the number of iterations, or -1 (paper, Eq. (10)).

    One point is moved until it is on the surface. If the rotation of the body has then moved another point
    below the surface, that point is next.
    """
    origin, core, point = work.middle, work.hit[0].point, work.point[0]
    joined = system.bodies[contact.body].isolated == 0
    kappa, rho = 0.0, -math.inf
    for iteration in range(100):
        if not (abs(rho) > tolerance and iteration > 0):
            rho, _ = strike_point(contact, system.vertices, state, tie, core)
            copy_pose(state, origin)
            kappa = 0.0
            if rho >= -tolerance and (iteration > 0 or rho <= tolerance):
                return iteration
        place(contact, core, state, point)
        spread(system, point, state, 1.0, 0.0, 0.0, work)
        w_nn = contact_motion(point, work)[0]
        if not w_nn > 0.0:
            return -1
        if joined:
            carry(system, point, -rho / w_nn, state, state, work)
            if not (project_position(system, state, False, 1e-14, work) <= 1e-9):
                return -1
        else:
            kappa -= rho / w_nn
            carry(system, point, kappa, origin, state, work)
        place(contact, core, state, point)
        rho = point.gap
    return -1


@kernel
def copy_pose(start, end):
    """Copy positions and attitudes."""
    for b in range(start.shape[0]):
        for k in range(3):
            end[b].x[k] = start[b].x[k]
        for k in range(4):
            end[b].Q[k] = start[b].Q[k]


@kernel
def carry(system, point, kappa, origin, state, work):
    """Set `state` to Exp of kappa times the motion of the last solve, from `origin`."""
    if alone(system, point):
        move(work.body[point.a].motion, kappa, origin[point.a], state[point.a])
        if point.b >= 0:
            move(work.body[point.b].motion, kappa, origin[point.b], state[point.b])
    else:
        for b in range(state.shape[0]):
            move(work.body[b].motion, kappa, origin[b], state[b])


@kernel
def move(xi, kappa, start, end):
    """Move one body to Exp of kappa xi from `start`."""
    Q0, Q = start.Q, end.Q
    for k in range(3):
        end.x[k] = start.x[k] + kappa * xi[k]
    r = exp(kappa * xi[3], kappa * xi[4], kappa * xi[5])
    q = multiply(r[0], r[1], r[2], r[3], Q0[0], Q0[1], Q0[2], Q0[3])
    Q[0], Q[1], Q[2], Q[3] = normalize(q[0], q[1], q[2], q[3])
