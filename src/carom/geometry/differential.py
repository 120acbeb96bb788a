"""Differential of the exponential on SO(3), for arrays of rotation vectors (..., 3): NumPy.

If a rotation ``R exp(hat a)`` changes with a, its body angular velocity is ``W = T(a) adot``:

    T(a)    = 1 - (1 - cos t)/t^2 hat + (t - sin t)/t^3 hat^2,      t = |a|,
    T(a)^-1 = 1 + 1/2 hat + (1 - (t/2) cot(t/2))/t^2 hat^2,

(mathematics page, *Connection and autoparallels*). T(-a) is the transpose of T(a), and its
left-sided (world) form. T is singular at the angles 2 pi, 4 pi, ...
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.geometry.quaternion import shaped
from carom.geometry.thresholds import SMALLEST

Array = NDArray[np.float64]


def apply(a: ArrayLike, b: ArrayLike) -> Array:
    """Return T(a) b, shape (..., 3): the body angular velocity for the rate b of the rotation vector a.

    Parameters
    ----------
    a : array_like (..., 3)
        Rotation vectors [rad], of any angle.
    b : array_like (..., 3)
        Vectors, of any unit.
    """
    a, b = shaped("a", a, 3), shaped("b", b, 3)
    first, second = _coefficients(np.sum(a * a, axis=-1, keepdims=True))
    ab = np.cross(a, b)
    return b - first * ab + second * np.cross(a, ab)


def apply_inverse(a: ArrayLike, b: ArrayLike) -> Array:
    """Return T(a)^-1 b, shape (..., 3): the rate of the vector a for the body angular velocity b.

    Valid for |a| < 2 pi; at 2 pi, T is singular. Parameters as in `apply`.
    """
    a, b = shaped("a", a, 3), shaped("b", b, 3)
    ab = np.cross(a, b)
    return b + 0.5 * ab + _inverse(np.sum(a * a, axis=-1, keepdims=True)) * np.cross(a, ab)


def matrix(a: ArrayLike) -> Array:
    """Return the matrices T(a), shape (..., 3, 3), of rotation vectors a (..., 3) [rad]."""
    a = shaped("a", a, 3)
    return np.swapaxes(apply(a[..., None, :], np.eye(3)), -1, -2)


def _coefficients(t2: Array) -> tuple[Array, Array]:
    """Return (1 - cos t)/t^2 and (t - sin t)/t^3: below t = 1 the series to t^16."""
    near, far = np.minimum(t2, 1.0), np.maximum(t2, 1.0)
    first = second = np.ones_like(t2)
    for k in range(8, 0, -1):
        first = 1.0 - first * near / ((2 * k + 1) * (2 * k + 2))
        second = 1.0 - second * near / ((2 * k + 2) * (2 * k + 3))
    t = np.sqrt(far)
    half = np.sin(0.5 * t)
    return (
        np.where(t2 < 1.0, first / 2.0, 2.0 * half * half / far),
        np.where(t2 < 1.0, second / 6.0, (t - np.sin(t)) / (far * t)),
    )


def _inverse(t2: Array) -> Array:
    """Return (1 - u cot u)/t^2 with u = t/2, as g(u)/(4 sin(u)/u), g = (sin u - u cos u)/u^3."""
    u2 = 0.25 * t2
    near, far = np.minimum(u2, 1.0), np.maximum(u2, 1.0)
    g = np.ones_like(t2)
    for k in range(9, 0, -1):
        g = 1.0 - g * near / (2 * k * (2 * k + 3))
    u = np.sqrt(near)
    u = np.where(u > 0.0, u, SMALLEST)
    v = np.sqrt(far)
    return np.where(
        u2 < 1.0, g / 12.0 * (u / np.sin(u)), (np.sin(v) - v * np.cos(v)) / (4.0 * far * np.sin(v))
    )
