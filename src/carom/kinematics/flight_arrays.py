"""Free rotation for arrays of starts and times, for calls from Python."""

from __future__ import annotations

import numpy as np

from carom._compiled.decorators import entry
from carom._compiled.record_arrays import table
from carom.geometry import quaternion
from carom.kinematics.flight import tumble
from carom.model.workspace import BODY_WORK


@entry
def tumble_all(J, attitude, spin, t, memory):
    """Replace attitudes (K, 4) and angular velocities (K, 3) by those after the times t (K,)."""
    for k in range(t.shape[0]):
        q, w = attitude[k], spin[k]
        q, w = tumble(J, t[k], (q[0], q[1], q[2], q[3]), (w[0], w[1], w[2]), memory[0])
        attitude[k, 0], attitude[k, 1], attitude[k, 2], attitude[k, 3] = q
        spin[k, 0], spin[k, 1], spin[k, 2] = w


def torque_free(moments, Q, w, t) -> tuple[np.ndarray, np.ndarray]:
    """Return attitude (K, 4) and angular velocity (K, 3) of a body without torque, exact to round-off.

    Parameters
    ----------
    moments : (3,)
        Principal moments [kg m^2].
    Q, w : (K, 4), (K, 3)
        States: unit quaternions from the principal axes to the world, and angular velocities in world axes
        [rad/s]. Equal states in succession share the constants of their flight.
    t : (K,)
        Times after these states [s], positive or negative.
    """
    J = np.array(moments, dtype=np.float64)
    t = np.ascontiguousarray(t, dtype=np.float64)
    attitude, spin = (np.array(a, dtype=np.float64, order="C") for a in (Q, w))
    if np.ptp(J) == 0.0:
        return quaternion.multiply(quaternion.exp(t[:, None] * spin), attitude), spin
    tumble_all(tuple(J.tolist()), attitude, spin, t, table(BODY_WORK, 1))
    return attitude, spin
