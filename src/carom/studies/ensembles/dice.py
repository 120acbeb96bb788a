"""Dice: the face that is up, its frequency, and a test of fairness."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.geometry import quaternion
from carom.geometry.attitude import quaternions

if TYPE_CHECKING:
    from carom.geometry.attitude import Orientation

#: faces by the axis of the body that points up: +x, -x, +y, -y, +z, -z; opposite faces add up to seven
FACES = np.array([5, 2, 4, 3, 6, 1])
#: a face is up if 1 - cos of the angle between its normal and the vertical is below this
UP = 1e-6


def face_up(orientation: Orientation) -> np.ndarray:
    """Return the face, 1 to 6, that is up in each orientation (..., 4); 0 if no face is level.

    The faces +x, -x, +y, -y, +z, -z of the body have the numbers 5, 2, 4, 3, 6, 1.
    """
    Q = checks.real_array("orientation", quaternions("orientation", orientation), "(..., 4)")
    if Q.shape[-1:] != (4,):
        raise ValueError(f"orientation must have shape (..., 4), got shape {Q.shape}")
    with np.errstate(invalid="ignore"):
        up = quaternion.rotate_back(Q, np.broadcast_to([0.0, 0.0, 1.0], (*Q.shape[:-1], 3)))
        axis = np.argmax(np.nan_to_num(np.abs(up)), axis=-1)
        along = np.take_along_axis(up, axis[..., None], axis=-1)[..., 0]
        face = FACES[2 * axis + (along < 0.0)]
        return np.where(1.0 - np.abs(along) <= UP, face, 0)


class Fairness(NamedTuple):
    """Frequencies of the faces, and a chi-square test of fairness."""

    counts: np.ndarray  # (6,) of faces 1 to 6
    share: np.ndarray  # (6,)
    low: np.ndarray  # (6,) 95 % confidence intervals (Wilson 1927)
    high: np.ndarray
    chi_square: float  # chi-square statistic of the hypothesis that all faces are equally likely
    p_value: float  # probability of this statistic, or a greater one, under the hypothesis


def fairness(faces: ArrayLike) -> Fairness:
    """Return the statistics of faces 1 to 6; other values are left out.

    Raises
    ------
    ValueError
        If there are no faces from 1 to 6.
    """
    from scipy.stats import binomtest, chisquare

    faces = checks.real_array("faces", faces, "(n,)")
    counts = np.array([int(np.sum(faces == face)) for face in range(1, 7)])
    total = int(counts.sum())
    if total == 0:
        raise ValueError("faces must have at least one value from 1 to 6, got none")
    bounds = [binomtest(int(n), total).proportion_ci(method="wilson") for n in counts]
    test = chisquare(counts)
    return Fairness(
        counts, counts / total, np.array([b.low for b in bounds]), np.array([b.high for b in bounds]),
        float(test.statistic), float(test.pvalue),
    )  # fmt: skip
