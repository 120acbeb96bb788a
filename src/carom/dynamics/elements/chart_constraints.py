"""Constraints of a system in coordinates of the user's own, phi(q) = 0 and a(q) v = 0, up to six rows each."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.elements.own_rows import clear
from carom.kinematics.chart import find_constraints
from carom.model.chart import ROWS_OF_ELEMENT


@unit
def position_error(system, j, state, work):
    """Write phi to the bias, 0 for rows that restrict velocities only."""
    chart, out = system.chart, work.joint[j].bias
    find_constraints(system.chart, state, False)
    clear(out)
    for r in range(system.joints[j].rows):
        row = ROWS_OF_ELEMENT * j + r
        out[r] = chart.phi[row] if row < chart.holonomic else 0.0


@unit
def velocity_error(system, j, state, work):
    """Write A v to the bias."""
    chart, out = system.chart, work.joint[j].bias
    find_constraints(system.chart, state, False)
    clear(out)
    for r in range(system.joints[j].rows):
        for b in range(chart.n):
            out[r] += chart.A[ROWS_OF_ELEMENT * j + r, b] * state[b].v[0]


@unit
def acceleration_bias(system, j, state, work):
    """Write -(dA/dt) v, the required values of the rows times the accelerations."""
    chart, out = system.chart, work.joint[j].bias
    find_constraints(system.chart, state, True)
    clear(out)
    for r in range(system.joints[j].rows):
        out[r] = -chart.A_rate[ROWS_OF_ELEMENT * j + r]


@unit
def add_wrenches(system, j, state, multiplier, work):
    """Add A^T multiplier to the wrenches."""
    chart = system.chart
    find_constraints(system.chart, state, False)
    for r in range(system.joints[j].rows):
        for b in range(chart.n):
            work.body[b].wrench[0] += multiplier[r] * chart.A[ROWS_OF_ELEMENT * j + r, b]


@kernel
def restricts_velocities_only(system, joint):
    """Return whether some rows have no function of the position."""
    return system.chart.holonomic < system.chart.rows
