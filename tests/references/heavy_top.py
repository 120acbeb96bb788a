"""The heavy top: Euler's equations about the fixed point, scipy only.

Conventions. Fixed point = world origin; at t = 0 body axes = world axes (q = 1). Mass centre at
(0, 1, 0) in the body, so the spin axis is the body's y. m = 15 kg; inertia about the mass centre
diag(0.234375, 0.46875, 0.234375), about the fixed point diag(15.234375, 0.46875, 15.234375) kg m^2.
Gravity 9.81 along -z. Angular velocity at t = 0 is (0, 150, -4.61538) rad/s, in body and world axes
alike; the mass centre starts with omega x c = (4.61538, 0, 0) m/s. All equations in body axes::

    J dW/dt = J W x W + c x m R^T g ,   dQ/dt = Q (0, W)/2
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

MASS, CENTRE = 15.0, np.array([0.0, 1.0, 0.0])
INERTIA = np.array([0.234375, 0.46875, 0.234375])  # about the mass centre
ABOUT_POINT = INERTIA + MASS * np.array([1.0, 0.0, 1.0])
GRAVITY = np.array([0.0, 0.0, -9.81])
SPIN = np.array([0.0, 150.0, -4.61538])


def rotation(Q):
    """Return the matrix, body to world, of a unit quaternion (w, x, y, z)."""
    w, v = Q[0], np.asarray(Q[1:])
    hat = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + 2.0 * w * hat + 2.0 * hat @ hat


def cross(a, b):
    """Return a x b."""
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])


def rates(t, y):
    """Return dQ/dt and dW/dt."""
    Q, W = y[:4], y[4:]
    torque = cross(ABOUT_POINT * W, W) + cross(CENTRE, MASS * rotation(Q).T @ GRAVITY)
    half = 0.5 * np.array([-Q[1:] @ W, *(Q[0] * W + cross(Q[1:], W))])
    return np.concatenate([half, torque / ABOUT_POINT])


def motion(times, rtol=3e-13):
    """Return quaternion (T, 4), angular velocity in body axes (T, 3), mass centre (T, 3)."""
    start = [1.0, 0.0, 0.0, 0.0, *SPIN]
    times = np.asarray(times, float)
    run = solve_ivp(
        rates, (0.0, times[-1]), start, "DOP853", t_eval=times, rtol=rtol, atol=1e-14
    )  # fmt: skip
    Q = (run.y[:4] / np.linalg.norm(run.y[:4], axis=0)).T
    return Q, run.y[4:].T, np.array([rotation(q) @ CENTRE for q in Q])
