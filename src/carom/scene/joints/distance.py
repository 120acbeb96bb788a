"""The joint `Distance`: a rod without mass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments
from carom.checks import shown
from carom.scene.joints.definition import JointDefinition
from carom.scene.values import apart, keep


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class Distance(JointDefinition):
    """A massless rod between a point of the parent and one of the child, each (3,).

    Its `length` [m] is the distance of the two points at the start, which must not be 0.
    """

    guide, turn = "own", "own"
    rows, in_trees = 1, False

    anchor_parent: np.ndarray
    anchor_child: np.ndarray
    length: float  #: distance of the two points at the start [m]

    def __init__(self, anchor_parent: ArrayLike, anchor_child: ArrayLike):
        start, end, length = apart(anchor_parent, anchor_child)
        if not length > 0.0:
            raise ValueError(
                f"anchor_child must differ from anchor_parent, got {shown(anchor_child)} for both; "
                "for a shared point use Spherical"
            )
        keep(self, anchor_parent=start, anchor_child=end, length=length)

    def anchors(self, anchor, child) -> tuple[np.ndarray, np.ndarray]:
        """Return both ends of the rod."""
        return self.anchor_parent, self.anchor_child

    def scale(self) -> float:
        """Return the length of the rod [m]."""
        return self.length
