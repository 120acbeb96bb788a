"""Orientations in the forms of users: quaternions, SciPy rotations, matrices, Euler angles, axis and angle."""

from __future__ import annotations

import math
import warnings
from functools import reduce
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.arguments import known
from carom.geometry import quaternion
from carom.geometry.thresholds import ROUND_OFF, UNIT_ERROR
from carom.status import MistakeWarning

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

    Orientation = ArrayLike | Rotation

KINDS = "a unit quaternion (w, x, y, z), a (3, 3) rotation matrix or a SciPy Rotation"


@known
def euler(axes: str, angles: ArrayLike) -> np.ndarray:
    """Return the unit quaternion of successive rotations about coordinate axes (Euler angles).

    Parameters
    ----------
    axes : str
        One to three letters, in the order of the rotations. Lower case ("xyz"): about axes of the world. Upper
        case ("ZYX"): about axes of the body, which turn with it. The same as in SciPy's
        ``Rotation.from_euler``.
    angles : float, (k,) or (..., k)
        An angle for each letter, in degrees.

    Returns
    -------
    ndarray (4,) or (..., 4)
        Quaternion (w, x, y, z), body to world, for `orientation` of `Scene.add_body`.

    Warns
    -----
    MistakeWarning
        As for `axis_angle`.

    Examples
    --------
    >>> carom.euler("z", 90).round(3)
    array([0.707, 0.   , 0.   , 0.707])
    >>> carom.euler("ZYX", (90, 0, 90)).round(3)
    array([0.5, 0.5, 0.5, 0.5])
    """
    one_frame = isinstance(axes, str) and axes in (axes.lower(), axes.upper())
    if not one_frame or not 1 <= len(axes) <= 3 or not set(axes.lower()) <= set("xyz"):
        raise ValueError(
            'axes must be one to three of x, y, z (about axes of the world, like "xyz") or of X, Y, Z (about '
            f'axes of the body, like "ZYX"), got {checks.shown(axes)}'
        )
    given = checks.real_array("angles", angles, f"(..., {len(axes)}) [deg]")
    if len(axes) == 1 and given.ndim == 0:
        given = given[None]
    given = checks.vectors("angles", given, len(axes))
    _warn_of_radians("angles", given)
    units = [np.eye(3)["xyz".index(letter)] for letter in axes.lower()]
    turns = [_about(unit, given[..., k]) for k, unit in enumerate(units)]
    if axes == axes.lower():
        turns.reverse()
    return reduce(quaternion.multiply, turns)


@known
def axis_angle(axis: ArrayLike, angle: ArrayLike) -> np.ndarray:
    """Return the unit quaternion of a rotation about an axis.

    Parameters
    ----------
    axis : (3,)
        Axis, of any length above 0. The rotation follows the right-hand rule.
    angle : float or (...)
        Angle in degrees.

    Returns
    -------
    ndarray (4,) or (..., 4)
        Quaternion (w, x, y, z), body to world, for `orientation` of `Scene.add_body`.

    Warns
    -----
    MistakeWarning
        For an angle that is a whole number of half degrees in radians, such as pi / 2.

    Examples
    --------
    >>> carom.axis_angle((0, 0, 2), 180).round(12)
    array([0., 0., 0., 1.])
    """
    unit = checks.unit_vector("axis", axis)
    degrees = checks.real_array("angle", angle, "() or (...) [deg]")
    if not np.all(np.isfinite(degrees)):
        raise ValueError(f"angle must be finite [deg], got {checks.shown(angle)}")
    _warn_of_radians("angle", degrees)
    return _about(unit, degrees)


def _about(unit: np.ndarray, degrees: np.ndarray) -> np.ndarray:
    """Return the quaternions (..., 4) of rotations about a unit vector (3,)."""
    half = 0.5 * np.deg2rad(np.fmod(degrees, 720.0))[..., None]
    return np.concatenate([np.cos(half), np.sin(half) * unit], axis=-1)


def _warn_of_radians(name: str, degrees: np.ndarray) -> None:
    """Warn of an angle that is, to round-off, a whole number of half degrees in radians, such as pi / 2."""
    halves = 360.0 / math.pi * degrees
    whole = np.round(halves)
    suspect = (
        (whole != 0.0)
        & (np.abs(whole) <= 720.0)
        & (np.abs(halves - whole) <= ROUND_OFF * np.abs(whole))
    )
    if suspect.any():
        angle, meant = float(degrees[suspect][0]), 0.5 * float(whole[suspect][0])
        warnings.warn(
            f"{name} has {angle!r}, which is {meant:g} degrees in radians; angles are given in degrees here: "
            f"give {meant:g}",
            MistakeWarning,
            stacklevel=4,  # of who called `euler` or `axis_angle`, which have a guard
        )


def attitude(name: str, value) -> np.ndarray:
    """Return an orientation as a unit quaternion (4,); refuse other values, and several orientations."""
    if not _is_rotation(value):
        array = checks.real_array(name, value, f"(4,) or (3, 3): {KINDS}")
        if array.shape not in ((4,), (3, 3)):
            raise ValueError(
                f"{name} must be {KINDS}, got shape {array.shape}; Euler angles in degrees are "
                f'carom.euler("xyz", (30, 0, 90))'
            )
    q = checks.finite_array(name, quaternions(name, value), (4,))
    length = float(np.linalg.norm(q))
    if not abs(length - 1.0) <= UNIT_ERROR:
        raise ValueError(
            f"{name} must be a unit quaternion (w, x, y, z), got {checks.shown(value)} of length {length:.9g}; "
            "the scalar w comes first, SciPy's as_quat() has it last: give the SciPy Rotation itself"
        )
    return q / length


def quaternions(name: str, value) -> Any:
    """Return the quaternions (..., 4) of a SciPy Rotation or matrices (..., 3, 3); other values unchanged."""
    if _is_rotation(value):
        q = np.asarray(value.as_quat(), dtype=float)
        return q[..., [3, 0, 1, 2]]
    return _from_matrices(name, value) if _shape(value)[-2:] == (3, 3) else value


def _is_rotation(value) -> bool:
    """Return whether a value is a SciPy Rotation, without importing SciPy."""
    return type(value).__name__ == "Rotation" and hasattr(value, "as_quat")


def _shape(value) -> tuple[int, ...]:
    """Return the shape of a value, () if it is not an array of numbers."""
    try:
        return checks.real_array("value", value, "").shape
    except ValueError:
        return ()


def _from_matrices(name: str, value) -> np.ndarray:
    """Return the quaternions of matrices (..., 3, 3): of the nearest rotations if the matrices are rounded."""
    matrices = checks.real_array(name, value, "(..., 3, 3)")
    if not np.all(np.isfinite(matrices)):
        raise ValueError(f"{name} must be finite, got {checks.shown(value)}")
    left, size, right = np.linalg.svd(matrices)
    defect = float(np.max(np.abs(size - 1.0), initial=0.0))
    if not defect <= UNIT_ERROR:
        raise ValueError(
            f"{name} must be a rotation matrix, whose columns are unit vectors at right angles, got "
            f"{checks.shown(value)}"
        )
    rotations = left @ right
    if np.any(np.linalg.det(rotations) < 0.0):
        raise ValueError(
            f"{name} must be a rotation matrix, of determinant 1, got a reflection: {checks.shown(value)}"
        )
    return quaternion.from_matrix(rotations)
