"""A displacement along an axis of the parent."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.kinematics.joints import acceleration_bias, anchor_gap, axis


@kernel
def slides(c):
    """Return True."""
    return True


@kernel
def value(system, c, state):
    """Return the displacement [m]."""
    ax, ay, az = axis(state, c.parent, c.parent_frame, 0)
    dx, dy, dz = anchor_gap(c, state)
    return ax * dx + ay * dy + az * dz


@kernel
def drift(system, c, state, out):
    """Return q'' for bodies without acceleration; `out` is workspace (6,)."""
    ax, ay, az = axis(state, c.parent, c.parent_frame, 0)
    acceleration_bias(c, state, out)
    return -(ax * out[3] + ay * out[4] + az * out[5])


@kernel
def counts_turns(c):
    """Return False."""
    return False


@kernel
def turn_within(system, c, start, end, h):
    """Return 0: a displacement has no turns."""
    return 0.0
