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


def mount_wrench(bushing, x, Q, v, w):
    """Return the point at which a mount acts, its force and its torque on the child (T, 3), world axes."""
    d, turn, axes, place = mounted(bushing, x, Q)
    p, c = int(bushing.parent), int(bushing.child)
    u, spin = v[:, c] + np.cross(w[:, c], place - x[:, c]), w[:, c]
    if p >= 0:
        u, spin = u - v[:, p] - np.cross(w[:, p], place - x[:, p]), spin - w[:, p]
    u, spin = quaternion.rotate_back(axes, u), quaternion.rotate_back(axes, spin)
    m = bushing.turn_stiffness * turn
    t2 = np.sum(turn**2, axis=1, keepdims=True)
    t = np.sqrt(np.maximum(t2, 1e-4))
    b = np.where(t2 > 1e-4, 1.0 / t**2 - 0.5 / (t * np.tan(0.5 * t)), 1.0 / 12.0 + t2 / 720.0)
    moment = m + 0.5 * np.cross(turn, m) + b * np.cross(turn, np.cross(turn, m))
    force = bushing.stiffness * d + bushing.damping * u
    moment = moment + bushing.turn_damping * spin
    return place, -quaternion.rotate(axes, force), -quaternion.rotate(axes, moment)
