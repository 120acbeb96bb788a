"""Constraints of a system in coordinates of the user's own, phi(q) = 0 and a(q) v = 0, up to six rows each."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.elements.own_rows import clear
from carom.kinematics.own_functions import find_constraints
from carom.model.own_coordinates import ROWS_OF_ELEMENT


@unit
def position_error(system, j, state, work):
    """Write phi to the bias, 0 for rows that restrict velocities only."""
    own, out = system.own, work.joint[j].bias
    find_constraints(system.own, state, False)
    clear(out)
    for r in range(system.joints[j].rows):
        row = ROWS_OF_ELEMENT * j + r
        out[r] = own.phi[row] if row < own.holonomic else 0.0


@unit
def velocity_error(system, j, state, work):
    """Write A v to the bias."""
    own, out = system.own, work.joint[j].bias
    find_constraints(system.own, state, False)
    clear(out)
    for r in range(system.joints[j].rows):
        for b in range(own.n):
            out[r] += own.A[ROWS_OF_ELEMENT * j + r, b] * state[b].v[0]


@unit
def acceleration_bias(system, j, state, work):
    """Write -(dA/dt) v, the required values of the rows times the accelerations."""
    own, out = system.own, work.joint[j].bias
    find_constraints(system.own, state, True)
    clear(out)
    for r in range(system.joints[j].rows):
        out[r] = -own.A_rate[ROWS_OF_ELEMENT * j + r]


@unit
def add_wrenches(system, j, state, multiplier, work):
    """Add A^T multiplier to the wrenches."""
    own = system.own
    find_constraints(system.own, state, False)
    for r in range(system.joints[j].rows):
        for b in range(own.n):
            work.body[b].wrench[0] += multiplier[r] * own.A[ROWS_OF_ELEMENT * j + r, b]


@kernel
def restricts_velocities_only(system, joint):
    """Return whether some rows have no function of the position."""
    return system.own.holonomic < system.own.rows
