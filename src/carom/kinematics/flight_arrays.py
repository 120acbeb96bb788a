"""Free rotation for arrays of starts and times, for calls from Python."""

from __future__ import annotations

import numpy as np

from carom._compiled.decorators import entry
from carom._compiled.record_arrays import table
from carom.geometry import quaternion
from carom.kinematics.flight import tumble
from carom.model.workspace import BODY_WORK


@entry
def tumble_all(J, Q, w, t, memory, attitude, spin):
    """Write attitudes (K, 4) and angular velocities (K, 3) at times t (K,) after the states Q, w."""
    for k in range(t.shape[0]):
        q, u = tumble(
            J, t[k], (Q[k, 0], Q[k, 1], Q[k, 2], Q[k, 3]), (w[k, 0], w[k, 1], w[k, 2]), memory[0]
        )
        attitude[k, 0], attitude[k, 1], attitude[k, 2], attitude[k, 3] = q
        spin[k, 0], spin[k, 1], spin[k, 2] = u


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
    Q, w, t = (np.ascontiguousarray(a, dtype=np.float64) for a in (Q, w, t))
    if np.ptp(J) == 0.0:
        return quaternion.multiply(quaternion.exp(t[:, None] * w), Q), w.copy()
    attitude, spin = np.empty_like(Q), np.empty_like(w)
    tumble_all(tuple(J.tolist()), Q, w, t, table(BODY_WORK, 1), attitude, spin)
    return attitude, spin
