"""A nut on a thread."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import number, shown, unit_vector
from carom.scene.joints.definition import JointDefinition
from carom.scene.values import keep, point


@dataclass(frozen=True, init=False, eq=False)
class Screw(JointDefinition):
    """A nut on a thread: as it turns about the line through `anchor` along `axis`, the child slides along it.

    Parameters
    ----------
    anchor, axis : (3,)
        The line, in the world at the start.
    pitch : float
        How far the child moves along `axis` in one turn about it by the right-hand rule [m]. Negative: a
        left-hand thread. Zero is refused.
    """

    guide, turn = "line", "axis"
    coordinates = ("turn", "slide")
    rows = 5

    anchor: np.ndarray
    axis: np.ndarray
    pitch: float

    def __init__(self, anchor: ArrayLike, axis: ArrayLike, pitch: float):
        pitch = number("pitch", pitch, unit="m")
        if pitch == 0.0:
            raise ValueError(f"pitch must not be 0, got {shown(pitch)}; for no slide use Revolute")
        keep(self, anchor=point("anchor", anchor), axis=unit_vector("axis", axis), pitch=pitch)

    def scale(self) -> float:
        """Return the way along the axis of a turn of 1 rad [m]."""
        return self.pitch / (2.0 * np.pi)
