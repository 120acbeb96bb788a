"""Arrays of rotations as unit quaternions (w, x, y, z), shape (..., 4): plain NumPy, no kernels.

For scenes and for saved results, (T, N, 4). All functions broadcast over the leading axes. A quaternion
transforms body components to world components, as in `rotation`. A NaN only affects its own entry.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.geometry.thresholds import MATRIX_ERROR

Array = NDArray[np.float64]
_CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])


def shaped(name: str, value: ArrayLike, *shape: int) -> Array:
    """Return `value` as a float array whose last axes are `shape`."""
    array = np.asarray(value, dtype=np.float64)
    if array.shape[-len(shape) :] != shape:
        wanted = ", ".join(map(str, ("...", *shape)))
        raise ValueError(f"{name} must have shape ({wanted}), got shape {array.shape}")
    return array


def multiply(a: ArrayLike, b: ArrayLike) -> Array:
    """Return the product a b (first b, then a), shape (..., 4).

    Parameters
    ----------
    a, b : array_like (..., 4)
        Quaternions, scalar first; they need not have unit length.
    """
    a, b = shaped("a", a, 4), shaped("b", b, 4)
    aw, av, bw, bv = a[..., :1], a[..., 1:], b[..., :1], b[..., 1:]
    scalar = aw * bw - np.add.reduce(av * bv, axis=-1, keepdims=True)
    return np.concatenate([scalar, aw * bv + bw * av + _cross(av, bv)], axis=-1)


def conjugate(q: ArrayLike) -> Array:
    """Return the conjugate (w, -x, -y, -z), the inverse of a unit quaternion, shape (..., 4)."""
    return shaped("q", q, 4) * _CONJUGATE


def normalize(q: ArrayLike) -> Array:
    """Return q (..., 4) divided by its length.

    Raises
    ------
    ValueError
        If a quaternion has length zero.
    """
    q = shaped("q", q, 4)
    length = np.linalg.norm(q, axis=-1, keepdims=True)
    if np.any(length == 0.0):
        raise ValueError("q must have a length above 0, got the zero quaternion")
    return q / length


def rotate(q: ArrayLike, a: ArrayLike) -> Array:
    """Return R a, shape (..., 3): transform body components a (..., 3) to world components."""
    q, a = shaped("q", q, 4), shaped("a", a, 3)
    t = 2.0 * _cross(q[..., 1:], a)
    return a + q[..., :1] * t + _cross(q[..., 1:], t)


def _cross(a: Array, b: Array) -> Array:
    """Return a x b, four times faster than `numpy.cross` for few vectors."""
    out = np.empty(np.broadcast(a, b).shape)
    a0, a1, a2 = a[..., 0], a[..., 1], a[..., 2]
    b0, b1, b2 = b[..., 0], b[..., 1], b[..., 2]
    out[..., 0] = a1 * b2 - a2 * b1
    out[..., 1] = a2 * b0 - a0 * b2
    out[..., 2] = a0 * b1 - a1 * b0
    return out


def rotate_back(q: ArrayLike, a: ArrayLike) -> Array:
    """Return R^T a, shape (..., 3): transform world components a (..., 3) to body components."""
    return rotate(conjugate(q), a)


def matrix(q: ArrayLike) -> Array:
    """Return the rotation matrices R, shape (..., 3, 3), of unit quaternions q (..., 4)."""
    w, x, y, z = np.moveaxis(shaped("q", q, 4), -1, 0)
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def from_matrix(rotation: ArrayLike, tolerance: float = MATRIX_ERROR) -> Array:
    """Return the unit quaternions (..., 4), w >= 0, of rotation matrices (..., 3, 3).

    Of the four vectors 4 q_i q, the one with the largest q_i is used, so no angle is singular
    (Shepperd, *Journal of Guidance and Control* 1, 1978).

    Parameters
    ----------
    rotation : array_like (..., 3, 3)
        Rotation matrices, body to world.
    tolerance : float
        Largest entry of ``R R^T - 1`` that is accepted [1].

    Raises
    ------
    ValueError
        If a matrix is not a rotation: its rows are not orthonormal, or it is a reflection.
    """
    r = shaped("rotation", rotation, 3, 3)
    defect = np.abs(r @ np.swapaxes(r, -1, -2) - np.eye(3)).max(initial=0.0)
    if not defect <= tolerance:
        raise ValueError(
            f"rotation must have orthonormal rows to {tolerance:g}, got a defect of {defect:.3g}"
        )
    if np.any(np.linalg.det(r) < 0.0):
        raise ValueError("rotation must have determinant 1, got a reflection (determinant -1)")
    xx, yy, zz = r[..., 0, 0], r[..., 1, 1], r[..., 2, 2]
    wx, wy, wz = (
        r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0], r[..., 1, 0] - r[..., 0, 1],
    )  # fmt: skip
    xy, xz, yz = (
        r[..., 0, 1] + r[..., 1, 0], r[..., 0, 2] + r[..., 2, 0], r[..., 1, 2] + r[..., 2, 1],
    )  # fmt: skip
    rows = [
        [1.0 + xx + yy + zz, wx, wy, wz],
        [wx, 1.0 + xx - yy - zz, xy, xz],
        [wy, xy, 1.0 - xx + yy - zz, yz],
        [wz, xz, yz, 1.0 - xx - yy + zz],
    ]
    products = np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
    best = np.argmax(np.diagonal(products, axis1=-2, axis2=-1), axis=-1)
    q = np.take_along_axis(products, best[..., None, None], axis=-2)[..., 0, :]
    return normalize(np.where(q[..., :1] < 0.0, -q, q))


def exp(a: ArrayLike) -> Array:
    """Return the unit quaternions (..., 4) of rotation vectors a (..., 3) [rad], of any angle."""
    a = shaped("a", a, 3)
    t = np.linalg.norm(a, axis=-1, keepdims=True)
    # With the same t in both places, sin(t/2)/t is exact to round-off down to the smallest t.
    f = np.where(t > 0.0, np.sin(0.5 * t) / np.where(t > 0.0, t, 1.0), 0.5)
    f = np.where(np.isnan(t), t, f)
    return np.concatenate([np.cos(0.5 * t), f * a], axis=-1)


def log(q: ArrayLike) -> Array:
    """Return the rotation vectors (..., 3) [rad] of quaternions q (..., 4), angles in [0, pi].

    q and -q are the same rotation and give the same vector, except at the angle pi, where both signs
    of the axis are right. The length of q does not matter.
    """
    q = shaped("q", q, 4)
    q = np.where(q[..., :1] < 0.0, -q, q)
    w, v = q[..., :1], q[..., 1:]
    s = np.linalg.norm(v, axis=-1, keepdims=True)
    small = s == 0.0
    f = 2.0 * np.where(
        small, 1.0 / np.where(small, w, 1.0), np.arctan2(s, w) / np.where(small, 1.0, s)
    )
    return f * v


def between(q0: ArrayLike, q1: ArrayLike) -> Array:
    """Return the rotation vectors (..., 3) [rad], in axes of q0, that turn q0 into q1 (..., 4)."""
    return log(multiply(conjugate(q0), q1))


def interpolate(q0: ArrayLike, q1: ArrayLike, s: ArrayLike) -> Array:
    """Return the rotations (..., 4) at the fraction s (...) of the shortest arc from q0 to q1.

    The arc is the autoparallel ``R0 exp(s log(R0^T R1))``: constant angular velocity ("slerp").
    """
    s = np.asarray(s, dtype=np.float64)[..., None]
    return normalize(multiply(q0, exp(s * between(q0, q1))))
