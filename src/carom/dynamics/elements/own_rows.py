"""The common form of elements with rows of their own: errors are numbers, the first of six."""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def clear(out):
    """Write six zeros."""
    for k in range(6):
        out[k] = 0.0


@kernel
def position_error(system, j, state, work):
    """Write no error to the bias."""
    clear(work.joint[j].bias)


@kernel
def velocity_error(system, j, state, work):
    """Write no error to the bias."""
    clear(work.joint[j].bias)


@kernel
def row_target(system, j, state, relative, out):
    """Write the errors of the rows."""
    for r in range(system.joints[j].rows):
        out[r] = relative[r]


@kernel
def add_wrenches(system, j, state, multiplier, work):
    """Add nothing: the force of the row is stated where it acts."""


@kernel
def turn_back(system, j, start, end, work):
    """Change nothing: numbers have no axes."""


@kernel
def keep_rows_without_position(system, j, start, state, work):
    """Change nothing: all rows are without position, if some are."""


@kernel
def restricts_velocities_only(system, joint):
    """Return False: each row has an error of position."""
    return False
