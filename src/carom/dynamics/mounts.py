"""Elastic mounts in NumPy, at many times: for reports after a run (`carom.dynamics.bushing` is the kernel)."""

from __future__ import annotations

import numpy as np

from carom.geometry import quaternion


def mounted(bushing, x, Q):
    """Return displacement and rotation (T, 3) in mount axes, these axes (T, 4), and the child's anchor (T, 3).

    x (T, N, 3), Q (T, N, 4): positions and attitudes of all bodies.
    """
    (a, p), (b, q) = (
        (frame + np.zeros((len(x), 4)), anchor + np.zeros((len(x), 3)))
        if k < 0
        else (quaternion.multiply(Q[:, k], frame), x[:, k] + quaternion.rotate(Q[:, k], anchor))
        for k, frame, anchor in (
            (bushing.parent, bushing.parent_frame, bushing.parent_anchor),
            (bushing.child, bushing.child_frame, bushing.child_anchor),
        )
    )
    turn = quaternion.log(quaternion.multiply(quaternion.conjugate(a), b))
    return quaternion.rotate_back(a, q - p), turn, a, q
