"""Forces and torques, constant in the axes of the world or of a body."""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.kinematics.joints import arm
from carom.kinematics.wrench import add_force, point, point_velocity


@kernel
def add(system, load, state, power, work):
    """Add a force and torque; return `power` with theirs."""
    b, w = load.body, state[load.body].w
    f, t = arm(state, load.frame, load.force), arm(state, load.frame, load.torque)
    rx, ry, rz, _px, _py, _pz = point(state, b, load.anchor)
    add_force(work, b, (rx, ry, rz), f)
    ux, uy, uz = point_velocity(state, b, rx, ry, rz)
    given = f[0] * ux + f[1] * uy + f[2] * uz
    wrench = work.body[b].wrench
    for k in range(3):
        wrench[3 + k] += t[k]
        given += t[k] * w[k]
    return power + given, math.nan, math.nan, math.nan


@kernel
def acts_at(system, load, state):
    """Return the arm of the body to its anchor."""
    return arm(state, load.body, load.anchor)
