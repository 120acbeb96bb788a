"""Distances between a simulated and a recorded motion."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.geometry import quaternion
from carom.geometry.attitude import quaternions

if TYPE_CHECKING:
    from carom.geometry.attitude import Orientation


class TrajectoryError(NamedTuple):
    """Errors of a simulated motion: means over all samples and bodies."""

    position: float  #: distance of the mass centres, relative to `length`
    rotation: (
        float  #: angle from one attitude to the other [rad], 0 to pi; NaN if none was recorded
    )


def offsets(simulated, recorded) -> tuple[np.ndarray, np.ndarray]:
    """Return displacements [m] and rotation vectors [rad] (n, N, 3) from recorded to simulated poses.

    The arguments have a `position` (n, N, 3) and an `orientation` (n, N, 4). Of a recording of positions alone
    there are no rotation vectors, (n, 0, 3).
    """
    if recorded.orientation is None:
        away = simulated.position - recorded.position
        return away, away[:, :0]
    turn = quaternion.between(recorded.orientation, simulated.orientation)
    return simulated.position - recorded.position, turn


def distances(simulated, recorded) -> tuple[np.ndarray, np.ndarray]:
    """Return the distances of the mass centres [m] and the angles between the attitudes [rad], (n, N)."""
    away, turn = offsets(simulated, recorded)
    return np.linalg.norm(away, axis=-1), np.linalg.norm(turn, axis=-1)


def trajectory_error(simulated, recorded, length: float = 1.0) -> TrajectoryError:
    """Compare a simulated motion with a recorded one, sample by sample.

    Parameters
    ----------
    simulated, recorded : RollOut or Recording
        Two motions with `position` (n, N, 3) and `orientation` (n, N, 4) at the same times.
    length : float
        Reference length by which distances are divided, such as an edge of the body [m]. Default 1.

    Returns
    -------
    TrajectoryError
        ``position``, the mean of ``|p_sim - p_rec| / length``, and ``rotation``, the mean of the geodesic
        angle ``2 asin(|R_sim - R_rec|_F / sqrt(8))`` [rad].
    """
    length = checks.number("length", length, above=0.0, unit="m")
    for name, given in (("simulated", simulated), ("recorded", recorded)):
        if not (hasattr(given, "position") and hasattr(given, "orientation")):
            raise TypeError(f"{name} must be a RollOut or a Recording, got {checks.shown(given)}")
    if np.shape(simulated.position) != np.shape(recorded.position):
        raise ValueError(
            f"simulated and recorded must have the same shape, got {np.shape(simulated.position)} and "
            f"{np.shape(recorded.position)}"
        )
    distance, angle = distances(simulated, recorded)
    turned = float(np.mean(angle)) if angle.size else float("nan")
    return TrajectoryError(float(np.mean(distance)) / length, turned)


def mean_error(length: float, angle: float | None = None) -> Callable:
    """Return an objective for `identify`: half the sum of mean distance / `length` and mean angle / `angle`.

    Distances are not squared, so that a few recordings with large errors do not dominate the fit.

    Parameters
    ----------
    length, angle : float
        Errors of position [m] and rotation [rad] with equal weight, above 0. Without orientations the objective
        is mean distance / `length`, and needs no `angle`.
    """
    length = checks.number("length", length, above=0.0, unit="m")
    angle = _angle(angle)

    def objective(simulated, recorded) -> float:
        error = trajectory_error(simulated, recorded, length)
        if recorded.orientation is None:
            return error.position
        return 0.5 * (error.position + error.rotation / _needed(angle))

    return objective


def squared_error(length: float, angle: float | None = None) -> Callable:
    """Return an objective for `identify`: least squares, with the value 1 if errors are as large as the noise.

    It is best if the simulated motion is a smooth function of the parameters over the whole recording.

    Parameters
    ----------
    length, angle : float
        Standard deviation of one component of a recorded position [m] and rotation [rad], above 0. Recordings
        without orientations need no `angle`.
    """
    length = checks.number("length", length, above=0.0, unit="m")
    angle = _angle(angle)

    def objective(simulated, recorded) -> float:
        distance, turn = distances(simulated, recorded)
        moved = float(np.mean((distance / length) ** 2))
        if recorded.orientation is None:
            return moved / 3.0
        return (moved + float(np.mean((turn / _needed(angle)) ** 2))) / 6.0

    return objective


def _angle(angle: float | None) -> float | None:
    return None if angle is None else checks.number("angle", angle, above=0.0, unit="rad")


def _needed(angle: float | None) -> float:
    if angle is None:
        raise ValueError("angle must be given for a Recording with orientations, got None")
    return angle


def face_up(orientation: Orientation, up: ArrayLike = (0.0, 0.0, 1.0)) -> np.ndarray:
    """Return the body axis that points up: 0, 1, 2 for x, y, z and 3, 4, 5 for -x, -y, -z.

    Parameters
    ----------
    orientation : (..., 4)
        Unit quaternions (w, x, y, z), body to world.
    up : (3,)
        Upward direction, world axes. Default (0, 0, 1).

    Returns
    -------
    ndarray of int (...)
        Index of the axis for each orientation.
    """
    Q = checks.vectors("orientation", quaternions("orientation", orientation), 4)
    seen = quaternion.rotate_back(Q, checks.unit_vector("up", up))
    return np.argmax(np.concatenate([seen, -seen], axis=-1), axis=-1)
