"""The return map moves back to the boundary along an autoparallel that is normal to it in the kinetic metric.

    xi = kappa P G_n^T(q_e),   q_e = Exp_q(xi),   rho(q_e) = 0

kappa is found by Newton's method, kappa -= rho/(G_n P G_n^T), with G_n and P at the current q_e. For a free
body each iteration starts again from q; a body with joints continues from the current q_e, and its position is
projected on the joints after each iteration. (Paper, contact detection; Eq. (10).)
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.contact.operations import strike_point
from carom.dynamics.contact_impulse import alone, spread
from carom.dynamics.explicit import copy_state
from carom.dynamics.project import project_position, shift
from carom.dynamics.thresholds import JOINT_ERROR
from carom.geometry.thresholds import RESOLUTION
from carom.kinematics.contact_point import contact_motion, place


@kernel
def return_map(system, contact, state, work, tie, tolerance):
    """Move `state` onto the surface of the contact; return the number of iterations, or -1 (paper, Eq. (10)).

    One point is moved until it is on the surface. If the rotation of the body has then moved another point
    below the surface, that point is next.
    """
    origin, core, point = work.origin, work.hit[0].point, work.struck[0]
    joined = system.bodies[contact.body].isolated == 0
    kappa, rho = 0.0, -math.inf
    for iteration in range(100):
        if not (abs(rho) > tolerance and iteration > 0):
            rho, _ = strike_point(system, contact, state, tie, core)
            for b in range(state.shape[0]):
                copy_state(state[b], origin[b])
            kappa = 0.0
            if rho >= -tolerance and (iteration > 0 or rho <= tolerance):
                return iteration
        place(contact, core, state, point)
        spread(system, point, state, (1.0, 0.0, 0.0), work)
        w_nn = contact_motion(system, point, state, work)[0]
        if not w_nn > 0.0:
            return -1
        if joined:
            carry(system, point, -rho / w_nn, state, state, work)
            if not (project_position(system, state, False, JOINT_ERROR, work) <= RESOLUTION):
                return -1
        else:
            kappa -= rho / w_nn
            carry(system, point, kappa, origin, state, work)
        place(contact, core, state, point)
        rho = point.gap
    return -1


@kernel
def carry(system, point, kappa, origin, state, work):
    """Set `state` to Exp of kappa times the motion of the last solve, from `origin`."""
    single = alone(system, point)
    for b in range(state.shape[0]):
        if single and b != point.a and b != point.b:
            continue
        copy_state(origin[b], state[b])
        shift(work.body[b].motion, kappa, state[b])
