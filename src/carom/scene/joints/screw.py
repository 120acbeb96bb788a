"""The joint `Screw`: a nut on a thread."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments
from carom.checks import number, shown, unit_vector
from carom.scene.joints.definition import JointDefinition
from carom.scene.values import keep, point


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Screw(JointDefinition):
    """A nut on a thread: the child rotates about a line and slides along it, in proportion.

    Parameters
    ----------
    anchor, axis : (3,)
        A point of the line and its direction, in the world at the start.
    pitch : float
        Displacement of the child along `axis` in one turn about it by the right-hand rule [m]. Negative for a
        left-hand thread, not 0.
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
        """Return the displacement along the axis for a rotation by 1 rad [m]."""
        return self.pitch / (2.0 * np.pi)
