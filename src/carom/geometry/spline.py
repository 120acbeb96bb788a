"""Cubic Hermite interpolation between two states of N bodies, for arrays of times: NumPy.

Positions: the cubic that has the positions and velocities of both ends. Rotations: the cubic of the
rotation vector eta in the autoparallel chart of the first end, ``R(t) = R0 exp(hat eta(t))``, with
eta(0) = 0, eta(h) = log(R0^T R1) and rates ``T(eta)^-1 W`` that give the angular velocities of both
ends; inside, ``W = T(eta) etadot``. Both are C^1 over a chain of states; the error is O(h^4) in
position and rotation, O(h^3) in the velocities.

If the body turns far between the ends, the chart moves along the autoparallel of the mean angular velocity,
``R(t) = R0 exp(t hat Wbar) exp(hat eta(t))``. Then log only has to represent the rest of the rotation, so
steady rotation is exact for any number of turns.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.geometry import differential
from carom.geometry.quaternion import between, exp, multiply, normalize, rotate, rotate_back, shaped
from carom.geometry.thresholds import CHART_ANGLE

Array = NDArray[np.float64]
State = tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike]


def interpolate(
    t: ArrayLike, t0: ArrayLike, t1: ArrayLike, state0: State, state1: State
) -> tuple[Array, Array, Array, Array]:
    """Return the states at the times t, each interpolated between two states of its own.

    Parameters
    ----------
    t, t0, t1 : array_like (K,) or scalar
        Times [s], ``t0 <= t <= t1``. If ``t0 == t1`` the result is the first state. Other t are extrapolated
        without a warning.
    state0, state1 : tuple of arrays
        States at t0 and t1: positions x (K, N, 3) [m], orientations Q (K, N, 4), velocities v
        (K, N, 3) [m/s] and angular velocities w (K, N, 3) [rad/s], in world axes. The axis N may be
        absent.

    Returns
    -------
    x, Q, v, w : ndarray
        The states at t, with the same shapes; Q has unit length and, at t0, the sign of ``state0``.

    Notes
    -----
    The velocities are the derivatives of the interpolated positions and rotations. Source:
    mathematics page, *Connection and autoparallels*.
    """
    x0, Q0, v0, w0 = _state("state0", state0)
    x1, Q1, v1, w1 = _state("state1", state1)
    t, t0, t1 = (
        np.asarray(s, dtype=np.float64).reshape(np.shape(s) + (1,) * (x0.ndim - np.ndim(s)))
        for s in (t, t0, t1)
    )
    if np.any(t1 < t0):
        raise ValueError(f"t1 must be at least t0, got {np.min(t1 - t0):g} s less")
    empty = t1 == t0
    h = np.where(empty, 1.0, t1 - t0)
    s = np.where(empty, 0.0, (t - t0) / h)
    x, v = cubic(s, h, x0, v0, x1, v1)
    Q, W = _rotation(s, h, Q0, rotate_back(Q0, w0), Q1, rotate_back(Q1, w1))
    return x, Q, v, rotate(Q, W)


def _rotation(s, h, Q0, W0, Q1, W1):
    """Return rotations and body angular velocities on the cubic in the chart."""
    mean = 0.5 * (W0 + W1)
    far = h * np.linalg.norm(mean, axis=-1, keepdims=True) > CHART_ANGLE
    carry = np.where(far, mean, 0.0)
    end = between(multiply(Q0, exp(h * carry)), Q1)
    rate0 = W0 - carry
    rate1 = differential.apply_inverse(end, W1 - rotate_back(exp(end), carry))
    eta, rate = cubic(s, h, np.zeros_like(end), rate0, end, rate1)
    turned = exp(eta)
    Q = normalize(multiply(multiply(Q0, exp(s * h * carry)), turned))
    return Q, differential.apply(eta, rate) + rotate_back(turned, carry)


def cubic(s, h, y0, d0, y1, d1):
    """Return value and rate, at the fraction s of a step h, of the cubic with these ends and rates.

    Both are exactly the given ones at s = 0 and s = 1.
    """
    r = 1.0 - s
    value = r * r * (1.0 + 2.0 * s) * y0 + s * s * (3.0 - 2.0 * s) * y1
    rate = r * (1.0 - 3.0 * s) * d0 + s * (3.0 * s - 2.0) * d1
    return value + h * s * r * (r * d0 - s * d1), rate + 6.0 * s * r * ((y1 - y0) / h)


def _state(name: str, state: State) -> tuple[Array, Array, Array, Array]:
    x, Q, v, w = state
    return (
        shaped(f"{name}: x", x, 3),
        shaped(f"{name}: Q", Q, 4),
        shaped(f"{name}: v", v, 3),
        shaped(f"{name}: w", w, 3),
    )
